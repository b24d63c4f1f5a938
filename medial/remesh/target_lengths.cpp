#include "target_lengths.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace orchard::detail {
namespace {

constexpr double kErrorPart = 0.4;   // the error of an edge with the target length, in tolerances
constexpr double kFine = 0.05;       // errors below this many tolerances do not shorten the target
constexpr double kBorderLength = 1;  // the target length at borders, in radii
constexpr double kGrading = 0.25;    // the largest gradient of the target length
constexpr double kShortest = 0.5;    // edges shorter than this many smallest target lengths are ignored

// Limits the gradient of the target lengths: a short target at a vertex also shortens those around it.
void grade(const SheetMesh& mesh, std::vector<double>& lengths) {
  using Next = std::pair<double, Index>;
  std::priority_queue<Next, std::vector<Next>, std::greater<>> next;
  for (Index v = 0; v < mesh.vertices(); ++v) {
    if (mesh.has(v)) next.emplace(lengths[v], v);
  }
  std::vector<Index> around;
  while (!next.empty()) {
    const auto [value, v] = next.top();
    next.pop();
    if (value > lengths[v]) continue;
    mesh.neighbors(v, around);
    for (const Index other : around) {
      const double most = value + kGrading * (mesh.center(v) - mesh.center(other)).norm();
      if (most < lengths[other]) next.emplace(lengths[other] = most, other);
    }
  }
}

}  // namespace

std::vector<double> target_lengths(const SheetMesh& mesh, const CellErrors& errors, const LengthLimits& limits) {
  std::vector<double> lengths(mesh.vertices(), limits.most);
  for (const auto& [a, b] : mesh.edges()) {
    const double length = (mesh.center(a) - mesh.center(b)).norm();
    if (length < kShortest * limits.least) continue;
    // Errors are proportional to the square of the length.
    const double error = std::max(errors.of_edge(a, b, kFine * limits.tolerance), std::numeric_limits<double>::min());
    const double wanted =
        std::clamp(length * std::sqrt(kErrorPart * limits.tolerance / error), limits.least, limits.most);
    if (wanted < limits.most && error > limits.tolerance && errors.crosses_surface(a, b)) continue;
    for (const Index v : {a, b}) lengths[v] = std::min(lengths[v], wanted);
  }
  for (Index v = 0; v < mesh.vertices(); ++v) {
    if (!mesh.has(v) || !(mesh.ball(v).radius > 0) || mesh.stratum(v) != Stratum::border) continue;
    lengths[v] = std::min(lengths[v], std::max(limits.least, kBorderLength * mesh.ball(v).radius));
  }
  grade(mesh, lengths);
  return lengths;
}

}  // namespace orchard::detail
