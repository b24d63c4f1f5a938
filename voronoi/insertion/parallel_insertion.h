#pragma once
#include <cstddef>
#include <functional>
#include <vector>

#include "insertion/insertion.h"

namespace orchard::detail {

// How many points a set has at least for which more than one thread is worth while: smaller ones are inserted in the
// order that they always were.
std::size_t large_set();
// From now on, in all threads: for tests.
void use_large_set(std::size_t points);

// Inserts points by several threads: space is cut into regions, and in each of them those points are inserted, in
// order, whose whole cavity and what surrounds it is formed by points of that region alone. Then the same again with
// other cuts for what could not be inserted, as long as that pays. The result does not depend on the number of threads,
// for the regions and what happens in each do not.
//
// `waiting`, ascending, becomes what is left for one thread: all other points before `end` are in the diagram then. The
// inserter is the one that made the diagram so far; its next walk starts anywhere. `report` is called now and then,
// from the calling thread, with the number of points before `end` that are in the diagram; what it throws ends the
// insertion.
void insert_in_regions(Workspace& workspace, Inserter& inserter, std::vector<Index>& waiting, Index end,
                       const std::function<void(std::size_t)>& report);

}  // namespace orchard::detail
