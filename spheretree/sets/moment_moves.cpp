#include "moment_moves.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "moments.h"

namespace orchard::detail {
namespace {

// At most this many balls and places, evenly spread, are tried for a move. With many balls, more do not help.
constexpr std::size_t kMostBalls = 64, kMostPlaces = 1000;
constexpr double kWorthIt = 0.999;  // of the excess before

// Sums of first and second moments of the centres about the wanted centre of mass.
class CenterSums {
 public:
  CenterSums(const std::vector<Point>& centers, double radius, const PackingMoments& moments)
      : moments_(moments),
        own_(radius * radius / 5 * Eigen::Matrix3d::Identity()),
        wanted_(second_moment(moments.body)) {
    count_ = static_cast<double>(centers.size());
    for (const Point& center : centers) change(center, 1);
    size_ = inertia_of(wanted_).norm();
  }

  void change(const Point& center, double sign) {
    const Vector at = center - moments_.body.center;
    first_ += sign * at;
    second_ += sign * at * at.transpose();
  }

  double excess() const {
    const Vector mean = first_ / count_;
    const Eigen::Matrix3d spread = second_ / count_ - mean * mean.transpose() + own_;
    return std::max(mean.norm() / moments_.center_error,
                    inertia_of(spread - wanted_).norm() / (size_ * moments_.inertia_error));
  }

  double excess_after(const Point& from, const Point& to) const {
    CenterSums moved = *this;
    moved.change(from, -1);
    moved.change(to, 1);
    return moved.excess();
  }

 private:
  static Eigen::Matrix3d inertia_of(const Eigen::Matrix3d& second) {
    return second.trace() * Eigen::Matrix3d::Identity() - second;
  }

  const PackingMoments& moments_;
  Eigen::Matrix3d own_, wanted_, second_ = Eigen::Matrix3d::Zero();
  Vector first_ = Vector::Zero();
  double count_ = 0, size_ = 0;
};

// A place with room for a ball, if at most one ball that is in the way leaves.
struct Room {
  Point at;
  Index in_the_way = kNone;
};

std::vector<Room> rooms_for(const std::vector<Sphere>& places, double contact, double radius,
                            const std::vector<Point>& centers) {
  std::vector<char> fits(places.size(), 0);
  std::vector<Room> rooms(places.size());
  const double reach = contact * radius * contact * radius;
  tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t i) {
    if (places[i].radius < radius) return;
    rooms[i].at = places[i].center;
    for (Index b = 0; b < centers.size(); ++b) {
      if ((centers[b] - rooms[i].at).squaredNorm() >= reach) continue;
      if (rooms[i].in_the_way != kNone) return;
      rooms[i].in_the_way = b;
    }
    fits[i] = 1;
  });
  std::vector<Room> result;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (fits[i] != 0) result.push_back(rooms[i]);
  return result;
}

struct Move {
  double excess = std::numeric_limits<double>::infinity();
  Index ball = kNone;
  Point to = Point::Zero();
};

Move best_move(const std::vector<Room>& rooms, const std::vector<Point>& centers, const CenterSums& sums, int turn) {
  const std::size_t ball_step = 1 + centers.size() / kMostBalls, place_step = 1 + rooms.size() / kMostPlaces;
  Move best;
  const auto consider = [&](Index ball, const Point& to) {
    const double excess = sums.excess_after(centers[ball], to);
    if (excess < best.excess) best = {excess, ball, to};
  };
  for (std::size_t i = static_cast<std::size_t>(turn) % place_step; i < rooms.size(); i += place_step) {
    if (rooms[i].in_the_way != kNone) {
      consider(rooms[i].in_the_way, rooms[i].at);
      continue;
    }
    for (std::size_t b = static_cast<std::size_t>(turn) % ball_step; b < centers.size(); b += ball_step)
      consider(static_cast<Index>(b), rooms[i].at);
  }
  return best;
}

}  // namespace

double moment_excess(const std::vector<Point>& centers, double radius, const PackingMoments& moments) {
  return CenterSums(centers, radius, moments).excess();
}

double move_to_moments(const std::vector<Sphere>& places, double contact, double radius, double enough,
                       const PackingMoments& moments, std::vector<Point>& centers) {
  CenterSums sums(centers, radius, moments);
  double excess = sums.excess();
  for (int turn = 0; turn < static_cast<int>(centers.size()) && excess > enough; ++turn) {
    const Move move = best_move(rooms_for(places, contact, radius, centers), centers, sums, turn);
    if (!(move.excess < kWorthIt * excess)) break;
    sums.change(centers[move.ball], -1);
    sums.change(move.to, 1);
    centers[move.ball] = move.to;
    excess = move.excess;
  }
  return excess;
}

}  // namespace orchard::detail
