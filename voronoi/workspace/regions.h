#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "workspace/workspace.h"

namespace orchard::detail {

// Planes that halve the space, then each half and so on, into regions with about the same number of waiting points.
// They are chosen so that few vertices have forming points in several regions. The result depends only on the points
// and vertices.
class Regions {
 public:
  static constexpr unsigned kMaxHalvings = 3;

  // `near` has the vertices where the points wait. There are up to 2^halvings regions.
  Regions(const Workspace& workspace, std::span<const Index> waiting, std::span<const Index> near, unsigned halvings);

  std::uint8_t count() const { return static_cast<std::uint8_t>(1u << halvings_); }
  std::uint8_t of(const Point& p) const {
    unsigned node = 1;
    for (unsigned i = 0; i < halvings_; ++i) node = 2 * node + (cuts_[node].is_beyond(p) ? 1u : 0u);
    return static_cast<std::uint8_t>(node - (1u << halvings_));
  }

 private:
  struct Cut {
    Vector normal = Vector::UnitX();
    double offset = 0;
    bool is_beyond(const Point& p) const { return normal.dot(p) > offset; }
  };

  struct Sample;
  static Cut best_cut(const Sample& sample);

  unsigned halvings_;
  std::array<Cut, 1u << kMaxHalvings> cuts_{};  // node n has the halves 2 n and 2 n + 1; the first node is 1
};

}  // namespace orchard::detail
