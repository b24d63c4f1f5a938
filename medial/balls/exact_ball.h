#pragma once
#include <array>
#include <initializer_list>
#include <span>
#include <vector>

#include "../axis/downhill.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// A ball of the medial axis of a mesh, with its contacts: at most four places of the surface. Places that BallSolver
// merges count as one contact.
struct ExactBall {
  static ClosestPoint nowhere() {
    ClosestPoint contact;
    contact.position.setZero();
    return contact;
  }

  Point center = Point::Zero();
  double radius = 0;  // the centre's distance to the surface, or 0 on the surface
  std::array<ClosestPoint, 4> contacts{nowhere(), nowhere(), nowhere(), nowhere()};
  int count = 0;       // the number of contacts
  bool exact = false;  // whether all contacts are at the radius, and there are two or more
  double loss = 0;     // see BallSolver::loss()

  std::span<const ClosestPoint> touching() const { return {contacts.data(), static_cast<std::size_t>(count)}; }
};

// Returns how far an interpolated ball protrudes from the solid or falls short of its surface. Precondition: a point of
// the solid lies within `reach` of the centre. So a centre that is farther than that from the surface is inside.
double ball_error(const Surface& surface, const Point& center, double radius, double reach);
// A ball, and its part in one that is interpolated.
struct PartOfBall {
  const ExactBall* ball;
  double part;  // the parts sum up to 1
};
// Returns the same for a ball between the given balls, whose radii are their distances to the surface. Bounds on its
// distance to the surface usually make a query unnecessary: it is at most the distance to their contacts. From below,
// it is bounded by interpolation, because the squared distance from a set less the squared distance from the origin is
// a minimum of linear functions, and so concave. An error of at most `fine` may be returned as 0.
double ball_error(const Surface& surface, const Point& center, double radius, double reach,
                  std::initializer_list<PartOfBall> between, double fine);

// Finds the ball of the medial axis that is nearest to a given one, by Newton's method. The contacts are held, and the
// centre moves as little as possible such that its distances to them are equal. A place that is then nearer becomes a
// contact, too. An object must not be used by several threads at once.
class BallSolver {
 public:
  // Two contacts count as one if a ball between them would lose less than `merging`, in mesh units.
  BallSolver(const Surface& surface, double merging) : surface_(surface), merging_(merging), downhill_(surface) {}

  // Finds a ball from `start`, a place of the solid. The first contacts are found downhill from `seeds`, which are
  // places on the surface. The ball lies in the solid; if none is found, it is the largest one around `start`.
  ExactBall solve(const Point& start, std::span<const ClosestPoint> seeds);
  // Finds a ball from the place that divides the line between the centres of two balls as `t` to 1 - t. The contacts
  // that both balls have are held, so that a ball between two balls of a seam belongs to the seam. If they share fewer
  // than two, the nearest contacts are held. Between two places of the surface, or outside the solid, the result is the
  // nearest place of the surface.
  ExactBall between(const ExactBall& a, const ExactBall& b, double t);

  // Returns the largest ball around a place of the solid, with its nearest contact only.
  ExactBall at(const Point& place);

  // Returns how far a convex edge of a solid lies beyond a ball of the given radius r that touches both of its faces,
  // with contacts that are seen from its centre at the angle a: r (1 / cos(a / 2) - 1). An axis that ends at this ball
  // loses at most that.
  static double loss(double radius, double angle);

  ClosestPoint descend(const Point& from, const ClosestPoint& place) { return downhill_.descend(from, place); }

 private:
  struct Held : ClosestPoint {
    int of = 0;  // a bit for each of the two balls that has it
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
