#include "detector/bodies.h"

#include <algorithm>

#include "collision/pose_change.h"

namespace orchard::runtime::detail {

bool set_local(PartRecord& part, const Shape& shape, const Pose& local) noexcept {
  if (!is_rigid(local)) return false;
  part.local = local;
  part.at_origin = local == Pose{};
  part.center = transform(local, shape.center);
  part.off = length(part.center);
  part.reach = shape.reach * local.scale;
  return std::isfinite(part.reach + part.off);
}

namespace {

Motion motion_of(const BodyState& state, double radius) noexcept {
  return {.position = state.pose.translation,
          .velocity = state.velocity,
          .radius = radius,
          .acceleration = state.acceleration,
          .drift = state.drift,
          .half_space = state.half_space,
          .expiry = state.expiry};
}

}  // namespace

bool is_valid(const BodyState& state) noexcept {
  return is_rigid(state.pose) && runtime::is_valid(motion_of(state, 0)) && state.angular_speed >= 0;
}

// The factor allows for rotations, which are exact to kRigidTolerance only.
double reach_of(const PartRecord& part) noexcept { return (part.off + part.reach) * (1 + 1e-11); }

double reach_of(std::span<const PartRecord> parts) noexcept {
  double reach = 0;
  for (const PartRecord& part : parts) reach = std::max(reach, reach_of(part));
  return reach;
}

// For one part, the middle is the centre of its sphere. For several parts, it is that of the box around their spheres.
void Body::find_middle() noexcept {
  constexpr double kWorthIt = 0.97;  // of the radius around the origin
  const std::span<const PartRecord> all = parts();
  Vec3 low = all[0].center, high = low;
  for (const PartRecord& part : all) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], part.center[i] - part.reach);
      high[i] = std::max(high[i], part.center[i] + part.reach);
    }
  }
  const Vec3 middle = all.size() == 1 ? all[0].center : 0.5 * (low + high);
  double reach = 0;
  for (const PartRecord& part : all) reach = std::max(reach, length(part.center - middle) + part.reach);
  // The factor is that of reach_of(). The other term allows for the error of the rotation, which displaces the middle.
  reach = reach * (1 + 1e-11) + 4 * kRigidTolerance * length(middle);
  if (!(reach < kWorthIt * extent.reach)) return;
  extent.middle = middle;
  extent.middle_reach = reach;
  extent.off_middle = length(middle) * (1 + 1e-11);
}

// The middle moves as the origin does, except for its rotation about the origin, which is added to the drift.
Motion Body::motion(double time_step, bool by_middle) const noexcept {
  Motion motion = motion_of(state, extent.reach * state.pose.scale + options.continuous_speed * time_step);
  if (by_middle) {
    motion.position = transform(state.pose, extent.middle);
    motion.radius = extent.middle_reach * state.pose.scale;
    // The drift also allows for the rounding error of the middle from step to step. If the middle is near the world's
    // origin, that error is large for coordinates of its size.
    constexpr double kRounding = 1e-11;  // of the distance from the body's origin
    motion.drift += (state.angular_speed + kRounding / time_step) * extent.off_middle * state.pose.scale;
  }
  if (!valid) motion.radius = -1;  // the broad phase refuses it
  return motion;
}

BoundingSphere Body::sphere() const noexcept {
  const Vec3 middle = has_middle() ? Vec3(transform(state.pose, extent.middle)) : Vec3(state.pose.translation);
  return {middle, std::min(extent.reach, extent.middle_reach) * state.pose.scale};
}

Body& BodyTable::add(BodyId id, std::size_t count) {
  const std::size_t slots = std::size_t{id.index} + 1;
  grow(bodies_, slots);
  grow(sphere_caches_, slots);
  grow(invalidated_, slots);
  invalidate(id.index);
  sphere_caches_[id.index].generation = id.generation;
  Body& body = bodies_[id.index];
  body.several.resize(count > 1 ? count : 0), body.parts_before.clear();  // nothing throws from here on
  Body added;
  added.id = id;
  added.several.swap(body.several), added.parts_before.swap(body.parts_before);
  body = std::move(added);
  return body;
}

void BodyTable::invalidate(BodyIndex body) noexcept {
  ++sphere_caches_[body].changes;
  invalidated_[body] = 1;
  any_invalidated_.store(true, std::memory_order_relaxed);
}

void BodyTable::forget_invalidated() noexcept {
  if (any_invalidated_.exchange(false)) std::fill(invalidated_.begin(), invalidated_.end(), std::uint8_t{0});
}

// The sum is rounded up, so that it remains an upper bound.
void BodyTable::add_turn(BodyIndex body, double way) noexcept {
  constexpr double kUp = 1 + 0x1p-52;
  if (way == 0) return;
  BoundingSphereCache& where = sphere_caches_[body];
  where.turned = (where.turned + way * (1 + 1e-9)) * kUp;
  if (std::isfinite(where.turned)) return;
  where.turned = 0;
  invalidate(body);
}

void BodyTable::moved(BodyIndex index, const Pose& before) noexcept {
  Body& body = bodies_[index];
  const Pose& now = body.state.pose;
  const std::span<PartRecord> parts = body.parts();
  for (PartRecord& part : parts) part.sphere = {transform(now, part.center), part.reach * now.scale};
  BoundingSphereCache& where = sphere_caches_[index];
  const bool one = parts.size() == 1;
  const double reach = one ? parts[0].reach : body.extent.reach;
  where.sphere = one ? parts[0].sphere : BoundingSphere(now.translation, kInfinity);
  double size = reach * now.scale;
  for (std::size_t i = 0; i < 3; ++i) size += std::fabs(now.translation[i]) + std::fabs(where.sphere.center[i]);
  where.slack = 1e-14 * size;
  if (!body.valid || body.is_continuous()) where.sphere.reach = where.sphere.size = kInfinity;
  const double change = pose_change(before, now);
  add_turn(index, change == 0 ? 0 : (change + 4 * kRigidTolerance * (now.scale + before.scale)) * reach);
  if (!body.valid || !std::isfinite(size)) invalidate(index);
}

void BodyTable::move_part(BodyIndex index, std::size_t part, const PartRecord& to, const Shape& shape) noexcept {
  Body& body = bodies_[index];
  PartRecord& now = body.parts()[part];
  const double rounding = 4 * kRigidTolerance * (now.local.scale + to.local.scale);
  const double way = length(to.center - now.center) + (pose_change(now.local, to.local) + rounding) * shape.reach;
  add_turn(index, way * body.state.pose.scale);
  now = to;
  if (body.several.empty()) return moved(index, body.state.pose);  // the centre of several parts is the origin
  now.sphere = {transform(body.state.pose, to.center), to.reach * body.state.pose.scale};
}

std::size_t BodyTable::memory_bytes() const noexcept {
  std::size_t bytes = bytes_of(bodies_, sphere_caches_, invalidated_);
  for (const Body& body : bodies_) bytes += bytes_of(body.several, body.parts_before);
  return bytes;
}

}  // namespace orchard::runtime::detail
