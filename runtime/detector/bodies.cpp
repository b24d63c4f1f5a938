#include "detector/bodies.h"

#include <algorithm>

#include "collision/pose_change.h"

namespace orchard::runtime {

StateSource states_of(const std::vector<BodyState>& values) {
  return [&values](double, std::span<const BodyIndex> bodies, std::span<BodyState> states) {
    BodyState none;  // refused
    none.pose.rotation = {};
    for (std::size_t i = 0; i < bodies.size(); ++i) states[i] = bodies[i] < values.size() ? values[bodies[i]] : none;
  };
}

namespace detail {

// In floats a coordinate is off by 2^-24 of itself, a difference by that of both and 2^-24 of itself, a square of a way
// or of a sum of radii by less than 2^-21 of itself.
FloatSphere FloatSphere::around(const BoundingSphere& sphere, double slack) noexcept {
  constexpr double kMost = 1e30;    // whose squares no float holds: nothing is known then
  constexpr double kLeast = 1e-17;  // whose square floats hold with all digits
  const Vec3& m = sphere.center;
  const double length = std::fabs(m[0]) + std::fabs(m[1]) + std::fabs(m[2]);
  const double enlarged = (sphere.reach + kRoundingOfGaps * slack + 0x1p-23 * length) * (1 + 0x1p-18);
  if (!(length + enlarged < kMost)) return {};
  const auto rounded = [](double value) { return static_cast<float>(value); };
  return {rounded(m[0]), rounded(m[1]), rounded(m[2]), rounded(std::max(enlarged, kLeast))};
}

bool set_local(PartPlace& part, const Shape& shape, const Pose& local) noexcept {
  if (!is_rigid(local)) return false;
  part.local = local;
  part.at_origin = local == Pose{};
  part.center = transform(local, shape.center);
  part.off = length(part.center);
  part.reach = shape.reach * local.scale;
  return std::isfinite(part.reach + part.off);
}

bool is_valid(const BodyState& state) noexcept {
  Motion motion;
  motion.position = state.pose.translation;
  motion.velocity = state.velocity;
  motion.acceleration = state.acceleration;
  motion.drift = state.drift;
  motion.half_space = state.half_space;
  motion.expiry = state.expiry;
  return is_rigid(state.pose) && runtime::is_valid(motion) && state.angular_speed >= 0;
}

// Rotations are rotations to kRigidTolerance only.
double reach_of(const PartPlace& part) noexcept { return (part.off + part.reach) * (1 + 1e-11); }

double reach_of(std::span<const PartRecord> parts) noexcept {
  double reach = 0;
  for (const PartRecord& part : parts) reach = std::max(reach, reach_of(part));
  return reach;
}

// Around the middle of a box around the parts' spheres.
void find_middle(Body& body) noexcept {
  constexpr double kWorthIt = 0.97;  // of the radius around the origin
  Vec3 low = body.parts[0].center, high = low;
  for (const PartRecord& part : body.parts) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], part.center[i] - part.reach);
      high[i] = std::max(high[i], part.center[i] + part.reach);
    }
  }
  const Vec3 middle = body.parts.size() == 1 ? body.parts[0].center : 0.5 * (low + high);
  double reach = 0;
  for (const PartRecord& part : body.parts) reach = std::max(reach, length(part.center - middle) + part.reach);
  // As in reach_of(); the middle itself is off by what rotations are.
  reach = reach * (1 + 1e-11) + 4 * kRigidTolerance * length(middle);
  if (!(reach < kWorthIt * body.reach)) return;
  body.middle = middle;
  body.middle_reach = reach;
  body.off_middle = length(middle) * (1 + 1e-11);
}

Body& BodyTable::add(BodyId id, std::size_t count) {
  const std::size_t slots = std::size_t{id.index} + 1;
  grow(bodies_, slots);
  grow(sphere_caches_, slots);
  grow(float_spheres_, slots);
  grow(invalidated_, slots);
  invalidate(id.index);
  sphere_caches_[id.index].generation = id.generation;
  make_room(asking_, slots);  // for asking everyone
  Body& body = bodies_[id.index];
  body.parts.clear();
  body.parts.reserve(count);
  const std::size_t several = count > 1 ? count : 0;
  body.part_spheres.assign(several, BoundingSphere{});
  body.float_part_spheres.assign(several, FloatSphere{});  // nothing throws from here on
  std::vector<PartRecord> parts = std::move(body.parts);
  std::vector<PartBefore> parts_before = std::move(body.parts_before);
  std::vector<BoundingSphere> part_spheres = std::move(body.part_spheres);
  std::vector<FloatSphere> float_part_spheres = std::move(body.float_part_spheres);
  body = Body{};
  body.parts = std::move(parts);
  body.parts_before = std::move(parts_before);
  body.parts_before.clear();
  body.part_spheres = std::move(part_spheres);
  body.float_part_spheres = std::move(float_part_spheres);
  any_parts_ = any_parts_ || count > 1;
  body.id = id;
  return body;
}

void BodyTable::invalidate(BodyIndex body) noexcept {
  ++sphere_caches_[body].changes;
  invalidated_[body] = 1;
  any_invalidated_.store(true, std::memory_order_relaxed);
}

void BodyTable::forget_invalidated() noexcept {
  if (!any_invalidated()) return;
  std::fill(invalidated_.begin(), invalidated_.end(), std::uint8_t{0});
  any_invalidated_.store(false, std::memory_order_relaxed);
}

void BodyTable::parts_changed(BodyIndex index) noexcept {
  Body& body = bodies_[index];
  const PartRecord& first = body.parts[0];
  body.one = body.parts.size() == 1;
  body.at_origin = first.at_origin;
  body.shape = first.shape;
  body.first_center = first.center;
  body.first_reach = first.reach;
}

// A sum that is not rounded down, so that it never says too little.
void BodyTable::add_turn(BodyIndex body, double way) noexcept {
  constexpr double kUp = 1 + 0x1p-52;
  if (way == 0) return;
  BoundingSphereCache& where = sphere_caches_[body];
  where.turned = (where.turned + way * (1 + 1e-9)) * kUp;
  if (std::isfinite(where.turned)) return;
  where.turned = 0;
  invalidate(body);
}

// Its sphere, where there are several.
void BodyTable::place_part(Body& body, std::size_t part) noexcept {
  const Pose& pose = body.state.pose;
  const PartRecord& record = body.parts[part];
  BoundingSphere& sphere = body.part_spheres[part];
  sphere = BoundingSphere(transform(pose, record.center), record.reach * pose.scale);
  double size = record.off * pose.scale + sphere.size;
  for (std::size_t k = 0; k < 3; ++k) size += std::fabs(pose.translation[k]);
  BoundingSphere near = sphere;
  if (!body.valid || body.continuous_speed > 0) near.reach = std::numeric_limits<double>::infinity();
  body.float_part_spheres[part] = FloatSphere::around(near, 1e-14 * size);
}

void BodyTable::place_parts(Body& body) noexcept {
  for (std::size_t part = 0; part < body.part_spheres.size(); ++part) place_part(body, part);
  body.parts_moved = false;
}

BoundingSphere BodyTable::sphere_around(BodyIndex index) const noexcept {
  const Body& body = bodies_[index];
  const Pose& pose = body.state.pose;
  const Vec3 middle = body.has_middle() ? transform(pose, body.middle) : Vec3(pose.translation);
  return {middle, std::min(body.reach, body.middle_reach) * pose.scale};
}

void BodyTable::moved(BodyIndex index, const Pose& before) noexcept {
  Body& body = bodies_[index];
  const Pose& now = bodies_[index].state.pose;
  BoundingSphereCache& where = sphere_caches_[index];
  const double reach = body.one ? body.first_reach : body.reach;
  const Vec3 center = body.one ? transform(now, body.first_center) : Vec3(now.translation);
  double size = reach * now.scale;
  for (std::size_t i = 0; i < 3; ++i) size += std::fabs(now.translation[i]) + std::fabs(center[i]);
  where.slack = 1e-14 * size;
  const bool known = body.one && body.valid && !(body.continuous_speed > 0);
  where.sphere = BoundingSphere(center, known ? reach * now.scale : std::numeric_limits<double>::infinity());
  float_spheres_[index] = FloatSphere::around(where.sphere, where.slack);
  place_parts(body);
  const double change = pose_change(before, now);
  add_turn(index, change == 0 ? 0 : (change + 4 * kRigidTolerance * (now.scale + before.scale)) * reach);
  if (!body.valid || !std::isfinite(size)) invalidate(index);
}

// A body that is asked at each step is placed then.
void BodyTable::move_part(BodyIndex index, std::size_t part, const PartPlace& to, const Shape& shape) noexcept {
  Body& body = bodies_[index];
  PartRecord& now = body.parts[part];
  const double rounding = 4 * kRigidTolerance * (now.local.scale + to.local.scale);
  const double way = length(to.center - now.center) + (pose_change(now.local, to.local) + rounding) * shape.reach;
  add_turn(index, way * body.state.pose.scale);
  static_cast<PartPlace&>(now) = to;
  if (part == 0) parts_changed(index);
  if (body.one) return moved(index, body.state.pose);  // several ones have the body's origin as their middle
  body.parts_moved = true;
  if (body.is_static || body.frozen) place_parts(body);
}

void BodyTable::leave(BodyIndex body) noexcept { bodies_[body].id = kNoBody; }

namespace {

void mark_asked(Body& body, Step step) noexcept {
  body.known_before = body.asked;
  body.asked = step;
}

}  // namespace

void BodyTable::ask(Step step, double time, std::span<const BodyIndex> bodies, const Executor& executor) {
  asking_.clear();
  constexpr std::size_t kAhead = 8;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (i + kAhead < bodies.size()) {
      const Body& ahead = bodies_[bodies[i + kAhead]];
      prefetch(&ahead.is_static), prefetch(&ahead.asked);
    }
    const BodyIndex index = bodies[i];
    Body& body = bodies_[index];
    if (body.asked == step || body.is_static || body.frozen) continue;
    mark_asked(body, step);
    asking_.push_back(index);
  }
  ask_source(step, time, executor);
}

// No body comes up twice, so that each is marked where its answer is used.
void BodyTable::ask_everyone(Step step, double time, const Executor& executor) {
  asking_.clear();
  for (BodyIndex i = 0; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    if (body.id != kNoBody && !body.is_static && !body.frozen) asking_.push_back(i);
  }
  ask_source(step, time, executor);
}

// For asking_.
void BodyTable::ask_source(Step step, double time, const Executor& executor) {
  if (asking_.empty()) return;
  // A thread that is alone takes answers while they are in its cache.
  constexpr std::size_t kAlone = 256;
  const std::size_t at_once = executor.run == nullptr ? std::min(asking_.size(), kAlone) : asking_.size();
  if (answers_.size() < at_once) grow(answers_, at_once);
  for (std::size_t done = 0; done < asking_.size(); done += at_once) {
    const auto some = std::span(std::as_const(asking_)).subspan(done, std::min(at_once, asking_.size() - done));
    source_(time, some, std::span(answers_).first(some.size()));
    take_answers(step, some, executor);
  }
}

void BodyTable::take_answers(Step step, std::span<const BodyIndex> bodies, const Executor& executor) {
  constexpr std::size_t kPerJob = 256, kAhead = 8;
  auto take_some = [&](std::size_t job) {
    const std::size_t end = std::min(bodies.size(), (job + 1) * kPerJob);
    for (std::size_t i = job * kPerJob; i < end; ++i) {
      if (i + kAhead < end) {
        const BodyIndex ahead = bodies[i + kAhead];
        prefetch_all(bodies_[ahead]), prefetch_sphere_cache(ahead);
      }
      take_answer(step, bodies[i], answers_[i]);
    }
  };
  run_jobs(executor, (bodies.size() + kPerJob - 1) / kPerJob, take_some);
}

void BodyTable::take_answer(Step step, BodyIndex index, const BodyState& answer) noexcept {
  Body& body = bodies_[index];
  BodyState& state = bodies_[index].state;
  if (body.asked != step) mark_asked(body, step);
  const Pose before = state.pose;
  if (keeps_before_) body.before = before;
  const bool valid = is_valid(answer);
  const bool same = body.moved >= 0 && before == answer.pose && body.valid == valid;
  if (!same) body.moved = step;
  state = answer;
  body.valid = valid;
  if (!valid) any_flawed_.store(true, std::memory_order_relaxed);
  if (!same) {
    moved(index, before);
  } else if (body.parts_moved) {
    place_parts(body);
  }
  if (!body.asleep) return;
  body.frozen = true;
  state.velocity = state.half_space = {};
  state.acceleration = state.drift = state.angular_speed = 0;
  state.expiry = std::numeric_limits<double>::infinity();
}

// The middle goes as the origin does, but for what it turns about that.
Motion BodyTable::motion_of(BodyIndex index, double time_step, bool by_middle) const noexcept {
  const Body& body = bodies_[index];
  const BodyState& state = bodies_[index].state;
  Motion motion;
  motion.position = state.pose.translation;
  motion.velocity = state.velocity;
  motion.radius = body.reach * state.pose.scale + body.continuous_speed * time_step;
  motion.acceleration = state.acceleration;
  motion.drift = state.drift;
  motion.half_space = state.half_space;
  motion.expiry = state.expiry;
  if (by_middle) {
    motion.position = transform(state.pose, body.middle);
    motion.radius = body.middle_reach * state.pose.scale;
    // And what the middle's place may be off by from step to step, which is much where it is near the world's origin.
    constexpr double kRounding = 1e-11;  // of the way from the body's origin
    motion.drift += (state.angular_speed + kRounding / time_step) * body.off_middle * state.pose.scale;
  }
  if (!body.valid) motion.radius = -1;  // refused
  return motion;
}

bool BodyTable::surely_apart(const BodyPair& pair, double time_step) const noexcept {
  const Motion a = motion_of(pair.a, time_step), b = motion_of(pair.b, time_step);
  const Vec3 way = b.position - a.position;
  const double reach = a.radius + b.radius, square = dot(way, way);
  return a.radius >= 0 && b.radius >= 0 && std::isfinite(square) && square > reach * reach;
}

std::size_t BodyTable::memory_bytes() const noexcept {
  std::size_t bytes = bytes_of(bodies_, asking_, answers_, sphere_caches_, float_spheres_, invalidated_);
  for (const Body& body : bodies_)
    bytes += bytes_of(body.parts, body.parts_before, body.part_spheres, body.float_part_spheres);
  return bytes;
}

}  // namespace detail
}  // namespace orchard::runtime
