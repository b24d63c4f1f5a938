#pragma once
#include <memory>

#include "scene.h"

namespace orchard::bench {

// Sweep and prune along the axis on which bodies are spread the most, the order kept from step to step.
std::unique_ptr<Rival> sweep_and_prune(const std::vector<Vec3>& positions, const std::vector<double>& radii);

#ifdef ORCHARD_HAS_FCL
std::unique_ptr<Rival> fcl_tree(const std::vector<Vec3>& positions, const std::vector<double>& radii);
#endif
#ifdef ORCHARD_HAS_BULLET
std::unique_ptr<Rival> bullet_dbvt(const std::vector<Vec3>& positions, const std::vector<double>& radii);
#endif

}  // namespace orchard::bench
