#pragma once
#include <cstddef>
#include <functional>
#include <vector>

#include "insertion/insertion.h"

namespace orchard::detail {

// The least number of points for which insertion by several threads is worth while. Smaller sets are inserted by one
// thread, in their usual order.
std::size_t large_set();
// Changes large_set() from now on, in all threads. For tests.
void use_large_set(std::size_t points);

// Inserts points by several threads. Space is divided into regions, and in each region those points are inserted, in
// order, for which all vertices of the cavity and around it are formed by points of that region alone. The points that
// are left are tried again with other regions, as long as that is worth while. The result does not depend on the number
// of threads, because neither the regions nor the insertions in each depend on it.
//
// `waiting` is ascending. It becomes the points that are left for one thread: all other points before `end` are then in
// the diagram. `inserter` is the one that made the diagram so far; its next walk starts anywhere. `report` is called
// now and then, from the calling thread, with the number of points before `end` that are in the diagram. If it throws,
// the insertion ends.
void insert_in_regions(Workspace& workspace, Inserter& inserter, std::vector<Index>& waiting, Index end,
                       const std::function<void(std::size_t)>& report);

}  // namespace orchard::detail
