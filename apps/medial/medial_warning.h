#pragma once
#include <string>

#include "input/load_solid.h"
#include "orchard/medial/build.h"
#include "orchard/medial/topology.h"

namespace orchard::apps {

struct MedialFindings {
  Topology found, wanted;    // of the axis and of the solid
  bool mended = true;        // gaps were looked for
  bool own_points = false;   // the points are the user's
  bool own_diagram = false;  // the diagram is, in which no gap can be mended
};

// A topology as a part of a sentence: "1 component, 2 loops, 0 cavities".
std::string in_words(const Topology& topology);

// Why an axis may have another topology than its solid, and what to do about it.
std::string topology_cause(const SolidMesh& solid, const MedialBuild& build, const MedialFindings& findings);

// What is wrong with an axis that was built, why, and what to do about it, in a line that names nothing that cannot
// help or has been done; empty if nothing is wrong: another topology than the solid's, or parts left out to keep it.
std::string medial_warning(const SolidMesh& solid, const MedialBuild& build, const MedialFindings& findings);

}  // namespace orchard::apps
