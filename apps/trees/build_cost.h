#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "trees/tree_request.h"

namespace orchard::apps {

struct BuildCommand;

// The expected cost of a build, from measurements (docs/results/build-cost.md). For tightened and merged trees it is
// right within a factor of two there, on a processor of the 2020s; octrees and annealing differ more between meshes.
struct BuildCost {
  double spheres = 0;            // in all levels, if the surface has room for them
  double points = 0;             // of the surface, for a medial axis; 0: none is made
  double seconds = 0;            // of one thread
  double seconds_of_points = 0;  // of these, those that the points and the axis take
  double bytes = 0;
};

// axis: whether a medial axis is built. points: the surface points that it or the tree is made from; 0 if there are
// none. triangles: those of the mesh.
BuildCost estimated_cost(const TreeRequest& tree, bool axis, double points, double triangles);

// Of a command on a mesh of so many triangles.
BuildCost expected_cost(const BuildCommand& command, double triangles);

// Returns a line about the expected time and about what would be cheaper; empty if it is a matter of seconds, unless
// `always`.
std::string in_words(const BuildCost& cost, const TreeRequest& tree, bool always = false);

nlohmann::json to_json(const BuildCost& cost);

}  // namespace orchard::apps
