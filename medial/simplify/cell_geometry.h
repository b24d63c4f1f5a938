#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "contractible_mesh.h"

namespace orchard::detail {

// The ball of a cell that comes nearest to a point: its shares of the cell's corners, and |point - centre| - radius.
// This is a convex function on a cell, so it has a single minimum.
struct CellFoot {
  std::array<double, 3> weights{1, 0, 0};
  double value = 0;
};

inline double value_of(const Point& query, const Ball4& ball) { return (query - ball.head<3>()).norm() - ball[3]; }

// The balls between two balls, prepared for many queries.
class EdgeBalls {
 public:
  EdgeBalls() = default;
  EdgeBalls(const Ball4& a, const Ball4& b) : a_(a) {
    const Vector along = (b - a).head<3>();
    length_ = along.norm();
    if (length_ > 0) {
      unit_ = along / length_;
      slope_ = (b[3] - a[3]) / length_;
      if (std::abs(slope_) < 1) cosine_ = std::sqrt(1 - slope_ * slope_), lead_ = slope_ / cosine_;
    } else if (b[3] > a[3]) {
      a_[3] = b[3];
      share_of_only_ = 1;
    }
  }

  const Ball4& first() const { return a_; }

  // Along the segment, the value sqrt(height^2 + (t - foot)^2) - r(t) is smallest where the slope of the root equals
  // that of the radius. `share` receives the share of b.
  double value(const Point& query, double& share) const {
    const Vector offset = query - a_.head<3>();
    const double foot = unit_.dot(offset), squared = offset.squaredNorm();
    if (!(length_ > 0)) {
      share = share_of_only_;
      return std::sqrt(squared) - a_[3];
    }
    const double height = std::sqrt(std::max(0.0, squared - foot * foot));
    // Otherwise, one of the two balls contains the other.
    const double at = cosine_ > 0 ? foot + lead_ * height : slope_ * length_;
    if (at <= 0) return share = 0, std::sqrt(squared) - a_[3];
    if (at < length_ && cosine_ > 0) return share = at / length_, cosine_ * height - (a_[3] + slope_ * foot);
    share = 1;
    const double beyond = foot - length_;
    return std::sqrt(height * height + beyond * beyond) - (a_[3] + slope_ * length_);
  }

 private:
  Ball4 a_ = Ball4::Zero();
  Vector unit_ = Vector::Zero();  // from a to b
  double length_ = 0, slope_ = 0, cosine_ = 0, lead_ = 0;
  double share_of_only_ = 0;  // the share if both have the same centre
};

// The balls over the plane of three balls, prepared for many queries. Their radius has a gradient in the plane, and the
// nearest ball is one step along it from the foot of the perpendicular.
class PlaneBalls {
 public:
  PlaneBalls() = default;
  PlaneBalls(const Ball4& a, const Ball4& b, const Ball4& c) : a_(a) {
    const Vector u = (b - a).head<3>(), v = (c - a).head<3>(), normal = u.cross(v);
    const double squared = normal.squaredNorm();
    if (!(squared > 0)) return;
    across_v_ = v.cross(normal) / squared;
    across_u_ = normal.cross(u) / squared;
    gradient_ = (b[3] - a[3]) * across_v_ + (c[3] - a[3]) * across_u_;
    const double steep = gradient_.squaredNorm();
    if (!(steep < 1)) return;
    unit_ = normal / std::sqrt(squared);
    cosine_ = std::sqrt(1 - steep);
    beta_lead_ = across_v_.dot(gradient_) / cosine_;
    gamma_lead_ = across_u_.dot(gradient_) / cosine_;
  }

  // Whether a nearest ball exists over the whole plane.
  bool has_foot() const { return cosine_ > 0; }
  // Returns the value of the nearest ball and its shares of b and c. Shares below 0 mean that it lies beyond the edges.
  double value(const Point& query, double& beta, double& gamma) const {
    const Vector offset = query - a_.head<3>();
    const double height = std::abs(unit_.dot(offset));
    beta = across_v_.dot(offset) + beta_lead_ * height;
    gamma = across_u_.dot(offset) + gamma_lead_ * height;
    return cosine_ * height - (a_[3] + gradient_.dot(offset));
  }

 private:
  Ball4 a_ = Ball4::Zero();
  Vector unit_ = Vector::Zero();                                  // at right angles
  Vector across_v_ = Vector::Zero(), across_u_ = Vector::Zero();  // gradients of the shares of b and c
  Vector gradient_ = Vector::Zero();                              // of the radius
  double cosine_ = 0, beta_lead_ = 0, gamma_lead_ = 0;
};

// Finds the nearest ball of a triangle. `edge(i)` returns the EdgeBalls from corner i to the next one.
template <class Edge>
CellFoot foot_on_triangle(const PlaneBalls& plane, const Edge& edge, const Point& query) {
  CellFoot best{.value = std::numeric_limits<double>::infinity()};
  // A negative share means that the nearest ball of the plane lies beyond the opposite edge.
  std::array<double, 3> shares{-1, -1, -1};
  if (plane.has_foot()) {
    const double value = plane.value(query, shares[1], shares[2]);
    shares[0] = 1 - shares[1] - shares[2];
    if (shares[0] >= 0 && shares[1] >= 0 && shares[2] >= 0) return {shares, value};
  }
  // From the nearest ball of the plane to the nearest one of the triangle, the value rises. So the path between them
  // has no part inside the triangle, and the latter is on an edge that the path crosses.
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    if (shares[k] >= 0) continue;
    double share = 0;
    const double value = edge(i).value(query, share);
    if (value >= best.value) continue;
    best.value = value;
    best.weights[i] = 1 - share;
    best.weights[j] = share;
    best.weights[k] = 0;
  }
  return best;
}

// A cell prepared for many queries. Cells smaller than triangles repeat their first corner.
class CellBalls {
 public:
  CellBalls(const ContractibleMesh& mesh, const std::array<Index, 3>& corners) : corners_(corners) { prepare(mesh); }
  // Call this after the balls of the mesh have moved.
  void prepare(const ContractibleMesh& mesh) {
    const auto& [ia, ib, ic] = corners_;
    const Ball4 &a = mesh.ball(ia), &b = mesh.ball(ib), &c = mesh.ball(ic);
    edges_[0] = EdgeBalls(a, b);
    if (ic == ia) return;
    edges_[1] = EdgeBalls(b, c);
    edges_[2] = EdgeBalls(c, a);
    plane_ = PlaneBalls(a, b, c);
  }
  const std::array<Index, 3>& corners() const { return corners_; }

  CellFoot foot(const Point& query) const {
    if (corners_[1] == corners_[0]) return {.value = value_of(query, edges_[0].first())};
    if (corners_[2] == corners_[0]) {
      CellFoot foot;
      foot.value = edges_[0].value(query, foot.weights[1]);
      foot.weights[0] = 1 - foot.weights[1];
      return foot;
    }
    return foot_on_triangle(
        plane_, [&](std::size_t i) -> const EdgeBalls& { return edges_[i]; }, query);
  }

 private:
  std::array<Index, 3> corners_;
  PlaneBalls plane_;
  std::array<EdgeBalls, 3> edges_;
};

}  // namespace orchard::detail
