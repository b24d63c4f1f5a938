#include "medial_warning.h"

#include <fmt/core.h>

namespace orchard::apps {
namespace {

std::string counted(std::int64_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string in_words(const Topology& topology) {
  return counted(topology.components, "component", "components") + ", " + counted(topology.loops, "loop", "loops") +
         ", " + counted(topology.cavities, "cavity", "cavities");
}

std::string cause(const SolidMesh& solid, const MedialBuild& build, const Topology& wanted, bool mended) {
  const std::size_t cuts = solid.self_intersections.value_or(0);
  if (cuts > 0) {
    std::string text =
        counted(static_cast<std::int64_t>(cuts), "pair", "pairs") + " of triangles cut or touch each other";
    if (wanted.cavities > 0) {
      text += ", " + counted(wanted.cavities, "part is inside out", "parts are inside out");
    }
    return text + "; --wrap builds on one skin around them all";
  }
  if (!mended) return "gaps were not mended (--gaps connected does)";
  if (build.repair.faces_still_crossing > 0) {
    return counted(build.repair.faces_still_crossing, "face still crosses", "faces still cross") +
           " gaps; give more --samples or --max-passes";
  }
  return "give more --samples, or --wrap";
}

}  // namespace

std::string medial_warning(const SolidMesh& solid, const MedialBuild& build, const Topology& found,
                           const Topology& wanted, bool mended) {
  std::string what;
  if (found != wanted) {
    what = "the axis has " + in_words(found) + ", the solid " + in_words(wanted);
  } else if (build.axis.stems + build.axis.bridges + build.axis.left_out > 0) {
    what = fmt::format(
        "to keep the topology, {} vertices have no faces, {} edges bridge the outside, {} vertices were "
        "left out",
        build.axis.stems, build.axis.bridges, build.axis.left_out);
  } else {
    return {};
  }
  return what + ": " + cause(solid, build, wanted, mended);
}

}  // namespace orchard::apps
