#include "scene_oracle.h"

#include <algorithm>
#include <cmath>

namespace orchard::runtime::test {
namespace {

using Point = std::array<long double, 3>;
constexpr long double kRounding = 1e-11L;

struct Solid {  // a part, in the world
  const SceneShape* shape;
  Pose pose;
  std::vector<Triangle> triangles;
  Triangle core{};  // of a round shape, its segment as a degenerate triangle
  long double radius = 0;
  Point lower{}, upper{};
};

Point place(const Pose& pose, const Vec3& v) {
  Point result{};
  for (std::size_t i = 0; i < 3; ++i) {
    long double sum = 0;
    for (std::size_t j = 0; j < 3; ++j) sum += static_cast<long double>(pose.rotation[3 * i + j]) * v[j];
    result[i] = pose.scale * sum + pose.translation[i];
  }
  return result;
}

Solid solid_of(const SceneShape& shape, const Pose& pose) {
  Solid solid{&shape, pose, {}, {}, 0, {}, {}};
  if (shape.kind == SceneShape::Kind::round) {
    solid.core = {place(pose, shape.p), place(pose, shape.q), place(pose, shape.q)};
    solid.radius = static_cast<long double>(shape.radius) * pose.scale;
  } else {
    solid.triangles = placed_triangles(shape.tree, pose);
  }
  solid.lower.fill(1e30L), solid.upper.fill(-1e30L);
  const auto add = [&](const Triangle& t) {
    for (const Point& p : t) {
      for (std::size_t i = 0; i < 3; ++i) {
        solid.lower[i] = std::min(solid.lower[i], p[i] - solid.radius);
        solid.upper[i] = std::max(solid.upper[i], p[i] + solid.radius);
      }
    }
  };
  if (solid.triangles.empty()) add(solid.core);
  for (const Triangle& t : solid.triangles) add(t);
  return solid;
}

bool boxes_apart(const Solid& a, const Solid& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (a.lower[i] > b.upper[i] + kRounding || b.lower[i] > a.upper[i] + kRounding) return true;
  }
  return false;
}

bool triangles_apart(const Triangle& a, const Triangle& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::min({a[0][i], a[1][i], a[2][i]}) > std::max({b[0][i], b[1][i], b[2][i]})) return true;
    if (std::min({b[0][i], b[1][i], b[2][i]}) > std::max({a[0][i], a[1][i], a[2][i]})) return true;
  }
  return false;
}

bool inside(const Solid& box, const Point& point) {
  if (box.shape->kind != SceneShape::Kind::box) return false;
  for (std::size_t j = 0; j < 3; ++j) {
    long double along = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      along += static_cast<long double>(box.pose.rotation[3 * i + j]) * (point[i] - box.pose.translation[i]);
    }
    if (std::fabs(along) > static_cast<long double>(box.shape->p[j]) * box.pose.scale) return false;
  }
  return true;
}

enum class Meeting { no, yes, close };

Meeting meeting(const Solid& a, const Solid& b) {
  if (boxes_apart(a, b)) return Meeting::no;
  const bool round_a = a.triangles.empty(), round_b = b.triangles.empty();
  if (!round_a && !round_b) {
    for (const Triangle& p : a.triangles) {
      for (const Triangle& q : b.triangles) {
        if (!triangles_apart(p, q) && triangles_intersect(p, q)) return Meeting::yes;
      }
    }
    return inside(a, b.triangles[0][0]) || inside(b, a.triangles[0][0]) ? Meeting::yes : Meeting::no;
  }
  long double least = 1e30L;
  if (round_a && round_b) {
    least = triangle_distance(a.core, b.core);
  } else {
    const Solid &round = round_a ? a : b, &tree = round_a ? b : a;
    for (const Triangle& t : tree.triangles) least = std::min(least, triangle_distance(round.core, t));
    if (inside(tree, round.core[0])) least = 0;
  }
  const long double gap = least - a.radius - b.radius;
  if (std::fabs(gap) < kRounding) return Meeting::close;
  return gap < 0 ? Meeting::yes : Meeting::no;
}

Meeting meeting(const Solid& a, const ScenePlane& plane) {
  long double lowest = 1e30L;
  const auto add = [&](const Triangle& t) {
    for (const Point& p : t) {
      long double height = -static_cast<long double>(plane.offset);
      for (std::size_t i = 0; i < 3; ++i) height += static_cast<long double>(plane.normal[i]) * p[i];
      lowest = std::min(lowest, height - a.radius);
    }
  };
  if (a.triangles.empty()) add(a.core);
  for (const Triangle& t : a.triangles) add(t);
  if (std::fabs(lowest) < kRounding) return Meeting::close;
  return lowest < 0 ? Meeting::yes : Meeting::no;
}

}  // namespace

// The boxes of all parts, along x.
StepTruth SceneOracle::at(int step) const {
  const Scene& scene = *scene_;
  struct Part {
    std::size_t body, shape;
    Pose pose;
    Solid box;  // without its triangles: there may be a hundred thousand bodies
  };
  std::vector<Part> parts;
  StepTruth truth;
  const auto note = [&](Meeting meets, std::size_t a, std::size_t b) {
    if (meets == Meeting::yes) truth.touching.insert({a, b});
    if (meets == Meeting::close) truth.close.insert({a, b});
  };
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const SceneBody& body = scene.bodies[i];
    if (step < body.birth || step >= body.death) continue;
    for (std::size_t k = 0; k < body.parts.size(); ++k) {
      const Pose pose =
          made_rigid(compose(scene.poses[static_cast<std::size_t>(step)][i], scene.local(step, i, k))).value();
      Solid solid = solid_of(scene.shapes[body.parts[k]], pose);
      for (std::size_t p = 0; p < scene.planes.size() && !body.is_static; ++p) {
        note(meeting(solid, scene.planes[p]), i, scene.bodies.size() + p);
      }
      solid.triangles = std::vector<Triangle>();  // of its memory, too
      parts.push_back({i, body.parts[k], pose, std::move(solid)});
    }
  }
  std::sort(parts.begin(), parts.end(), [](const Part& p, const Part& q) { return p.box.lower[0] < q.box.lower[0]; });
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Part& p = parts[i];
    for (std::size_t j = i + 1; j < parts.size() && parts[j].box.lower[0] <= p.box.upper[0] + kRounding; ++j) {
      const Part& q = parts[j];
      const auto [a, b] = std::minmax(p.body, q.body);
      if (a == b || (scene.bodies[a].is_static && scene.bodies[b].is_static) || boxes_apart(p.box, q.box)) continue;
      const auto solid = [&](const Part& part) { return solid_of(scene.shapes[part.shape], part.pose); };
      note(a == p.body ? meeting(solid(p), solid(q)) : meeting(solid(q), solid(p)), a, b);
    }
  }
  return truth;
}

}  // namespace orchard::runtime::test
