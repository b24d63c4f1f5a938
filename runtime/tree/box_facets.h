#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

// A box around the origin as a mesh.
namespace orchard::runtime::detail {

// Returns the corners of a box around the origin. Corner i is on the upper side of axis k if bit k of i is set.
inline std::array<std::array<double, 3>, 8> box_corners(const std::array<double, 3>& half) noexcept {
  std::array<std::array<double, 3>, 8> corners{};
  for (std::size_t i = 0; i < 8; ++i) {
    corners[i] = {i & 1 ? half[0] : -half[0], i & 2 ? half[1] : -half[1], i & 4 ? half[2] : -half[2]};
  }
  return corners;
}

// The triangles of a box, by the numbers of these corners: two for each side, counterclockwise as seen from outside.
inline constexpr std::array<std::array<std::uint32_t, 3>, 12> kBoxFacets = {{{0, 2, 1},
                                                                             {1, 2, 3},
                                                                             {4, 5, 6},
                                                                             {5, 7, 6},
                                                                             {0, 1, 4},
                                                                             {1, 5, 4},
                                                                             {2, 6, 3},
                                                                             {3, 6, 7},
                                                                             {0, 4, 2},
                                                                             {2, 4, 6},
                                                                             {1, 3, 5},
                                                                             {3, 7, 5}}};

}  // namespace orchard::runtime::detail
