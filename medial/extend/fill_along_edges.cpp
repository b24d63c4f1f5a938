#include <vector>

#include "edge_gaps.h"
#include "extend_sheets.h"
#include "sharp_ends.h"
#include "sheet_extension.h"
#include "sheet_way.h"

namespace orchard::detail {
namespace {

class EdgeFiller {
 public:
  EdgeFiller(const Surface& surface, BallComplex& complex, const BorderOptions& options)
      : sheets_(surface, complex, options), edges_(surface, *options.features) {}

  Index run() {
    for (const auto& [x, y] : gaps_on_edges(sheets_.surface, sheets_.complex, *sheets_.options.features)) fill(x, y);
    return sheets_.triangles.finish();
  }

 private:
  static constexpr double kMaxLength =
      8;  // the largest distance between two places without a border in between, in spacings

  const ExactBall& ball(Index v) const { return sheets_.complex.balls[v]; }

  void fill(Index x, Index y) {
    const double length = (ball(x).center - ball(y).center).norm();
    if (sheets_.triangles.joined(x, y) || !(length > 0) || length > kMaxLength * sheets_.options.spacing) return;
    if (!edges_.goes_between(ball(x).center, ball(y).center)) return;
    const std::vector<Index> way = way_between(sheets_, inner_neighbors(x), inner_neighbors(y), length);
    fill_between(sheets_, x, y, way, [&](Index a, Index b, Index c) {
      return is_triangle_right(sheets_.surface, ball(a), ball(b), ball(c), sheets_.options.tolerance);
    });
  }
  std::vector<Index> inner_neighbors(Index v) const {
    std::vector<Index> found;
    for (const Index e : sheets_.at.edges_at[v]) {
      const Index other = sheets_.other_end(e, v);
      if (ball(other).radius > 0) found.push_back(other);
    }
    return found;
  }

  SheetExtension sheets_;
  SharpEdges edges_;
};

}  // namespace

Index fill_along_edges(const Surface& surface, BallComplex& complex, const BorderOptions& options) {
  return EdgeFiller(surface, complex, options).run();
}

}  // namespace orchard::detail
