#pragma once
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

using Corners = std::array<Point, 3>;

// Returns the corner at which the longest side of a triangle starts.
inline std::size_t start_of_longest_side(const Corners& corners) {
  std::size_t longest = 0;
  double max = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const double length = (corners[k] - corners[(k + 1) % 3]).squaredNorm();
    if (length > max) max = length, longest = k;
  }
  return longest;
}

// Cuts a triangle, which may be degenerate, at the middle of its longest side.
inline std::pair<Corners, Corners> halves(const Corners& corners) {
  const std::size_t k = start_of_longest_side(corners);
  const Point &a = corners[k], &b = corners[(k + 1) % 3], &c = corners[(k + 2) % 3];
  const Point middle = 0.5 * (a + b);
  return {{a, middle, c}, {middle, b, c}};
}

// What is known about a function on a triangle.
struct PieceValue {
  double value;  // the value of the function at `place`; minus infinity if it is not known
  double bound;  // an upper bound on the function
  Point place;
  Index cell = kNone;  // the cell nearest to `place`, if the function is a distance to cells
};

// The largest value of a function on triangles, by branch and bound.
struct MaxOverTriangles {
  double max;    // a value that is attained
  double upper;  // a proven upper bound
  Point place;   // the place where `max` is attained
};

// `evaluate(corners, cell, enough)` returns the PieceValue of a triangle or of a part of one. `cell` is the cell of the
// triangle that the part is a half of, or kNone. Values and bounds of at most `enough` do not have to be exact. Parts
// are halved until none can have more than `accuracy` above the best value, or until `max_parts` have been examined.
// `known` is a value that the function attains at known.place. The triangles are evaluated in parallel; the result is
// the same for any number of threads.
template <class Evaluate>
MaxOverTriangles max_over_triangles(std::span<const Corners> triangles, MaxOverTriangles known, double accuracy,
                                    std::size_t max_parts, const Evaluate& evaluate) {
  struct Part {
    Corners corners;
    double bound;
    Index cell;
    bool operator<(const Part& other) const { return bound < other.bound; }
  };
  std::vector<PieceValue> first(triangles.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, triangles.size(), 256), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i)
      first[i] = evaluate(triangles[i], kNone, known.max + accuracy);
  });
  const auto take = [&](const PieceValue& piece) {
    if (piece.value > known.max) known.max = piece.value, known.place = piece.place;
  };
  for (const PieceValue& piece : first) take(piece);
  std::priority_queue<Part> queue;
  double closed = known.max;  // the largest bound of the parts that are not examined any further
  const auto put = [&](const Corners& corners, double bound, Index cell) {
    if (bound > known.max + accuracy) {
      queue.push({corners, bound, cell});
    } else {
      closed = std::max(closed, bound);
    }
  };
  for (std::size_t i = 0; i < triangles.size(); ++i) put(triangles[i], first[i].bound, first[i].cell);
  std::size_t parts = triangles.size();
  while (!queue.empty() && queue.top().bound > known.max + accuracy && parts < max_parts) {
    const Part part = queue.top();
    queue.pop();
    const auto [a, b] = halves(part.corners);
    for (const Corners& half : {a, b}) {
      const PieceValue piece = evaluate(half, part.cell, known.max + accuracy);
      ++parts;
      take(piece);
      put(half, std::min(piece.bound, part.bound), piece.cell);
    }
  }
  known.upper = std::max({known.max, closed, queue.empty() ? closed : queue.top().bound});
  return known;
}

}  // namespace orchard::detail
