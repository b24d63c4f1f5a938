#pragma once
#include <span>

#include "collision/minimum_translation.h"
#include "orchard/runtime/contacts.h"

namespace orchard::runtime::detail {

// contacts() where bodies may be boxes with their inside: with `is_first`, the body `a` is one. At most two of them.
Manifold contacts_of_solids(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b,
                            const ContactOptions& options, std::span<const SolidBox> boxes) noexcept;

}  // namespace orchard::runtime::detail
