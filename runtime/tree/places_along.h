#pragma once
#include <cstdint>
#include <vector>

namespace orchard::runtime::detail {

// Where something is along an axis, its number, and where it came from.
struct PlaceAlong {
  double at;
  std::uint32_t number, from;
};

// Sorts by the place, equal ones by their numbers, which differ. O(n log n); O(n) where places are spread evenly, as
// the centroids of a mesh's triangles mostly are: they are shared out by their place first. `other` is room to work in.
// Precondition: no place is a NaN.
void sort_along(std::vector<PlaceAlong>& places, std::vector<PlaceAlong>& other);

}  // namespace orchard::runtime::detail
