#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "filling.h"
#include "moment_moves.h"
#include "moments.h"
#include "overlap.h"
#include "packing.h"

namespace orchard::detail {
namespace {

constexpr int kGrowingRounds = 60;  // of growing
constexpr int kPushes = 80;         // at most, in each round
constexpr int kPairsAge = 8;        // pushes after which the near pairs are searched again
constexpr double kNear = 1.25;      // contact distances: pairs up to this far apart are near
constexpr double kApart = 5e-4;     // of the radius: pushes end when balls overlap or protrude by less
constexpr double kFirstGrowth = 0.06, kLeastGrowth = 1e-3;
constexpr double kShrinking = 0.93, kLeastShrunk = 0.35;  // of the radius, in the search for the moments
constexpr double kWorthMoving = 1.02;                     // a ball is moved if its room grows by more than this factor
constexpr double kAny = std::numeric_limits<double>::infinity();
constexpr double kTowards = 0.3;   // the part of the way to the wanted moments that a push takes
constexpr double kWithin = 0.7;    // of the allowed errors: moments with smaller errors are left alone
constexpr double kUnmoved = 1e-9;  // of the size: the least spread of centres that a map can stretch

Eigen::Matrix3d root_of(const Eigen::Matrix3d& matrix, double least) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(least).cwiseSqrt().asDiagonal() *
         solver.eigenvectors().transpose();
}

class EqualBalls {
 public:
  EqualBalls(const Surface& surface, const PackingMoments* moments, const PackingOptions& options)
      : surface_(surface),
        moments_(moments),
        contact_(std::max(1e-3, contact_distance(1, 1, options.overlap))),
        rounds_(kGrowingRounds * options.rounds) {}

  std::vector<Sphere> run(const std::vector<Sphere>& places, Index count, const Progress& progress) {
    place(places, count);
    if (centers_.empty()) return {};
    radius_ = room(centers_);
    // First the balls grow as large as possible; then they are moved to the wanted moments, which makes them smaller.
    grow(places, false, progress);
    if (moments_ != nullptr && excess(centers_, radius_) > 1) {
      find_moments(places);
      grow(places, true, progress);
    }
    std::vector<Sphere> balls;
    for (const Point& center : centers_) balls.push_back({center, radius_});
    return balls;
  }

 private:
  // Places one ball after another where there is most room. In a solid without room for all, some share a place; they
  // part as soon as they are pushed.
  void place(std::vector<Sphere> places, Index count) {
    while (centers_.size() < count && !places.empty()) {
      const auto widest = std::max_element(places.begin(), places.end(),
                                           [](const Sphere& a, const Sphere& b) { return a.radius < b.radius; });
      const Point at = widest->center;
      centers_.push_back(at);
      tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t i) {
        places[i].radius = std::min(places[i].radius, (places[i].center - at).norm() / contact_);
      });
    }
  }

  // rooms_of(): for each ball, the radius that it may have if the others have the same. room(): the radius that all may
  // have.
  std::vector<double> rooms_of(const std::vector<Point>& centers) const {
    std::vector<double> own(centers.size());
    tbb::parallel_for(std::size_t{0}, centers.size(), [&](std::size_t i) {
      own[i] = inscribed_ball(surface_, centers[i]).radius;
      for (std::size_t k = 0; k < centers.size(); ++k)
        if (k != i) own[i] = std::min(own[i], (centers[k] - centers[i]).norm() / contact_);
    });
    return own;
  }
  double room(const std::vector<Point>& centers) const {
    const std::vector<double> own = rooms_of(centers);
    return *std::min_element(own.begin(), own.end());
  }

  double excess(const std::vector<Point>& centers, double radius) const {
    return moments_ == nullptr ? 0 : moment_excess(centers, radius, *moments_);
  }

  void grow(const std::vector<Sphere>& places, bool keep_moments, const Progress& progress) {
    const auto allowed = [&] { return keep_moments ? std::max(1.0, excess(centers_, radius_)) : kAny; };
    double growth = kFirstGrowth;
    for (int round = 0; round < rounds_ && growth > kLeastGrowth; ++round) {
      report_progress(progress, "packing", static_cast<double>(round) / rounds_);
      std::vector<Point> pushed = centers_;
      push(pushed, radius_ * (1 + growth), keep_moments);
      const double grown = room(pushed);
      if (grown > radius_ * (1 + growth / 8) && excess(pushed, grown) <= allowed()) {
        centers_ = std::move(pushed);
        radius_ = grown;
      } else if (keep_moments || !free_narrowest(places)) {
        growth /= 2;
      }
    }
  }

  // Moves the ball that keeps the others from growing to the place with most room, if there is more room than where it
  // is. In a thin solid it could not get there by being pushed. Returns whether it was moved.
  bool free_narrowest(const std::vector<Sphere>& places) {
    const std::vector<double> rooms = rooms_of(centers_);
    const auto narrowest = static_cast<std::size_t>(std::min_element(rooms.begin(), rooms.end()) - rooms.begin());
    std::vector<double> own(places.size());
    tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t i) {
      own[i] = places[i].radius;
      for (std::size_t b = 0; b < centers_.size(); ++b)
        if (b != narrowest) own[i] = std::min(own[i], (places[i].center - centers_[b]).norm() / contact_);
    });
    const auto widest = static_cast<std::size_t>(std::max_element(own.begin(), own.end()) - own.begin());
    if (!(own[widest] > kWorthMoving * rooms[narrowest])) return false;
    centers_[narrowest] = places[widest].center;
    radius_ = room(centers_);
    return true;
  }

  // Tries smaller and smaller balls: these fit in more places, so they can come nearer to the wanted moments.
  void find_moments(const std::vector<Sphere>& places) {
    double least = excess(centers_, radius_);
    std::vector<Point> best = centers_;
    for (double wanted = radius_; least > 1 && wanted > kLeastShrunk * radius_; wanted *= kShrinking) {
      std::vector<Point> moved = centers_;
      const double now = move_to_moments(places, contact_, wanted, kWithin, *moments_, moved);
      if (now >= least) continue;
      least = now;
      best = std::move(moved);
    }
    centers_ = std::move(best);
    radius_ = room(centers_);
  }

  // A ball's depth, and where the ball was then. Since depth changes by no more than the ball moves, a new query is
  // often not necessary.
  struct Asked {
    Point at;
    double depth = -kAny;
  };

  void push(std::vector<Point>& centers, double radius, bool to_moments) const {
    std::vector<std::pair<Index, Index>> pairs;
    std::vector<Asked> asked(centers.size(), Asked{Point::Zero(), -kAny});
    for (int i = 0; i < kPushes; ++i) {
      if (i % kPairsAge == 0) find_pairs(centers, radius, pairs);
      if (to_moments && excess(centers, radius) > kWithin) approach_moments(centers, radius);
      const double overlap = part(centers, radius, pairs), out = pull_in(centers, radius, asked);
      if (std::max(overlap, out) < kApart * radius) break;
    }
  }

  void find_pairs(const std::vector<Point>& centers, double radius, std::vector<std::pair<Index, Index>>& pairs) const {
    pairs.clear();
    const double reach = kNear * contact_ * radius;
    for (Index a = 0; a < centers.size(); ++a)
      for (Index b = a + 1; b < centers.size(); ++b)
        if ((centers[a] - centers[b]).squaredNorm() < reach * reach) pairs.emplace_back(a, b);
  }

  // Moves the balls of each pair that is too near apart, each by half of what is missing. Returns the largest missing
  // distance.
  double part(std::vector<Point>& centers, double radius, const std::vector<std::pair<Index, Index>>& pairs) const {
    double most = 0;
    for (const auto& [a, b] : pairs) {
      const Vector between = centers[b] - centers[a];
      const double distance = between.norm(), missing = contact_ * radius - distance;
      if (!(missing > 0)) continue;
      most = std::max(most, missing);
      const Vector way = distance > 0 ? Vector(between / distance) : Vector(Vector::Unit(a % 3));
      centers[a] -= missing / 2 * way;
      centers[b] += missing / 2 * way;
    }
    return most;
  }

  // Moves each ball that crosses the surface inward. Returns the largest distance by which one was moved.
  double pull_in(std::vector<Point>& centers, double radius, std::vector<Asked>& asked) const {
    std::vector<double> moved(centers.size(), 0);
    tbb::parallel_for(std::size_t{0}, centers.size(), [&](std::size_t i) {
      if (asked[i].depth - (centers[i] - asked[i].at).norm() >= radius) return;
      ClosestPoint nearest;
      const double depth = -surface_.signed_distance(centers[i], nearest);
      asked[i] = {centers[i], depth};
      if (depth >= radius || nearest.distance == 0) return;
      moved[i] = radius - depth;
      const Vector inward = (centers[i] - nearest.position) / (depth > 0 ? nearest.distance : -nearest.distance);
      centers[i] += moved[i] * inward;
    });
    return *std::max_element(moved.begin(), moved.end());
  }

  // Moves the centres a part of the way by the linear map that gives them the wanted spread and moves them least
  // (Dowson and Landau 1982).
  void approach_moments(std::vector<Point>& centers, double radius) const {
    const double n = static_cast<double>(centers.size());
    Vector mean = Vector::Zero();
    for (const Point& center : centers) mean += center / n;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Point& center : centers) spread += (center - mean) * (center - mean).transpose() / n;
    const Eigen::Matrix3d body = second_moment(moments_->body);
    const double least = kUnmoved * body.trace();
    const Eigen::Matrix3d wanted = root_of(body - radius * radius / 5 * Eigen::Matrix3d::Identity(), least);
    const Eigen::Matrix3d map = wanted * root_of(wanted * spread * wanted, least * least).inverse() * wanted;
    for (Point& center : centers) {
      const Point there = moments_->body.center + map * (center - mean);
      center += kTowards * (there - center);
    }
  }

  const Surface& surface_;
  const PackingMoments* moments_;
  const double contact_;  // distance of the centres of two balls in contact, in radii
  const int rounds_;
  std::vector<Point> centers_;
  double radius_ = 0;
};

}  // namespace

std::vector<Sphere> pack_equal(const Surface& surface, const std::vector<Sphere>& places, const PackingMoments* moments,
                               const PackingOptions& options, const Progress& progress) {
  return EqualBalls(surface, moments, options).run(places, options.balls, progress);
}

}  // namespace orchard::detail
