#include "canonical_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace orchard::detail {
namespace {

// Two irrational numbers whose ratio is irrational, too.
constexpr double kGoldenPart = 0.61803398874989485, kSilverPart = 0.41421356237309505;
// The cell size of the lattice that vertices are rounded to. It is coarse compared with the rounding errors of a mesh
// that lies a thousand times its size off the origin, but fine compared with the triangles: those of a flat face whose
// edges are a thousandth of the mesh's size stay coplanar within tolerance::kCoplanarAngle.
constexpr double kLattice = kGoldenPart * 0x1p-23;
// Lattices for meshes that are not solid when rounded to the first, because their thinnest triangles lose their area.
// The last means no lattice.
constexpr double kFinerLattices[] = {kGoldenPart * 0x1p-31, kGoldenPart * 0x1p-39, 0};
constexpr double kFineLattice = kSilverPart * 0x1p-22, kCoarseLattice = kSilverPart * 0x1p-9;

constexpr double kHalfDiagonal = 0.867;  // of a cell of side 1
constexpr double kFrameRounding =
    0x1p-48;  // the rounding errors of bringing a point into the frame, where numbers are about 1

Point on_lattice(const Point& point, double lattice) {
  Point result;
  for (int axis = 0; axis < 3; ++axis) result[axis] = lattice * std::nearbyint(point[axis] / lattice);
  return result;
}

// Carries a point of a triangle to the same place of the triangle with moved corners.
Point carried(const Point& point, const std::array<Point, 3>& from, const std::array<Point, 3>& to) {
  const Vector u = from[1] - from[0], v = from[2] - from[0], normal = u.cross(v), place = point - from[0];
  const double area = normal.squaredNorm();
  const double beta = area > 0 ? v.cross(normal).dot(place) / area : 0;
  const double gamma = area > 0 ? normal.cross(u).dot(place) / area : 0;
  const Point about = to[0] + beta * (to[1] - to[0]) + gamma * (to[2] - to[0]);
  return closest_point_of_triangle(about, to[0], to[1], to[2]).position;
}

SurfaceSampling carried(SurfaceSampling sampling, const Surface& from, const Surface& to) {
  for (Index i = 0; i < sampling.size(); ++i) {
    const Index triangle = sampling.triangles[i];
    sampling.points[i] = carried(sampling.points[i], from.corners(triangle), to.corners(triangle));
  }
  return sampling;
}

}  // namespace

CanonicalFrame::CanonicalFrame(const Box& box, double lattice)
    : center_(box.min() + 0.5 * box.sizes()), lattice_(lattice) {
  const double half = 0.5 * box.sizes().maxCoeff();
  if (half > 0) scale_ = half;
}

Point CanonicalFrame::in(const Point& point) const {
  const Point place = (point - center_) / scale_;
  return lattice_ > 0 ? on_lattice(place, lattice_) : place;
}

TriangleMesh CanonicalFrame::in(const TriangleMesh& mesh) const {
  TriangleMesh result{{}, mesh.triangles};
  result.vertices.reserve(mesh.vertices.size());
  for (const Point& vertex : mesh.vertices) result.vertices.push_back(in(vertex));
  return result;
}

Refinement CanonicalFrame::in(const Refinement& refinement) const {
  Refinement result{refinement.error / scale_, {}};
  for (const Refinement::Region& region : refinement.regions)
    result.regions.push_back(
        {{(region.where.center - center_) / scale_, region.where.radius / scale_}, region.error / scale_});
  return result;
}

Sphere CanonicalFrame::out(const Sphere& ball) const {
  const Point center = center_ + scale_ * ball.center;
  const double rounding =
      std::numeric_limits<double>::epsilon() * (center_.cwiseAbs().sum() + scale_ * ball.center.cwiseAbs().sum());
  return {center, scale_ * (ball.radius + kHalfDiagonal * lattice_ + kFrameRounding) + rounding};
}

Point on_fine_lattice(const Point& point) { return on_lattice(point, kFineLattice); }
Point on_coarse_lattice(const Point& point) { return on_lattice(point, kCoarseLattice); }

FramedSurface::FramedSurface(const Surface& given)
    : given_(given), frame_(given.bounding_box(), kLattice), surface_(frame_.in(given.mesh()), given.ball_kind()) {
  for (const double lattice : kFinerLattices) {
    if (surface_.solid() || !given.solid()) return;
    frame_ = CanonicalFrame(given.bounding_box(), lattice);
    surface_ = Surface(frame_.in(given.mesh()), given.ball_kind());
  }
}

SurfaceSampling FramedSurface::in(SurfaceSampling sampling) const {
  return carried(std::move(sampling), given_, surface_);
}

SurfaceSampling FramedSurface::out(SurfaceSampling sampling) const {
  return carried(std::move(sampling), surface_, given_);
}

void FramedSurface::take_out(SphereTree& tree) const {
  for (SphereNode& node : tree.nodes)
    node = {frame_.out(node.sphere), node.parent, node.first_child, node.child_count, node.level};
}

}  // namespace orchard::detail
