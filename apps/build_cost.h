#pragma once
#include <string>

#include "orchard/spheretree/build.h"

namespace orchard::apps {

// What a build will take, from what others took: within a factor of two or three on a processor of the 2020s.
struct BuildCost {
  double spheres = 0;  // in all levels, if the surface has room for them
  double points = 0;   // of the surface, for a medial axis; 0: none is made
  double seconds = 0;  // of one thread
  double bytes = 0;
};

// points: surface points that the medial axis is made from; 0: none is.
BuildCost estimated_cost(const SphereTreeOptions& options, double points);

// A line on what is coming and what would be cheaper; empty where it is a matter of seconds.
std::string in_words(const BuildCost& cost, const SphereTreeOptions& options);

}  // namespace orchard::apps
