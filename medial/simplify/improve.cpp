#include "improve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "protrusions.h"

namespace orchard::detail {
namespace {

constexpr double kWorst = 0.5;     // places with less than this many largest distances do not count as worst
constexpr double kNoShare = 1e-3;  // a weight that counts as 0

double distance_to_segment(const Point& query, const Point& a, const Point& b) {
  const Vector along = b - a;
  const double squared = along.squaredNorm();
  const double share = squared > 0 ? std::clamp(along.dot(query - a) / squared, 0.0, 1.0) : 0;
  return (query - a - share * along).norm();
}

class Insertion {
 public:
  Insertion(ContractibleMesh& mesh, std::span<const FitSample> samples, Assignment& feet)
      : mesh_(mesh), samples_(samples), feet_(feet), touched_(mesh.size(), 0) {}

  Index run(const Surface& surface, Index count) {
    struct Place {
      double value;
      Foot foot;
      const FitSample* sample;  // null for a ball that protrudes
    };
    std::vector<Place> places;
    for (std::size_t i = 0; i < samples_.size(); ++i)
      places.push_back({std::abs(feet_.feet[i].value), feet_.feet[i], &samples_[i]});
    const auto balls = places_to_look(mesh_, LookOptions());
    std::vector<InsideBall> known(balls.size());
    for (const Protrusion& protrusion : find_protrusions(surface, mesh_, balls, kWorst * feet_.max, known))
      places.push_back({protrusion.value, {protrusion.corners, protrusion.weights, -protrusion.value}, nullptr});
    double worst = 0;
    for (const Place& place : places) worst = std::max(worst, place.value);
    std::erase_if(places, [&](const Place& place) { return place.value < kWorst * worst; });
    std::stable_sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.value > b.value; });
    Index done = 0;
    for (const auto& [value, foot, sample] : places) {
      if (done == count) break;
      const bool near_another =
          std::any_of(foot.corners.begin(), foot.corners.end(), [&](Index v) { return touched_[v] != 0; });
      if (near_another) continue;
      const bool reached = sample != nullptr && foot.value > 0 && reach_out(*sample, foot);
      if (!reached && !divide(foot)) continue;
      ++done;
      for (const Index v : foot.corners) touched_[v] = 1;
    }
    // Cells of feet may be divided, so feet are assigned to vertices, which remain.
    for (Foot& foot : feet_.feet) {
      const auto heaviest = std::max_element(foot.weights.begin(), foot.weights.end()) - foot.weights.begin();
      const Index corner = foot.corners[static_cast<std::size_t>(heaviest)];
      foot = {.corners = {corner, corner, corner}, .weights = {1, 0, 0}, .value = foot.value};
    }
    return done;
  }

 private:
  // Divides the longest edge of the cell of a foot. Returns false if it has none.
  bool divide(const Foot& foot) {
    const auto& [a, b, c] = foot.corners;
    if (b == a) return false;
    Index p = a, q = b;
    for (const auto& [x, y] : {std::pair{a, c}, std::pair{b, c}}) {
      if (x != y && length(x, y) > length(p, q)) p = x, q = y;
    }
    mesh_.divide(p, q, 0.5 * (mesh_.ball(p) + mesh_.ball(q)));
    return true;
  }

  // Adds a triangle from the border edge at the foot to the sample. Returns false if the foot is inside a sheet.
  bool reach_out(const FitSample& sample, const Foot& foot) {
    std::vector<Index> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      if (foot.weights[k] > kNoShare) corners.push_back(foot.corners[k]);
    }
    if (corners.size() == 2 && mesh_.count_triangles_at(corners[0], corners[1]) <= 1) {
      mesh_.extend(corners[0], corners[1], ball4(sample.position, sample.depth));
      return true;
    }
    if (corners.size() != 1) return false;
    Index best = kNone;
    double min = std::numeric_limits<double>::infinity();
    const Point from = mesh_.ball(corners[0]).head<3>();
    for (const Index other : mesh_.neighbors(corners[0])) {
      if (mesh_.count_triangles_at(corners[0], other) > 1) continue;
      const double distance = distance_to_segment(sample.position, from, mesh_.ball(other).head<3>());
      if (distance >= min) continue;
      min = distance;
      best = other;
    }
    if (best == kNone) {
      mesh_.extend(corners[0], ball4(sample.position, sample.depth));
    } else {
      mesh_.extend(corners[0], best, ball4(sample.position, sample.depth));
    }
    return true;
  }

  double length(Index a, Index b) const { return (mesh_.ball(a) - mesh_.ball(b)).norm(); }

  ContractibleMesh& mesh_;
  const std::span<const FitSample> samples_;
  Assignment& feet_;
  std::vector<std::uint8_t> touched_;
};

}  // namespace

Index insert_at_worst(const Surface& surface, ContractibleMesh& mesh, std::span<const FitSample> samples,
                      Assignment& feet, Index count) {
  return Insertion(mesh, samples, feet).run(surface, count);
}

}  // namespace orchard::detail
