#include "detector/world_queries.h"

#include <algorithm>

#include "detector/detector_state.h"
#include "detector/solid_shapes.h"

namespace orchard::runtime {
namespace detail {
namespace {

constexpr std::uint32_t kLeaf = 4;    // parts that a leaf has at most
constexpr double kRoom = 1e-9;        // of coordinates and radii: more than what rotations and rounding are off by
constexpr std::size_t kDeepest = 64;  // levels: halves of 2^32 parts are fewer

bool is_finite(const Vec3& v) noexcept { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

bool counts(const Body& body, const QueryFilter& filter) noexcept {
  return (body.category & filter.mask) != 0 && (body.mask & filter.category) != 0;
}

// The least distance of a point from a box.
double distance_to(const Vec3& low, const Vec3& high, const Vec3& point) noexcept {
  Vec3 way{};
  for (std::size_t i = 0; i < 3; ++i) way[i] = std::max({low[i] - point[i], point[i] - high[i], 0.0});
  return length(way);
}

bool is_better(const WorldPoint& a, const WorldPoint& b) noexcept {
  return std::tie(a.distance, a.body.index, a.part) < std::tie(b.distance, b.body.index, b.part);
}

}  // namespace

// Static bodies, those that the detector moves, those that the last step has asked for; the source knows the others.
void WorldQueries::find_poses(const World& world) {
  const BodyTable& bodies = world.bodies;
  const double time = world.time_of_last_step();
  Pose nowhere;
  nowhere.rotation = {};
  poses_.assign(bodies.slots(), nowhere);
  asked_.clear();
  for (BodyIndex i = 0; i < bodies.slots(); ++i) {
    const Body& body = bodies[i];
    if (body.id == kNoBody) continue;
    if (body.is_static) {
      poses_[i] = body.state.pose;
    } else if (world.kept_states) {
      poses_[i] = world.kept_states->at(time, i).pose;
    } else if (body.frozen || (body.asked == world.answered && world.answered >= 0)) {
      if (body.valid) poses_[i] = body.state.pose;
    } else {
      asked_.push_back(i);
    }
  }
  if (asked_.empty()) return;
  answers_.resize(asked_.size());
  bodies.look(time, asked_, answers_);
  for (std::size_t k = 0; k < asked_.size(); ++k) {
    if (is_valid(answers_[k])) poses_[asked_[k]] = answers_[k].pose;
  }
}

Pose WorldQueries::pose_of(const World& world, const Part& part) const noexcept {
  const PartRecord& record = world.bodies[part.body].parts[part.part];
  return record.at_origin ? poses_[part.body] : placed(poses_[part.body], record.local);
}

void WorldQueries::update(const World& world) {
  if (at_ == world.answered && changes_ == world.changes) return;
  at_ = kNotAsked;  // where memory runs out, all is found again
  find_poses(world);
  parts_.clear(), nodes_.clear();
  for (BodyIndex i = 0; i < poses_.size(); ++i) {
    if (world.bodies[i].id == kNoBody || !is_rigid(poses_[i])) continue;
    const auto& parts = world.bodies[i].parts;
    for (std::uint32_t k = 0; k < parts.size(); ++k) {
      Part part{transform(poses_[i], parts[k].center), parts[k].reach * poses_[i].scale, i, k};
      const Vec3& c = part.center;
      part.reach += kRoom * (part.reach + std::fabs(c[0]) + std::fabs(c[1]) + std::fabs(c[2]));
      if (is_finite(c) && std::isfinite(part.reach)) parts_.push_back(part);
    }
  }
  if (!parts_.empty()) build(0, static_cast<std::uint32_t>(parts_.size()));
  at_ = world.answered, changes_ = world.changes;
}

// In half, across the axis along which the centres reach farthest.
std::uint32_t WorldQueries::build(std::uint32_t begin, std::uint32_t end) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  Node node;
  Vec3 low = parts_[begin].center, high = low;
  node.low = low, node.high = high;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Part& part = parts_[i];
    for (std::size_t d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], part.center[d]), high[d] = std::max(high[d], part.center[d]);
      node.low[d] = std::min(node.low[d], part.center[d] - part.reach);
      node.high[d] = std::max(node.high[d], part.center[d] + part.reach);
    }
  }
  node.begin = begin, node.end = end;
  nodes_.push_back(node);
  if (end - begin <= kLeaf) return index;
  const Vec3 extent = high - low;
  const std::size_t axis = static_cast<std::size_t>(std::max_element(extent.begin(), extent.end()) - extent.begin());
  const std::uint32_t middle = begin + (end - begin) / 2;
  const auto at = [&](std::uint32_t i) { return parts_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [axis](const Part& p, const Part& q) {
    return std::tie(p.center[axis], p.body, p.part) < std::tie(q.center[axis], q.body, q.part);
  });
  build(begin, middle);
  const std::uint32_t second = build(middle, end);
  nodes_[index].second = second;
  return index;
}

template <typename Bound, typename Most, typename Visit>
void WorldQueries::walk(const Bound& bound, const Most& most, const Visit& visit) const {
  struct Open {
    double bound;
    std::uint32_t node;
  };
  std::array<Open, 2 * kDeepest> open;
  std::size_t count = 0;
  const auto push = [&](std::uint32_t node) {
    const double least = bound(nodes_[node].low, nodes_[node].high);
    if (least <= most() && least < std::numeric_limits<double>::infinity()) open[count++] = {least, node};
  };
  if (!nodes_.empty()) push(0);
  while (count > 0) {
    const Open top = open[--count];
    if (!(top.bound <= most())) continue;
    const Node& node = nodes_[top.node];
    if (node.second == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) visit(parts_[i]);
      continue;
    }
    push(top.node + 1), push(node.second);
    if (count >= 2 && open[count - 1].node == node.second && open[count - 2].node == top.node + 1 &&
        open[count - 2].bound < open[count - 1].bound) {
      std::swap(open[count - 1], open[count - 2]);  // the nearer one first
    }
  }
}

std::optional<WorldPoint> WorldQueries::cast_ray(const World& world, const Ray& ray, const QueryFilter& filter) {
  std::optional<WorldPoint> best;
  const auto most = [&] { return best ? best->distance : ray.longest; };
  const auto offer = [&](const Body& body, std::uint32_t part, const std::optional<RayHit>& hit) {
    if (!hit) return;
    const WorldPoint found{body.id, part, hit->along, hit->point, hit->triangle};
    if (!best || is_better(found, *best)) best = found;
  };
  world.halves.each([&](const Body& body, const HalfSpace& half) {
    if (counts(body, filter)) offer(body, 0, detail::cast_ray(half, ray));
  });
  walk([&](const Vec3& low, const Vec3& high) { return enters_box(low, high, ray.origin, ray.direction, kInfinity); },
       most,
       [&](const Part& part) {
         const Body& body = world.bodies[part.body];
         if (!counts(body, filter)) return;
         const Shape& shape = world.shapes[body.parts[part.part].shape];
         offer(body, part.part, detail::cast_ray(shape, pose_of(world, part), {ray.origin, ray.direction, most()}));
       });
  return best;
}

std::optional<WorldPoint> WorldQueries::nearest(const World& world, const Vec3& point, double limit,
                                                const QueryFilter& filter) {
  std::optional<WorldPoint> best;
  const auto most = [&] { return best ? best->distance : limit; };
  const auto offer = [&](const Body& body, std::uint32_t part, const SurfacePoint& near) {
    if (!(near.distance <= most())) return;
    const WorldPoint found{body.id, part, near.distance, near.point, near.triangle};
    if (!best || is_better(found, *best)) best = found;
  };
  world.halves.each([&](const Body& body, const HalfSpace& half) {
    if (counts(body, filter)) offer(body, 0, nearest_point(half, point, limit));
  });
  walk([&](const Vec3& low, const Vec3& high) { return distance_to(low, high, point); }, most,
       [&](const Part& part) {
         const Body& body = world.bodies[part.body];
         if (!counts(body, filter)) return;
         const Shape& shape = world.shapes[body.parts[part.part].shape];
         offer(body, part.part, nearest_point(shape, pose_of(world, part), point, most()));
       });
  if (best && !std::isfinite(best->distance)) best.reset();
  return best;
}

std::span<const BodyId> WorldQueries::touching_sphere(const World& world, const Vec3& center, double radius,
                                                      const QueryFilter& filter) {
  found_.clear();
  walk([&](const Vec3& low, const Vec3& high) { return distance_to(low, high, center); }, [&] { return radius; },
       [&](const Part& part) {
         const Body& body = world.bodies[part.body];
         if (!counts(body, filter)) return;
         const Shape& shape = world.shapes[body.parts[part.part].shape];
         if (nearest_point(shape, pose_of(world, part), center, radius).distance <= radius) found_.push_back(body.id);
       });
  world.halves.each([&](const Body& body, const HalfSpace& half) {
    if (counts(body, filter) && nearest_point(half, center, radius).distance <= radius) found_.push_back(body.id);
  });
  const auto by_index = [](const BodyId& p, const BodyId& q) { return p.index < q.index; };
  std::sort(found_.begin(), found_.end(), by_index);
  found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
  return found_;
}

}  // namespace detail

std::optional<WorldPoint> Detector::cast_ray(const Ray& ray, const QueryFilter& filter) {
  State& s = *state_;
  const Vec3 way = ray.direction;
  if (!s.takes_changes() || !detail::is_finite(ray.origin) || !detail::is_finite(way) ||
      (way[0] == 0 && way[1] == 0 && way[2] == 0) || !(ray.longest >= 0))
    return std::nullopt;
  s.queries.update(s.world);
  return s.queries.cast_ray(s.world, ray, filter);
}

std::optional<WorldPoint> Detector::nearest(const Vec3& point, double limit, const QueryFilter& filter) {
  State& s = *state_;
  if (!s.takes_changes() || !detail::is_finite(point) || !(limit >= 0)) return std::nullopt;
  s.queries.update(s.world);
  return s.queries.nearest(s.world, point, limit, filter);
}

std::span<const BodyId> Detector::touching_sphere(const Vec3& center, double radius, const QueryFilter& filter) {
  State& s = *state_;
  if (!s.takes_changes() || !detail::is_finite(center) || !(radius >= 0) || !std::isfinite(radius)) return {};
  s.queries.update(s.world);
  return s.queries.touching_sphere(s.world, center, radius, filter);
}

}  // namespace orchard::runtime
