#include "scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace orchard::runtime::test {
namespace {

constexpr double kGravity = 9.81;
constexpr std::size_t kClusters = 8;
constexpr Vec3 kUp{0, 0, 1};

double root_of(std::size_t bodies) { return std::sqrt(static_cast<double>(bodies)); }

}  // namespace

std::vector<SceneSpec> table_scenes(std::size_t max_bodies) {
  using Kind = SceneKind;
  std::vector<SceneSpec> scenes = {
      {"slab", Kind::slab, 10000},
      {"corridor", Kind::corridor, 10000},
      {"corridor", Kind::corridor, 40000},
      {"explosion from a point", Kind::explosion, 10000},
      {"gravity and bouncing floor", Kind::bouncing, 10000},
      {"pile, asleep", Kind::pile_asleep, 8000},
      {"pile, jitter within M", Kind::pile_jitter, 8000},
      {"pile, all cancelled at each step", Kind::pile_cancelled, 8000},
      {"1 % teleporting at each step", Kind::teleporting, 10000, 0.01},
      {"10 % teleporting at each step", Kind::teleporting, 10000, 0.1},
      {"1 % added and removed at each step", Kind::replaced, 10000, 0.01},
      {"10 % added and removed at each step", Kind::replaced, 10000, 0.1},
      {"coincident bodies", Kind::coincident, 3000, 0, 20},
      {"uniform", Kind::uniform, 100},
      {"uniform", Kind::uniform, 1000},
      {"uniform", Kind::uniform, 10000},
      {"uniform", Kind::uniform, 100000},
      {"uniform", Kind::uniform, 1000000, 0, 120},
      {"uniform, bounds staggered", Kind::staggered, 10000},
      {"clusters, 80 % in 1 %", Kind::clusters, 10000},
      {"Pareto radii", Kind::pareto, 10000},
      {"stream", Kind::stream, 10000},
      {"orbit", Kind::orbit, 10000},
  };
  std::erase_if(scenes, [&](const SceneSpec& scene) { return scene.bodies > max_bodies; });
  return scenes;
}

TableScene::TableScene(const SceneSpec& spec, std::uint64_t seed) : spec_(spec), draw_(seed) {
  const bool dense = spec.kind == SceneKind::teleporting || spec.kind == SceneKind::replaced;
  const double n = static_cast<double>(spec.bodies);
  ball_ = spec.kind == SceneKind::explosion ? 1.6 * std::cbrt(n) : 200 * std::cbrt(n / (dense ? 1000 : 100));
  for (std::size_t k = 0; k < kClusters; ++k) clusters_.push_back(draw_.in_ball(ball_));
  positions_.resize(spec.bodies);
  radii_.resize(spec.bodies);
  drives_.resize(spec.bodies);
  for (std::size_t i = 0; i < spec.bodies; ++i) {
    place(i);
    if (redraws()) redraw(i);
    if (spec.kind == SceneKind::staggered) drives_[i].expiry = static_cast<double>(1 + i % 100) * kStep;
  }
}

bool TableScene::redraws() const { return swings_.empty() && spec_.kind != SceneKind::bouncing; }

// A body that is new at its index, or was sent somewhere else.
void TableScene::place(std::size_t i) {
  Drive& drive = drives_[i];
  drive = {};
  radii_[i] = draw_.uniform(0.5, 1.5);
  drive.velocity = draw_.uniform(5, 15) * draw_.direction();
  const double floor = 20 * root_of(spec_.bodies), n = static_cast<double>(spec_.bodies);
  switch (spec_.kind) {
    case SceneKind::slab:
      positions_[i] = {draw_.uniform(0, floor), draw_.uniform(0, floor), draw_.uniform(0, 4)};
      drive.velocity[2] = 0;
      return;
    case SceneKind::corridor:
      positions_[i] = {draw_.uniform(0, 20 * n), draw_.uniform(0, 8), draw_.uniform(0, 8)};
      drive.velocity = {drive.velocity[0], 0, 0};
      return;
    case SceneKind::explosion:
      positions_[i] = draw_.in_ball(ball_);
      drive.velocity = (50 / ball_) * positions_[i];
      return;
    case SceneKind::bouncing:
      positions_[i] = {draw_.uniform(0, floor / 5), draw_.uniform(0, floor / 5), draw_.uniform(2, 20)};
      drive = {{drive.velocity[0] / 5, drive.velocity[1] / 5, 0}, {0, 0, -kGravity}, kGravity, drive.expiry, kUp};
      return;
    case SceneKind::pile_asleep:
    case SceneKind::pile_jitter:
    case SceneKind::pile_cancelled:
    case SceneKind::coincident:
      return place_in_pile(i);
    case SceneKind::clusters:
      positions_[i] = i % 5 == 0 ? draw_.in_ball(ball_) : in_cluster();
      return;
    case SceneKind::pareto:
      radii_[i] = std::min(50.0, 0.5 * std::pow(draw_.uniform(1e-9, 1), -1 / 1.5));
      positions_[i] = draw_.in_ball(ball_);
      return;
    case SceneKind::stream:
      positions_[i] = std::cbrt(250 * n) * Vec3{draw_.uniform(0, 4), draw_.uniform(0, 1), draw_.uniform(0, 1)};
      drive.velocity = 0.5 * drive.velocity + Vec3{100, 0, 0};
      return;
    case SceneKind::orbit:
      return place_in_orbit(i);
    default:
      positions_[i] = draw_.in_ball(ball_);
  }
}

Vec3 TableScene::in_cluster() {
  const double radius = ball_ * std::cbrt(0.01 / static_cast<double>(kClusters));
  return clusters_[draw_.bits() % kClusters] + draw_.in_ball(radius);
}

// Neighbours overlap by a hundredth of their radius or two.
void TableScene::place_in_pile(std::size_t i) {
  const auto side = static_cast<std::size_t>(std::lround(std::cbrt(static_cast<double>(spec_.bodies))));
  constexpr double kSpacing = 0.99, kSwing = 0.01, kRate = 10;
  const bool one = spec_.kind == SceneKind::coincident, still = one || spec_.kind == SceneKind::pile_asleep;
  const auto along = [&](std::size_t place) { return one ? 0.0 : kSpacing * static_cast<double>(place); };
  radii_[i] = 0.5;
  drives_[i] = {};
  drives_[i].bound = still ? 0 : kSwing * kRate * kRate;
  const Vec3 way = still ? Vec3{} : kSwing * draw_.direction();
  const double phase = draw_.uniform(0, 2 * std::numbers::pi);
  swings_.push_back({{along(i % side), along(i / side % side), along(i / (side * side))}, way, {}, kRate, phase});
  swing(i);
}

void TableScene::place_in_orbit(std::size_t i) {
  const double widest = 10 * root_of(spec_.bodies), r = widest * std::sqrt(draw_.uniform(0.1, 1));
  const double speed = 20 * std::sqrt(widest / r);
  drives_[i].bound = speed * speed / r;
  const Vec3 home{0, 0, draw_.uniform(-5, 5)};
  swings_.push_back({home, {r, 0, 0}, {0, r, 0}, speed / r, draw_.uniform(0, 2 * std::numbers::pi)});
  swing(i);
}

void TableScene::redraw(std::size_t i) {
  Drive& drive = drives_[i];
  drive.bound = draw_.uniform(0, 4);
  drive.acceleration = draw_.uniform(0, drive.bound) * draw_.direction();
  if (spec_.kind == SceneKind::slab) drive.acceleration[2] = 0;
  if (spec_.kind == SceneKind::corridor) drive.acceleration[1] = drive.acceleration[2] = 0;
  drive.expiry = time() + 1;
}

void TableScene::swing(std::size_t i) {
  const Swing& s = swings_[i];
  const double angle = s.phase + s.rate * time(), c = std::cos(angle), d = std::sin(angle);
  positions_[i] = s.home + c * s.x + d * s.y;
  drives_[i].velocity = s.rate * (c * s.y - d * s.x);
}

void TableScene::move(std::size_t i) {
  if (!swings_.empty()) return swing(i);
  Drive& drive = drives_[i];
  positions_[i] = positions_[i] + kStep * drive.velocity + (kStep * kStep / 2) * drive.acceleration;
  drive.velocity = drive.velocity + kStep * drive.acceleration;
  if (spec_.kind == SceneKind::bouncing) fall(i);
}

// What has reached the floor goes up again, or rolls on.
void TableScene::fall(std::size_t i) {
  constexpr double kKept = 0.7, kRolling = 0.5;  // of the speed; slower than that it does not rise any more
  Drive& drive = drives_[i];
  if (positions_[i][2] > radii_[i] || drive.velocity[2] >= 0) return;
  positions_[i][2] = radii_[i];
  drive.velocity[2] *= -kKept;
  if (drive.velocity[2] < kRolling) {
    drive.velocity[2] = 0;
    drive.acceleration = drive.half_space = {};
    drive.bound = 0;
  }
  broken_.push_back(static_cast<BodyIndex>(i));
}

void TableScene::change_some() {
  const auto count = static_cast<std::size_t>(std::lround(spec_.share * static_cast<double>(size())));
  std::vector<BodyIndex>& changed = spec_.kind == SceneKind::replaced ? replaced_ : broken_;
  for (std::size_t k = 0; k < count; ++k) changed.push_back(static_cast<BodyIndex>(draw_.bits() % size()));
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  for (const BodyIndex body : changed) {
    if (spec_.kind == SceneKind::teleporting) {
      positions_[body] = draw_.in_ball(ball_);
    } else {
      place(body);
      redraw(body);
    }
  }
}

void TableScene::next_step() {
  ++step_;
  broken_.clear();
  replaced_.clear();
  for (std::size_t i = 0; i < size(); ++i) move(i);
  if (redraws()) {
    for (std::size_t i = 0; i < size(); ++i) {
      if (drives_[i].expiry < time() + kStep / 2) redraw(i);
    }
  }
  if (spec_.share > 0) change_some();
  if (spec_.kind != SceneKind::pile_cancelled) return;
  for (std::size_t i = 0; i < size(); ++i) broken_.push_back(static_cast<BodyIndex>(i));
}

Motion TableScene::motion(BodyIndex i) const {
  const Drive& drive = drives_[i];
  return {positions_[i], drive.velocity, radii_[i], drive.bound, 0, drive.half_space, drive.expiry};
}

MotionSource TableScene::source() const {
  return [this](double, std::span<const BodyIndex> bodies, std::span<Motion> motions) {
    for (std::size_t k = 0; k < bodies.size(); ++k) motions[k] = motion(bodies[k]);
  };
}

SceneWorld::SceneWorld(const TableScene& scene, BroadPhase world) : world_(std::move(world)) {
  for (std::size_t i = 0; i < scene.size(); ++i) ids_.push_back(world_.add());
}

Advance SceneWorld::step(const TableScene& scene) {
  for (const BodyIndex body : scene.broken()) world_.cancel(ids_[body]);
  for (const BodyIndex body : scene.replaced()) world_.remove(ids_[body]);
  for (std::size_t k = 0; k < scene.replaced().size(); ++k) {  // the indices that are free are those just given back
    const BodyId id = world_.add();
    ids_[id.index] = id;
  }
  return world_.advance(scene.time());
}

}  // namespace orchard::runtime::test
