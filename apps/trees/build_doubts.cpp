#include "trees/build_doubts.h"

#include <fmt/core.h>

#include "orchard/medial/topology.h"

namespace orchard::apps {

std::string build_doubts(const SolidMesh& solid, const SphereTreeBuild& result) {
  if (!result.medial || !solid.surface.solid()) return {};
  std::string doubts;
  const auto add = [&](const std::string& doubt) { doubts += (doubts.empty() ? "" : ", and ") + doubt; };
  if (const Index crossing = result.medial->gap_repair.faces_still_crossing; crossing > 0)
    add(fmt::format("{} face{} of its Voronoi cells still cross{} a gap of the mesh", crossing,
                    crossing == 1 ? "" : "s", crossing == 1 ? "es" : ""));
  const auto bodies = solid_topology(solid.surface).components;
  if (result.axis_components != static_cast<Index>(bodies))
    add(fmt::format("it is in {} piece{} where the solid is in {}", result.axis_components,
                    result.axis_components == 1 ? "" : "s", bodies));
  if (doubts.empty()) return {};
  const char* remedy = solid.wrap ? "more --samples" : "more --samples, or --wrap,";
  if (method_of(result.tree_options) == TreeMethod::tightened)
    return fmt::format("The medial axis is not the solid's: {}. The tree does not depend on it; {} may help the axis",
                       doubts, remedy);
  return fmt::format(
      "The medial axis that the tree was fitted to is not the solid's: {}. The tree holds all the same, and may be "
      "looser than need be; {} may help",
      doubts, remedy);
}

}  // namespace orchard::apps
