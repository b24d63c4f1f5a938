#include "exact_ball.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "orchard/geometry/angle.h"

namespace orchard::detail {
namespace {

constexpr int kMaxNewtonSteps = 12;  // steps of Newton's method from one set of contacts
constexpr int kMaxRounds = 8;        // times that a nearer contact is added to the set and the search starts again
constexpr double kEqual = 1e-11;     // in bounding radii: distances that differ by less count as equal
constexpr double kContactRounding =
    1e-9;  // as a fraction of a distance: rounding may put a contact this far from the surface
// As a fraction of the widest contacts: directions in which the normals differ by less are ignored.
constexpr double kRank = 0.03;

using Balls = std::initializer_list<PartOfBall>;

double nearest_contact(const Point& place, Balls balls) {
  double squared = std::numeric_limits<double>::infinity();
  for (const auto& [ball, part] : balls) {
    for (const ClosestPoint& contact : ball->touching())
      squared = std::min(squared, (contact.position - place).squaredNorm());
  }
  return (1 + kContactRounding) * std::sqrt(squared);
}

// Whether it is certain that this ball inside the solid contains no place of the surface. The test uses that |x|^2 -
// distance(x)^2 is a convex function, which gives a lower bound on the distance, and that any place in one of the balls
// is inside.
bool is_surely_empty(const Point& place, double radius, Balls balls) {
  double squared = 0;
  bool inside = false;
  for (const auto& [ball, part] : balls) {
    const double apart = (ball->center - place).squaredNorm(), own = ball->radius * ball->radius;
    squared += part * (own - apart);
    inside = inside || apart < own;
  }
  return inside && (1 - kContactRounding) * squared >= radius * radius;
}

// Returns the squared distance of the ends of two unit vectors at the angle a, 4 sin^2(a / 2), for the angle with
// loss(radius, a) = loss.
double narrow_for(double radius, double loss) {
  const double part = loss / radius;
  return 4 * part * (2 + part) / ((1 + part) * (1 + part));
}

// Returns the nearest place of the surface, which is at most as far away as the contacts of the balls.
ClosestPoint closest_from(const Surface& surface, const Point& place, double contact) {
  const ClosestPoint nearest = surface.closest_within(place, contact);
  return nearest.triangle != kNone ? nearest : surface.closest(place);
}

}  // namespace

double ball_error(const Surface& surface, const Point& center, double radius, double reach) {
  return ball_error(surface, center, radius, reach, {}, 0);
}

double ball_error(const Surface& surface, const Point& center, double radius, double reach, Balls between,
                  double fine) {
  const double contact = nearest_contact(center, between), inner = radius - fine;
  if (contact < radius + fine && inner > 0 && is_surely_empty(center, inner, between)) return 0;
  if (contact < radius + fine && inner > reach && surface.closest_within(center, inner).triangle == kNone) return 0;
  const double distance = closest_from(surface, center, contact).distance;
  if (distance <= reach && !surface.inside(center)) return radius + distance;
  return std::abs(radius - distance);
}

double BallSolver::loss(double radius, double angle) {
  if (angle >= std::numbers::pi) return std::numeric_limits<double>::infinity();
  return radius * (1 / std::cos(angle / 2) - 1);
}

// Sorts the contacts by distance, drops those that a nearer one already represents, and keeps four at most.
void BallSolver::merge(const Point& center) {
  for (Held& contact : contacts_) static_cast<ClosestPoint&>(contact) = descend(center, contact);
  std::stable_sort(contacts_.begin(), contacts_.end(),
                   [](const Held& a, const Held& b) { return a.distance < b.distance; });
  const double narrow = narrow_for(contacts_.empty() ? 0 : contacts_.front().distance, merging_);
  const auto seen = [&](const Held& contact) -> Vector { return (contact.position - center) / contact.distance; };
  std::size_t kept = 0;
  for (const Held& contact : contacts_) {
    const auto end = contacts_.begin() + static_cast<std::ptrdiff_t>(kept);
    const auto stands_for_it = std::find_if(contacts_.begin(), end, [&](const Held& other) {
      return !(other.distance > 0) || (seen(contact) - seen(other)).squaredNorm() < narrow;
    });
    if (stands_for_it != end) {
      stands_for_it->of |= contact.of;
    } else if (kept < 4) {
      contacts_[kept++] = contact;
    }
  }
  contacts_.resize(kept);
}

// Takes one step. Returns false if all contacts are already at the same distance.
bool BallSolver::step(Point& center) {
  const double equal = kEqual * surface_.bounding_radius();
  const std::size_t rows = contacts_.size() - 1;
  if (contacts_.back().distance - contacts_.front().distance <= equal) return false;
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();  // rows that stay 0 impose no condition
  Eigen::Vector3d side = Eigen::Vector3d::Zero();
  const Vector first = (center - contacts_[0].position) / contacts_[0].distance;
  for (std::size_t i = 0; i < rows; ++i) {
    const ClosestPoint& contact = contacts_[i + 1];
    matrix.row(static_cast<Eigen::Index>(i)) = ((center - contact.position) / contact.distance - first).transpose();
    side(static_cast<Eigen::Index>(i)) = contacts_[0].distance - contact.distance;
  }
  Vector move;
  if (rows == 1) {
    move = matrix.row(0).transpose() * (side(0) / matrix.row(0).squaredNorm());
  } else {
    Eigen::JacobiSVD<Eigen::Matrix3d, Eigen::NoQRPreconditioner> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
    svd.setThreshold(kRank);
    move = svd.solve(side);
  }
  const double length = move.norm(), limit = contacts_[0].distance / 2;
  if (length > limit) move *= limit / length;
  center += move;
  return true;
}

bool BallSolver::converge(Point& center) {
  for (int i = 0; i < kMaxNewtonSteps; ++i) {
    merge(center);
    if (contacts_.size() < 2 || !(contacts_[0].distance > 0)) return false;
    if (!step(center)) return true;
  }
  return false;
}

bool BallSolver::add_violator(const Point& center, double radius) {
  const ClosestPoint nearest = surface_.closest_within(center, radius - kEqual * surface_.bounding_radius());
  if (nearest.triangle == kNone) return false;
  contacts_.push_back({nearest});
  return true;
}

ExactBall BallSolver::finished(const Point& center, bool exact) {
  ExactBall ball;
  ball.center = center;
  ball.count = static_cast<int>(std::min<std::size_t>(contacts_.size(), 4));
  std::copy_n(contacts_.begin(), ball.count, ball.contacts.begin());
  ball.radius = contacts_.front().distance;
  ball.exact = exact;
  double widest = 0;
  const std::span<const ClosestPoint> contacts = ball.touching();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k)
      widest = std::max(widest, angle_between(contacts[i].position - center, contacts[k].position - center));
  }
  ball.loss = loss(ball.radius, widest);
  return ball;
}

// Solves for the contacts in contacts_. If that does not converge, solves for the nearest of them and the one that is
// seen farthest from it.
ExactBall BallSolver::solve_held(const Point& start) {
  first_ = contacts_;
  for (int attempt = 0; attempt < 2; ++attempt) {
    Point center = start;
    for (int round = 0; round < kMaxRounds; ++round) {
      if (!converge(center)) break;
      if (!add_violator(center, contacts_[0].distance)) return finished(center, true);
    }
    contacts_ = first_;
    if (contacts_.size() < 2) break;
    const auto seen = [&](const Held& other) {
      return angle_between(contacts_[0].position - start, other.position - start);
    };
    const auto opposite = std::max_element(contacts_.begin() + 1, contacts_.end(),
                                           [&](const Held& a, const Held& b) { return seen(a) < seen(b); });
    contacts_ = {contacts_[0], *opposite};
  }
  contacts_ = first_;
  contacts_.push_back({surface_.closest(start)});  // its distance is the radius
  merge(start);
  return finished(start, false);
}

ExactBall BallSolver::solve(const Point& start, std::span<const ClosestPoint> seeds) {
  contacts_.clear();
  for (const ClosestPoint& seed : seeds) contacts_.push_back({seed});
  merge(start);
  if (contacts_.size() >= 2) {
    ExactBall ball = solve_held(start);
    if (ball.exact && stays_inside(start, ball)) return ball;
  }
  // This case is rare and costs a full search: the nearest place of all.
  contacts_.clear();
  for (const ClosestPoint& seed : seeds) contacts_.push_back({seed});
  contacts_.push_back({surface_.closest(start)});
  merge(start);
  const ExactBall ball = solve_held(start);
  return !ball.exact || stays_inside(start, ball) ? ball : at(start);
}

// Whether the centre of the ball can be reached from a place of the solid inside the ball without crossing the surface.
bool BallSolver::stays_inside(const Point& start, const ExactBall& ball) const {
  return (ball.center - start).norm() < ball.radius || surface_.inside(ball.center);
}

ExactBall BallSolver::at(const Point& place) {
  contacts_ = {{surface_.closest(place)}};
  return finished(place, false);
}

ExactBall BallSolver::on_surface(const Point& place) const {
  ExactBall ball;
  ball.contacts[0] = surface_.closest(place);
  ball.center = ball.contacts[0].position;
  ball.contacts[0].distance = 0;
  ball.count = 1;
  ball.exact = ball.contacts[0].feature != Feature::face;  // on an edge the ball is exact, unless the edge is flat
  ball.loss = std::numeric_limits<double>::infinity();
  return ball;
}

ExactBall BallSolver::between(const ExactBall& a, const ExactBall& b, double t) {
  const Point start = (1 - t) * a.center + t * b.center;
  if (!(a.radius > 0) && !(b.radius > 0)) return on_surface(start);
  contacts_.clear();
  for (const ClosestPoint& contact : a.touching()) contacts_.push_back({contact, 1});
  for (const ClosestPoint& contact : b.touching()) contacts_.push_back({contact, 2});
  contacts_.push_back({closest_from(surface_, start, nearest_contact(start, {{&a, 1 - t}, {&b, t}}))});
  merge(start);
  std::stable_partition(contacts_.begin(), contacts_.end(), [](const Held& contact) { return contact.of == 3; });
  const auto common = static_cast<std::size_t>(
      std::count_if(contacts_.begin(), contacts_.end(), [](const Held& contact) { return contact.of == 3; }));
  contacts_.resize(std::min(contacts_.size(), std::max<std::size_t>(common, 2)));
  std::stable_sort(contacts_.begin(), contacts_.end(),
                   [](const Held& x, const Held& y) { return x.distance < y.distance; });
  const ExactBall ball = solve_held(start);
  // The ends are inside, so the middle can be outside only if the surface is as near to it as the ends are to each
  // other.
  const bool outside = ball.radius <= (a.center - b.center).norm() && !surface_.inside(ball.center);
  return outside ? on_surface(start) : ball;
}

}  // namespace orchard::detail
