#include "medial/medial_warning.h"

#include <fmt/core.h>

namespace orchard::apps {
namespace {

std::string counted(std::int64_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

}  // namespace

std::string in_words(const Topology& topology) {
  return counted(topology.components, "component", "components") + ", " + counted(topology.loops, "loop", "loops") +
         ", " + counted(topology.cavities, "cavity", "cavities");
}

std::string topology_cause(const SolidMesh& solid, const MedialBuild& build, const MedialFindings& findings) {
  const std::size_t cuts = solid.self_intersections.value_or(0);
  if (cuts > 0) {
    std::string text =
        counted(static_cast<std::int64_t>(cuts), "pair", "pairs") + " of triangles cut or touch each other";
    if (findings.wanted.cavities > 0) {
      text += ", " + counted(findings.wanted.cavities, "part is inside out", "parts are inside out");
    }
    return text + "; --wrap builds on one skin around them all";
  }
  if (findings.own_diagram) {
    return "gaps cannot be mended in a diagram that is given; give its points with --points, or more of them";
  }
  if (!findings.mended) return "gaps were not mended (--gaps connected does)";
  const std::string more = findings.own_points ? "more points" : "more --samples";
  if (build.gap_repair.faces_still_crossing > 0) {
    return counted(build.gap_repair.faces_still_crossing, "face still crosses", "faces still cross") + " gaps; give " +
           more + " or --max-passes";
  }
  return "give " + more + (solid.wrap ? "" : ", or --wrap");
}

std::string medial_warning(const SolidMesh& solid, const MedialBuild& build, const MedialFindings& findings) {
  std::string what;
  if (findings.found != findings.wanted) {
    what = "the axis has " + in_words(findings.found) + ", the solid " + in_words(findings.wanted);
  } else if (build.axis.stems + build.axis.bridges + build.axis.left_out > 0) {
    what = fmt::format(
        "to keep the topology, {} vertices have no faces, {} edges bridge the outside, {} vertices were "
        "left out",
        build.axis.stems, build.axis.bridges, build.axis.left_out);
  } else {
    return {};
  }
  return what + ": " + topology_cause(solid, build, findings);
}

}  // namespace orchard::apps
