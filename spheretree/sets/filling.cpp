#include "filling.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "orchard/geometry/random.h"
#include "sampled_distances.h"
#include "tightened/level_samples.h"
#include "volume_points.h"

namespace orchard::detail {
namespace {

// Radii are smaller than the distance to the surface by this much per unit of coordinate, which is more than rounding
// errors.
constexpr double kRadiusRounding = 0x1p-44;
constexpr std::uint64_t kFillingStage = 6600;  // the stream of the random numbers
constexpr Index kLeastCandidates = 2000, kCandidatesPerBall = 4;
constexpr std::size_t kLeastPoints = 40'000, kPointsPerBall = 150;
// A part of the box's longest side: points are spread this far beyond the box, and balls that protrude farther are not
// tried.
constexpr double kBoxMargin = 0.08;
constexpr int kFillingSweeps = 24;           // of all balls, each followed by an adjustment of the weight
constexpr int kTrialsPerSweep = 12;          // for each ball
constexpr double kFirstFillingStep = 0.25;   // of the radius
constexpr double kLeastFillingStep = 0.002;  // likewise
constexpr double kLongerFilling = 1.6, kShorterFilling = 0.88;  // of the step after a success and after a failure
constexpr int kInsertions = 24;                                 // candidates that are tried as new places for a ball
constexpr double kWeightGain = 4;  // growth of the outside weight's logarithm per part of the volume that is too much
constexpr int kVolumeSteps = 20;   // of Newton's iteration; a union's volume grows by its area
constexpr Index kAreaSamples = 20'000;
constexpr double kVolumeTolerance = 1e-3;  // of the solid's volume: ends the last adjustment of radii

int sweeps_for(Effort effort) {
  return effort == Effort::low ? kFillingSweeps / 2 : effort == Effort::high ? 4 * kFillingSweeps : kFillingSweeps;
}

std::size_t points_for(const SphereSetOptions& options) {
  const std::size_t points = std::max(kLeastPoints, kPointsPerBall * options.spheres);
  return options.effort == Effort::low ? points / 4 : points;
}

class Filling {
 public:
  Filling(const Surface& surface, const SphereSetOptions& options, const Progress& progress)
      : surface_(surface),
        options_(options),
        progress_(progress),
        inside_(options.fit == SphereFit::inside),
        points_(surface, points_for(options), inside_ ? 0 : kBoxMargin, WeightField(surface, options.weights)),
        candidates_(
            inscribed_balls(surface, std::max(kLeastCandidates, kCandidatesPerBall * options.spheres), options.seed)) {
    if (inside_)
      std::erase_if(candidates_, [&](const Sphere& ball) { return ball.radius < options.min_radius; });
    else
      for (Sphere& ball : candidates_) ball.radius = std::max(ball.radius, options.min_radius);
  }

  std::vector<Sphere> run() {
    seed();
    steps_.assign(balls_.size(), kFirstFillingStep);
    const int sweeps = sweeps_for(options_.effort);
    for (sweep_ = 0; sweep_ < sweeps; ++sweep_) {
      report_progress(progress_, "filling", static_cast<double>(sweep_) / sweeps);
      improve();
      if (sweep_ + 4 < sweeps) relocate();
      if (!inside_) adjust_weight();
    }
    if (!inside_) keep_volume();
    return balls_;
  }

 private:
  // Adds the candidate with the largest gain again and again. Gains never rise when balls are added, so most candidates
  // need not be evaluated again.
  void seed() {
    std::vector<double> gains(candidates_.size());
    tbb::parallel_for(std::size_t{0}, candidates_.size(),
                      [&](std::size_t i) { gains[i] = points_.gain_of(candidates_[i]); });
    const auto less = [&](Index a, Index b) { return gains[a] < gains[b] || (gains[a] == gains[b] && a > b); };
    std::vector<Index> heap(candidates_.size());
    std::iota(heap.begin(), heap.end(), Index{0});
    std::make_heap(heap.begin(), heap.end(), less);
    while (balls_.size() < options_.spheres && !heap.empty()) {
      std::pop_heap(heap.begin(), heap.end(), less);
      const Index top = heap.back();
      heap.pop_back();
      const double now = points_.gain_of(candidates_[top]);
      if (!heap.empty() && now < gains[heap.front()]) {
        gains[top] = now;
        heap.push_back(top);
        std::push_heap(heap.begin(), heap.end(), less);
        continue;
      }
      balls_.push_back(candidates_[top]);
      points_.add(candidates_[top]);
    }
    const std::size_t before = balls_.size();
    for (const double least : {options_.min_radius, 0.0}) add_inner_balls(surface_, options_.spheres, least, balls_);
    for (std::size_t b = before; b < balls_.size(); ++b) points_.add(balls_[b]);
  }

  void improve() {
    for (Index b = 0; b < balls_.size(); ++b) {
      Random random(options_.seed, kFillingStage + static_cast<std::uint64_t>(sweep_), b);
      for (int trial = 0; trial < kTrialsPerSweep; ++trial) {
        const Sphere to = moved(balls_[b], steps_[b], random);
        if (is_allowed(to) && points_.gain_of_change(balls_[b], to) > 0) {
          replace(b, to);
          steps_[b] = std::min(1.0, kLongerFilling * steps_[b]);
        } else {
          steps_[b] = std::max(kLeastFillingStep, kShorterFilling * steps_[b]);
        }
      }
    }
  }

  Sphere moved(const Sphere& ball, double step, Random& random) const {
    Vector by(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    by *= step * ball.radius;
    if (inside_) return inscribed_ball(surface_, ball.center + by);
    return {ball.center + by, ball.radius * (1 + step * random.uniform(-0.5, 0.5))};
  }

  bool is_allowed(const Sphere& ball) const {
    if (!(ball.radius > 0) || ball.radius < options_.min_radius) return false;
    if (inside_) return true;
    const Vector reach = Vector::Constant(ball.radius);
    return points_.box().contains(Point(ball.center - reach)) && points_.box().contains(Point(ball.center + reach));
  }

  void replace(Index b, const Sphere& by) {
    points_.remove(balls_[b]);
    balls_[b] = by;
    points_.add(by);
  }

  // Moves the balls whose loss is least to candidates with a larger gain.
  void relocate() {
    if (candidates_.empty()) return;
    const Index moves = 1 + options_.spheres / 8;
    std::vector<double> losses(balls_.size());
    tbb::parallel_for(std::size_t{0}, balls_.size(), [&](std::size_t b) { losses[b] = points_.loss_of(balls_[b]); });
    std::vector<Index> order(balls_.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return losses[a] < losses[b]; });
    for (Index k = 0; k < std::min<Index>(moves, static_cast<Index>(order.size())); ++k) {
      const Index b = order[k];
      const double loss = points_.loss_of(balls_[b]);
      Random random(options_.seed, kFillingStage + 500 + static_cast<std::uint64_t>(sweep_), b);
      double most = loss;
      Index best = kNone;
      for (int i = 0; i < kInsertions; ++i) {
        const auto candidate = static_cast<Index>(random.below(candidates_.size()));
        const double gain = points_.gain_of(candidates_[candidate]);
        if (gain > most) most = gain, best = candidate;
      }
      if (best == kNone) continue;
      replace(b, candidates_[best]);
      steps_[b] = kFirstFillingStep;
    }
  }

  // Adjusts the weight such that as much volume protrudes as is left out: then the union has the solid's volume.
  void adjust_weight() {
    const double too_much = (static_cast<double>(points_.outside_held()) - static_cast<double>(points_.inside_open())) /
                            static_cast<double>(points_.inside_count());
    weight_ = std::clamp(weight_ * std::exp(kWeightGain * too_much), 0.2, 5.0);
    points_.set_outside_weight(weight_);
  }

  // Changes all radii by the same length until the union has the solid's volume, by the measure that the result is
  // judged by.
  void keep_volume() {
    double by = 0;
    for (int step = 0; step < kVolumeSteps; ++step) {
      const std::vector<Sphere> balls = grown(by);
      const UnionVolume volume = union_volume(surface_, balls);
      const double missing = volume.solid - volume.balls.value;
      if (std::abs(missing) <= kVolumeTolerance * volume.solid) break;
      by += missing / UnionBoundary(balls, kAreaSamples).area();
    }
    balls_ = grown(by);
  }

  std::vector<Sphere> grown(double by) const {
    std::vector<Sphere> balls = balls_;
    for (Sphere& ball : balls) ball.radius = std::max({1e-3 * ball.radius, options_.min_radius, ball.radius + by});
    return balls;
  }

  const Surface& surface_;
  const SphereSetOptions& options_;
  const Progress& progress_;
  const bool inside_;
  VolumePoints points_;
  std::vector<Sphere> candidates_;  // in the solid
  std::vector<Sphere> balls_;
  std::vector<double> steps_;  // for each ball, as a part of its radius
  double weight_ = 1;
  int sweep_ = 0;
};

}  // namespace

Sphere inscribed_ball(const Surface& surface, const Point& center) {
  const double rounding = kRadiusRounding * (center.norm() + surface.bounding_radius());
  return {center, -surface.signed_distance(center) - rounding};
}

std::vector<Sphere> inscribed_balls(const Surface& surface, Index count, std::uint64_t seed) {
  SamplingOptions options{.face_points = count, .edge_points = 0, .iterations = 8};
  options.seed = seed;
  const SurfaceSampling points = sample_surface(surface, options);
  std::vector<Sphere> balls(points.size());
  tbb::parallel_for(Index{0}, points.size(), [&](Index i) {
    const Vector outward = surface.pseudonormal(points.triangles[i], points.features[i]);
    balls[i] = inscribed_ball(surface, touching_center(surface, points.points[i], outward));
  });
  std::erase_if(balls, [](const Sphere& ball) { return !(ball.radius > 0); });
  return balls;
}

void add_inner_balls(const Surface& surface, Index count, double min_radius, std::vector<Sphere>& balls) {
  if (balls.size() >= count) return;
  constexpr double kApart[] = {1, 0.5, 0.25, 0.1, 0};  // least distances of two centres, in radii
  std::vector<Sphere> candidates = inscribed_balls(surface, std::max(kLeastCandidates, kCandidatesPerBall * count), 1);
  std::erase_if(candidates, [&](const Sphere& ball) { return ball.radius < min_radius; });
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Sphere& a, const Sphere& b) { return a.radius > b.radius; });
  for (const double apart : kApart)
    for (const Sphere& candidate : candidates) {
      if (balls.size() == count) return;
      const auto too_near = [&](const Sphere& ball) {
        return (ball.center - candidate.center).norm() <= apart * candidate.radius;
      };
      if (std::none_of(balls.begin(), balls.end(), too_near)) balls.push_back(candidate);
    }
}

std::vector<Sphere> filled_set(const Surface& surface, const SphereSetOptions& options, const Progress& progress) {
  return Filling(surface, options, progress).run();
}

}  // namespace orchard::detail
