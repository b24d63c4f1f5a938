#include "detector/world_queries.h"

#include <algorithm>
#include <tuple>

#include "detector/detector_state.h"
#include "detector/solid_shapes.h"

namespace orchard::runtime {
namespace detail {
namespace {

bool is_finite(const Vec3& v) noexcept { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

bool counts(const Body& body, const QueryFilter& filter) noexcept {
  const BodyFilter& own = body.options.filter;
  return (own.category & filter.mask) != 0 && (own.mask & filter.category) != 0;
}

void take_nearer(std::optional<WorldPoint>& best, const WorldPoint& found) noexcept {
  const auto rank = [](const WorldPoint& p) { return std::tuple(p.distance, p.body.index, p.part); };
  if (!best || rank(found) < rank(*best)) best = found;
}

}  // namespace

// Finds the poses of all bodies at the last step. The detector knows those of static bodies, of bodies whose states it
// keeps, and of bodies that the last step has sampled or that sleep. It asks the source for the others.
void WorldQueries::find_poses() {
  const BodyTable& bodies = world_.bodies;
  const double time = world_.time_of_last_step();
  poses_.assign(bodies.slots(), {.rotation = {}});  // not rigid: the body is nowhere
  asked_.clear();
  for (BodyIndex i = 0; i < bodies.slots(); ++i) {
    const Body& body = bodies[i];
    if (body.id == kNoBody) continue;
    if (world_.kept_states && !body.is_static) {
      poses_[i] = world_.kept_states->at(time, i).pose;
    } else if (body.is_static || body.frozen || (body.steps.asked == world_.answered && world_.answered >= 0)) {
      if (body.is_static || body.valid) poses_[i] = body.state.pose;
    } else {
      asked_.push_back(i);
    }
  }
  if (asked_.empty()) return;
  answers_.resize(asked_.size());
  sampler_.source()(time, asked_, answers_);
  for (std::size_t k = 0; k < asked_.size(); ++k) {
    if (is_valid(answers_[k])) poses_[asked_[k]] = answers_[k].pose;
  }
}

void WorldQueries::update() {
  if (at_ == world_.answered && changes_ == world_.changes) return;
  at_ = kNotAsked;  // if memory runs out below, the next query begins again
  find_poses();
  tree_.clear();
  for (BodyIndex i = 0; i < poses_.size(); ++i) {
    if (world_.bodies[i].id == kNoBody || !is_rigid(poses_[i])) continue;
    const std::span<const PartRecord> parts = world_.bodies[i].parts();
    for (std::uint32_t k = 0; k < parts.size(); ++k) {
      const BoundingSphere sphere(transform(poses_[i], parts[k].center), parts[k].reach * poses_[i].scale);
      if (std::isfinite(sphere.size)) tree_.add(sphere, i, k);
    }
  }
  tree_.build();
  at_ = world_.answered, changes_ = world_.changes;
}

// Calls use(target) for the half-spaces, and for the parts in boxes for which bound(low, high) is at most most(), as
// far as the filter allows them.
template <typename Bound, typename Most, typename Use>
void WorldQueries::each_target(const QueryFilter& filter, const Bound& bound, const Most& most, const Use& use) {
  update();
  world_.halves.each([&](const Body& body, const Shape& shape) {
    if (counts(body, filter)) use(Target{.body = body, .shape = shape});
  });
  const auto use_part = [&](const SphereTree::Part& part) {
    const Body& body = world_.bodies[part.body];
    if (!counts(body, filter)) return;
    const PartRecord& record = body.parts()[part.part];
    const Pose& pose = poses_[part.body];
    use(Target{.body = body,
               .part = part.part,
               .shape = world_.shapes[record.shape],
               .pose = record.at_origin ? pose : placed(pose, record.local)});
  };
  tree_.walk(bound, most, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) use_part(tree_.parts()[i]);
  });
}

// Calls use(target, point) for the targets whose distance from `to` is at most most(), with their nearest points.
template <typename Most, typename Use>
void WorldQueries::each_near(const QueryFilter& filter, const Vec3& to, const Most& most, const Use& use) {
  const auto bound = [&](const Vec3& low, const Vec3& high) { return std::sqrt(square_to_box(low, high, to)); };
  each_target(filter, bound, most, [&](const Target& target) {
    const SurfacePoint near = nearest_point(target.shape, target.pose, to, most());
    if (std::isfinite(near.distance)) use(target, near);
  });
}

std::optional<WorldPoint> WorldQueries::cast_ray(const Ray& ray, const QueryFilter& filter) {
  std::optional<WorldPoint> best;
  const auto most = [&] { return best ? best->distance : ray.longest; };
  const auto bound = [&](const Vec3& low, const Vec3& high) {
    return enters_box(low, high, ray.origin, ray.direction, kInfinity);
  };
  each_target(filter, bound, most, [&](const Target& target) {
    const auto hit = detail::cast_ray(target.shape, target.pose, {ray.origin, ray.direction, most()});
    if (hit) take_nearer(best, {target.body.id, target.part, hit->along, hit->point, hit->triangle});
  });
  return best;
}

std::optional<WorldPoint> WorldQueries::nearest(const Vec3& point, double limit, const QueryFilter& filter) {
  std::optional<WorldPoint> best;
  const auto most = [&] { return best ? best->distance : limit; };
  each_near(filter, point, most, [&](const Target& target, const SurfacePoint& near) {
    take_nearer(best, {target.body.id, target.part, near.distance, near.point, near.triangle});
  });
  return best;
}

std::span<const BodyId> WorldQueries::touching_sphere(const Vec3& center, double radius, const QueryFilter& filter) {
  found_.clear();
  const auto most = [&] { return radius; };
  each_near(filter, center, most, [&](const Target& target, const SurfacePoint&) { found_.push_back(target.body.id); });
  const auto by_index = [](const BodyId& p, const BodyId& q) { return p.index < q.index; };
  std::sort(found_.begin(), found_.end(), by_index);
  found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
  return found_;
}

}  // namespace detail

std::optional<WorldPoint> Detector::cast_ray(const Ray& ray, const QueryFilter& filter) {
  constexpr Vec3 no_direction{};
  State& s = *state_;
  if (!s.takes_changes() || !detail::is_finite(ray.origin) || !detail::is_finite(ray.direction) ||
      ray.direction == no_direction || !(ray.longest >= 0))
    return std::nullopt;
  return s.queries.cast_ray(ray, filter);
}

std::optional<WorldPoint> Detector::nearest(const Vec3& point, double limit, const QueryFilter& filter) {
  State& s = *state_;
  if (!s.takes_changes() || !detail::is_finite(point) || !(limit >= 0)) return std::nullopt;
  return s.queries.nearest(point, limit, filter);
}

std::span<const BodyId> Detector::touching_sphere(const Vec3& center, double radius, const QueryFilter& filter) {
  State& s = *state_;
  if (!s.takes_changes() || !detail::is_finite(center) || !(radius >= 0) || !std::isfinite(radius)) return {};
  return s.queries.touching_sphere(center, radius, filter);
}

}  // namespace orchard::runtime
