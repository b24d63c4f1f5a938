#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "filling.h"
#include "golden_steps.h"
#include "orchard/geometry/random.h"
#include "overlap.h"
#include "packing.h"

namespace orchard::detail {
namespace {

constexpr std::uint64_t kPackingStage = 6700;  // the stream of the random numbers
constexpr std::size_t kLeastPlaces = 6000, kPlacesPerBall = 25;
constexpr std::size_t kMostTried = 40;  // points of the box tried for each wanted place, however thin the solid is
constexpr int kFirstTrials = 24, kLaterTrials = 12;  // for each ball: when it is placed, and in each later sweep
constexpr int kPackingSweeps = 6;
constexpr double kFirstClimbStep = 0.3, kLeastClimbStep = 1e-3, kShorterClimb = 0.8;  // of the radius

// Whether a ball overlaps no other by more than is allowed. limit() alone does not ensure that if overlaps are allowed:
// a ball that was made smaller because of one neighbour may then overlap an earlier one by too large a share of itself.
bool keeps_apart(const Sphere& ball, Index own, double overlap, const std::vector<Sphere>& balls) {
  for (Index b = 0; overlap > 0 && b < balls.size(); ++b)
    if (b != own && overlap_share(ball, balls[b]) > overlap) return false;
  return true;
}

// Reduces the radius of a place such that the ball there may stay beside `ball`; to 0 if none may.
void limit(Sphere& place, const Sphere& ball, double overlap) {
  if (!(place.radius > 0)) return;
  const double distance = (place.center - ball.center).norm();
  if (distance < place.radius + ball.radius)
    place.radius = allowed_radius(distance, ball.radius, overlap, place.radius);
}

class LargestFirstPacker {
 public:
  LargestFirstPacker(const Surface& surface, const std::vector<Sphere>& places, double cap,
                     const PackingOptions& options, const Progress& progress)
      : surface_(surface), cap_(cap), options_(options), progress_(progress), places_(places) {
    for (Sphere& place : places_) place.radius = std::min(place.radius, cap);
  }

  std::vector<Sphere> run() {
    while (balls_.size() < options_.balls && place_one())
      report_progress(progress_, "packing", 0.5 * static_cast<double>(balls_.size()) / options_.balls);
    const int sweeps = kPackingSweeps * options_.rounds;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      report_progress(progress_, "packing", 0.5 + 0.5 * sweep / sweeps);
      for (Index b = 0; b < balls_.size(); ++b)
        climb(balls_[b], b, kLaterTrials,
              Random(options_.seed, kPackingStage + 1 + static_cast<std::uint64_t>(sweep), b));
    }
    return balls_;
  }

 private:
  bool place_one() {
    const auto largest = std::max_element(places_.begin(), places_.end(),
                                          [](const Sphere& a, const Sphere& b) { return a.radius < b.radius; });
    if (largest == places_.end() || !(largest->radius > 0) || largest->radius < options_.least_radius) return false;
    Sphere ball = *largest;
    climb(ball, kNone, kFirstTrials, Random(options_.seed, kPackingStage, balls_.size()));
    balls_.push_back(ball);
    tbb::parallel_for(std::size_t{0}, places_.size(),
                      [&](std::size_t i) { limit(places_[i], ball, options_.overlap); });
    return true;
  }

  // Moves a ball by random steps to places where it can be larger. `own`: its number if it is in the set, else kNone.
  void climb(Sphere& ball, Index own, int trials, Random random) const {
    double step = kFirstClimbStep;
    for (int trial = 0; trial < trials && ball.radius < cap_; ++trial) {
      const Vector by(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      Sphere to = inscribed_ball(surface_, ball.center + step * ball.radius * by);
      to.radius = std::min(to.radius, cap_);
      for (Index b = 0; b < balls_.size() && to.radius > ball.radius; ++b)
        if (b != own) limit(to, balls_[b], options_.overlap);
      if (to.radius > ball.radius && keeps_apart(to, own, options_.overlap, balls_))
        ball = to;
      else
        step = std::max(kLeastClimbStep, kShorterClimb * step);
    }
  }

  const Surface& surface_;
  const double cap_;
  const PackingOptions& options_;
  const Progress& progress_;
  std::vector<Sphere> places_, balls_;
};

}  // namespace

std::vector<Sphere> places_in(const Surface& surface, const PackingOptions& options) {
  const std::size_t wanted = std::max(kLeastPlaces, kPlacesPerBall * options.balls);
  const Box& box = surface.bounding_box();
  std::vector<Sphere> places;
  for (std::size_t tried = 0; places.size() < wanted && tried < kMostTried * wanted;) {
    std::vector<Sphere> some(wanted);
    tbb::parallel_for(std::size_t{0}, wanted, [&](std::size_t i) {
      const Point point = box.min() + box.sizes().cwiseProduct(golden_place(static_cast<double>(tried + i)));
      if (surface.winding_number(point) > 0) some[i] = inscribed_ball(surface, point);
    });
    for (const Sphere& place : some)
      if (place.radius > 0 && places.size() < wanted) places.push_back(place);
    tried += wanted;
  }
  const std::vector<Sphere> largest = inscribed_balls(surface, static_cast<Index>(wanted / 4), options.seed);
  places.insert(places.end(), largest.begin(), largest.end());
  return places;
}

std::vector<Sphere> pack_largest(const Surface& surface, const std::vector<Sphere>& places, double cap,
                                 const PackingOptions& options, const Progress& progress) {
  return LargestFirstPacker(surface, places, cap, options, progress).run();
}

void grow_in_place(const Surface& surface, const PackingOptions& options, std::vector<Sphere>& balls) {
  for (Index own = 0; own < balls.size(); ++own) {
    Sphere grown = inscribed_ball(surface, balls[own].center);
    for (Index b = 0; b < balls.size() && grown.radius > balls[own].radius; ++b)
      if (b != own) limit(grown, balls[b], options.overlap);
    if (grown.radius > balls[own].radius && keeps_apart(grown, own, options.overlap, balls)) balls[own] = grown;
  }
}

}  // namespace orchard::detail
