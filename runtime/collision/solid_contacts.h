#pragma once
#include <span>

#include "collision/minimum_translation.h"
#include "orchard/runtime/contacts.h"

namespace orchard::runtime::detail {

// Does the same as contacts() for bodies of which one or both are solid boxes. `boxes` has an element for each of
// these, at most two; SolidBox::is_first then means that `a` is the box.
Manifold contacts_of_solids(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b,
                            const ContactOptions& options, std::span<const SolidBox> boxes) noexcept;

}  // namespace orchard::runtime::detail
