#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "orchard/spheretree/build.h"

namespace orchard::apps {

struct BuildCommand;

// What a build will take, from what others took (docs/results/build-cost.md): tightened and merged trees within a
// factor of two there, on a processor of the 2020s; octrees and annealing differ more among meshes.
struct BuildCost {
  double spheres = 0;  // in all levels, if the surface has room for them
  double points = 0;   // of the surface, for a medial axis; 0: none is made
  double seconds = 0;  // of one thread
  double bytes = 0;
};

// points: surface points that the medial axis is made from; 0: none is. triangles: of the mesh.
BuildCost estimated_cost(const SphereTreeOptions& options, double points, double triangles);

// Of a command on a mesh of so many triangles.
BuildCost expected_cost(const BuildCommand& command, double triangles);

// A line on what is coming and what would be cheaper; empty where it is a matter of seconds, unless `always`.
std::string in_words(const BuildCost& cost, const SphereTreeOptions& options, bool always = false);

nlohmann::json to_json(const BuildCost& cost);

}  // namespace orchard::apps
