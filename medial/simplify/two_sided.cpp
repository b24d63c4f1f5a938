#include "two_sided.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <vector>

#include "../quality/quality_parts.h"

namespace orchard::detail {
namespace {

constexpr double kSlack = 1e-4;   // diagonals: to which the largest gap is searched
constexpr int kMaxHalvings = 60;  // of a triangle: its corners are one point then
constexpr Index kMaxPieces = 2'000'000;

struct Piece {
  double bound = 0;
  std::array<Point, 3> corners;
  int halvings = 0;
  bool operator<(const Piece& other) const { return bound < other.bound; }
};

}  // namespace

double max_gap(const Surface& surface, const ContractibleMesh& mesh, const FootFinder& finder, double known,
               double slack) {
  double attained = known, left = known;  // `left`: the largest bound of a piece that is not looked at further
  std::priority_queue<Piece> queue;
  const auto look_at = [&](const std::array<Point, 3>& corners, int halvings, double limit) {
    const Foot foot = finder.find((corners[0] + corners[1] + corners[2]) / 3);
    attained = std::max(attained, foot.value);
    double bound = -std::numeric_limits<double>::infinity();
    for (const Point& corner : corners) bound = std::max(bound, foot_on(mesh, foot.corners, corner).value);
    bound = std::min(bound, limit);
    if (bound > attained + slack) {
      queue.push({bound, corners, halvings});
    } else {
      left = std::max(left, bound);
    }
  };
  for (Index t = 0; t < surface.mesh().triangles.size(); ++t)
    look_at(surface.corners(t), 0, std::numeric_limits<double>::infinity());
  for (Index pieces = 0; !queue.empty() && queue.top().bound > attained + slack; ++pieces) {
    const Piece top = queue.top();
    if (top.halvings == kMaxHalvings || pieces == kMaxPieces) break;
    queue.pop();
    const std::array<Point, 3>& at = top.corners;
    // In two, across the longest side.
    const std::array<double, 3> sides{(at[1] - at[2]).squaredNorm(), (at[0] - at[2]).squaredNorm(),
                                      (at[0] - at[1]).squaredNorm()};
    const auto longest = static_cast<std::size_t>(std::max_element(sides.begin(), sides.end()) - sides.begin());
    const Point &apex = at[longest], &p = at[(longest + 1) % 3], &q = at[(longest + 2) % 3];
    const Point middle = 0.5 * (p + q);
    look_at({apex, p, middle}, top.halvings + 1, top.bound);
    look_at({apex, middle, q}, top.halvings + 1, top.bound);
  }
  return std::max(left, queue.empty() ? attained : queue.top().bound);
}

void measure_two_sided(const Surface& surface, const ContractibleMesh& mesh, const SimplifyOptions& options,
                       SimplifyReport& report) {
  const double diagonal = surface.bounding_box().diagonal().norm();
  std::vector<SurfaceSample> samples;
  for (const FitSample& sample : fit_samples(surface, options.check, options.seed + 1))
    samples.push_back({sample.position, sample.normal});
  const MedialMesh result = mesh.mesh();
  MedialQuality quality;
  quality.diagonal = diagonal;
  measure_reconstruction(surface, result, samples, quality_balls(result, QualityOptions{}.cells), {.worst_places = 0},
                         quality);
  const FootFinder finder(mesh);
  const double gap = max_gap(surface, mesh, finder, quality.coverage.max, kSlack * diagonal);
  report.coverage = {gap / diagonal, quality.coverage.mean / diagonal};
  report.protrusion = {quality.protrusion.max / diagonal, quality.protrusion.mean / diagonal};
  report.hausdorff = {std::max(quality.hausdorff.max, gap) / diagonal, quality.hausdorff.mean / diagonal};
}

}  // namespace orchard::detail
