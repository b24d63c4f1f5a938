#include "solid_builder.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "triangulate.h"

namespace orchard::models {

namespace {

constexpr double kFlatness = 1e-6;

// Rounding before triangulating makes the choice of diagonals depend on the printed numbers only,
// not on how the local maths library rounds its sines.
double rounded(double value) {
  const double unit = std::pow(10.0, kDecimals);
  const double result = std::round(value * unit) / unit;
  return std::abs(result) < 0.5 / unit ? 0.0 : result;  // never a negative zero
}

Vec3 rounded(Vec3 p) { return {rounded(p.x), rounded(p.y), rounded(p.z)}; }

Vec3 polygon_normal(const std::vector<Vec3>& points, const Loop& loop) {
  Vec3 sum;
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    const Vec3 a = points[loop[0]];
    sum = sum + cross(points[loop[i]] - a, points[loop[i + 1]] - a);
  }
  return normalized(sum);
}

}  // namespace

Loop reversed(const Loop& loop) { return {loop.rbegin(), loop.rend()}; }

Loop SolidBuilder::add_loop(const Frame& frame, const Section& section) {
  Loop loop;
  for (const Vec2 p : section) {
    loop.push_back(points_.size());
    points_.push_back(frame.at(p));
  }
  return loop;
}

Loop SolidBuilder::add_projected_loop(const Loop& loop, Vec3 direction, const Frame& target) {
  const Vec3 n = target.normal();
  Loop result;
  for (const std::size_t i : loop) {
    const Vec3 p = points_[i];
    const double way = dot(target.origin - p, n) / dot(direction, n);
    result.push_back(points_.size());
    points_.push_back(p + direction * way);
  }
  return result;
}

void SolidBuilder::add_face(const Loop& outer, const std::vector<Loop>& openings) {
  Face face{{outer}};
  face.rings.insert(face.rings.end(), openings.begin(), openings.end());
  faces_.push_back(std::move(face));
}

void SolidBuilder::add_walls(const Loop& from, const Loop& to, const Openings& openings) {
  if (from.size() != to.size()) throw std::logic_error("walls between unlike loops");
  for (std::size_t i = 0; i < from.size(); ++i) {
    const std::size_t j = (i + 1) % from.size();
    const auto found = openings.find(i);
    add_face({from[i], from[j], to[j], to[i]}, found == openings.end() ? std::vector<Loop>{} : found->second);
  }
}

void SolidBuilder::add_tip(const Loop& from, Vec3 tip) {
  const std::size_t apex = points_.size();
  points_.push_back(tip);
  for (std::size_t i = 0; i < from.size(); ++i) {
    add_face({from[i], from[(i + 1) % from.size()], apex});
  }
}

Loop SolidBuilder::grow(const Loop& from, const Frame& frame, const Section& section) {
  Loop to = add_loop(frame, section);
  add_walls(from, to);
  return to;
}

Frame SolidBuilder::wall_frame(const Loop& from, const Loop& to, std::size_t side) const {
  const std::size_t next = (side + 1) % from.size();
  const Vec3 a = points_[from[side]];
  const Vec3 b = points_[from[next]];
  const Vec3 c = points_[to[next]];
  const Vec3 d = points_[to[side]];
  const Vec3 normal = normalized(cross(c - a, d - b));
  return frame_along((a + b + c + d) * 0.25, normal, b - a);
}

TriangleMesh SolidBuilder::triangulated() const {
  TriangleMesh mesh;
  for (const Vec3 p : points_) mesh.points.push_back(rounded(p));

  for (const Face& face : faces_) {
    const Loop& outer = face.rings.front();
    const Vec3 origin = mesh.points[outer[0]];
    const Frame plane = frame_along(origin, polygon_normal(mesh.points, outer), mesh.points[outer[1]] - origin);
    std::vector<std::size_t> global;
    std::vector<Vec2> flat;
    std::vector<std::vector<std::size_t>> rings;
    for (const Loop& ring : face.rings) {
      rings.emplace_back();
      for (const std::size_t i : ring) {
        const Vec3 d = mesh.points[i] - origin;
        if (std::abs(dot(d, plane.normal())) > kFlatness) {
          throw std::logic_error("a face of the model is not flat");
        }
        rings.back().push_back(flat.size());
        global.push_back(i);
        flat.push_back({dot(d, plane.x), dot(d, plane.y)});
      }
    }
    for (const IndexTriangle& t : triangulate_polygon(flat, rings)) {
      mesh.triangles.push_back({global[t[0]], global[t[1]], global[t[2]]});
    }
  }
  return mesh;
}

}  // namespace orchard::models
