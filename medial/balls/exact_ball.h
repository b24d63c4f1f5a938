#pragma once
#include <array>
#include <initializer_list>
#include <span>
#include <vector>

#include "../axis/downhill.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// A ball of the medial axis of a mesh, and where it touches: at most four places of the surface, none of which another
// stands for (see BallSolver).
struct ExactBall {
  static ClosestPoint nowhere() {
    ClosestPoint contact;
    contact.position.setZero();
    return contact;
  }

  Point center = Point::Zero();
  double radius = 0;  // the centre's distance to the surface, or 0 on the surface
  std::array<ClosestPoint, 4> contacts{nowhere(), nowhere(), nowhere(), nowhere()};
  int count = 0;       // of the contacts
  bool exact = false;  // whether all contacts are at the radius, and there are two or more
  double loss = 0;     // see BallSolver::loss()

  std::span<const ClosestPoint> touching() const { return {contacts.data(), static_cast<std::size_t>(count)}; }
};

// How far an interpolated ball protrudes from the solid or falls short of its surface. Somewhere within `reach` of its
// centre the solid is, so only a centre that is as near to the surface can be outside.
double ball_error(const Surface& surface, const Point& center, double radius, double reach);
// A ball, and its part in one that is interpolated.
struct PartOfBall {
  const ExactBall* ball;
  double part;  // they sum up to 1
};
// The same of one between these balls, whose radii are the distances to the surface: it is no farther than their
// contacts, and no nearer than a concave function says that is known at their centres (squared distances from a set,
// less those from the origin, are one: the least of linear functions), which mostly saves looking for it. What is at
// most `fine` may come out as 0.
double ball_error(const Surface& surface, const Point& center, double radius, double reach,
                  std::initializer_list<PartOfBall> between, double fine);

// Finds the ball of the medial axis that is nearest to a given one, by Newton's method: the contacts are held, the
// centre moves as little as makes their distances equal, and what comes nearer than they do becomes a contact, too.
// Not for several threads at once.
class BallSolver {
 public:
  // Two contacts are one where a ball between them would lose less than `merging`, in mesh units.
  BallSolver(const Surface& surface, double merging) : surface_(surface), merging_(merging), downhill_(surface) {}

  // From `start`, a place of the solid, with contacts downhill from `seeds`, which are places on the surface. The ball
  // is in the solid: where none is found, it is the largest one around `start`.
  ExactBall solve(const Point& start, std::span<const ClosestPoint> seeds);
  // From the place that divides the centres of two balls as `t` to 1 - t. The contacts that both have are held, so that
  // what lies between two balls of a seam is one of the seam; where they share less than two, the nearest are. What
  // lies between two places of the surface, or outside the solid, is the nearest place of the surface.
  ExactBall between(const ExactBall& a, const ExactBall& b, double t);

  // The largest ball around a place of the solid, with its nearest contact only.
  ExactBall at(const Point& place);

  // How far a solid's convex edge lies beyond a ball of radius r that touches both of its faces, with contacts seen
  // from its centre at an angle a: r (1 / cos(a / 2) - 1). What an axis loses that ends at this ball is no more.
  static double loss(double radius, double angle);

  ClosestPoint descend(const Point& from, const ClosestPoint& place) { return downhill_.descend(from, place); }

 private:
  struct Held : ClosestPoint {
    int of = 0;  // bits: which of the two balls had it
  };
  ExactBall solve_held(const Point& start);
  ExactBall on_surface(const Point& place) const;
  bool stays_inside(const Point& start, const ExactBall& ball) const;
  void merge(const Point& center);
  bool add_violator(const Point& center, double radius);
  bool step(Point& center);
  bool converge(Point& center);
  ExactBall finished(const Point& center, bool exact);

  const Surface& surface_;
  const double merging_;
  Downhill downhill_;
  std::vector<Held> contacts_, first_;
};

}  // namespace orchard::detail
