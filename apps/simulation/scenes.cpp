// One function for each scene, beside each other so that they read alike: hence more than 300 lines.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "orchard/runtime/motion_helpers.h"
#include "scene.h"

namespace orchard::simulation {
namespace {

// Scenes are in units of the first shape's radius, so that any tree will do.
struct Stage {
  World& world;
  double unit;
  std::size_t bodies;
};

double drift(const World& world, double acceleration) {
  return runtime::drift_of(runtime::Integrator::semi_implicit_euler, world.scene.step, acceleration);
}

// ---------------------------------------------------------------- flight (7.2): one steered ship and drones

constexpr double kThrust = 2, kTurning = 0.8, kSpeedLimit = 4;  // in units and seconds

void steer(Body& ship, double unit) {
  const Vec3 nose = turned(ship.attitude, {1, 0, 0}), up = turned(ship.attitude, {0, 1, 0}),
             side = turned(ship.attitude, {0, 0, 1});
  ship.spin = (kTurning * ship.rudder[0]) * up + (kTurning * ship.rudder[1]) * side;
  // Thrust that would only add to the speed limit is cut off.
  const double thrust = dot(ship.velocity, nose) < kSpeedLimit * unit ? kThrust * unit * ship.throttle : 0;
  ship.force = ship.force + (ship.mass * thrust) * nose;
  const double slowing = length(ship.velocity) > kSpeedLimit * unit ? 0.5 : 0;
  ship.force = ship.force - (ship.mass * slowing) * ship.velocity;
}

void fly(World& world, double time, double unit, double room) {
  for (std::uint32_t i = 0; i < world.bodies.size(); ++i) {
    Body& ship = world.bodies[i];
    if (i == 0) {
      ship.throttle = world.steering.throttle;
      ship.rudder = {world.steering.yaw, world.steering.pitch};
    } else if (time >= ship.next_control) {
      ship.throttle = world.draw.uniform(0, 1);
      ship.rudder = {world.draw.uniform(-1, 1), world.draw.uniform(-1, 1)};
      ship.next_control = time + world.draw.uniform(1, 3);
    }
    steer(ship, unit);
    // Kept in a small neighbourhood, so that they meet (7.2): a soft pull back.
    const double away = length(ship.position) - room;
    if (away > 0)
      ship.force = ship.force - (ship.mass * std::min(away, kThrust * unit) / length(ship.position)) * ship.position;
  }
}

// On a sphere, as far from the homes so far as asked for, or as a thousand tries allow.
Vec3 free_place(World& world, double radius, double apart) {
  Vec3 best;
  double farthest = -1;
  for (int attempt = 0; attempt < 1000 && farthest < apart; ++attempt) {
    const Vec3 place = radius * world.draw.direction();
    double nearest = radius;
    for (const Body& body : world.bodies) nearest = std::min(nearest, length(body.home - place));
    if (nearest > farthest) {
      farthest = nearest;
      best = place;
    }
  }
  return best;
}

void fill_flight(const Stage& stage) {
  World& world = stage.world;
  const double unit = stage.unit, room = 3.5 * unit;
  for (std::size_t i = 0; i <= stage.bodies; ++i) {
    Body ship;
    ship.home = i == 0 ? Vec3{} : free_place(world, 4 * unit, 2.2 * unit);
    ship.position = ship.home;
    ship.attitude = world.draw.attitude();
    // Thrust, the pull back, and what slows down at the limit, which no jump exceeds.
    ship.acceleration = 2 * kThrust * unit + 0.5 * 2 * kSpeedLimit * unit;
    ship.drift = drift(world, ship.acceleration);
    world.add(ship);
  }
  world.scene.before = [unit, room](World& w, double time) { fly(w, time, unit, room); };
}

// ---------------------------------------------------------------- what falls, bounces, and drifts

Body thrown(World& world, const Vec3& position, const Vec3& velocity) {
  Body body;
  body.position = position;
  body.velocity = velocity;
  body.attitude = world.draw.attitude();
  body.spin = 0.5 * world.draw.direction();
  return body;
}

void box_of_walls(World& world, double half, bool lid) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      if (axis == 1 && sign < 0 && !lid) continue;
      Vec3 normal;
      normal[axis] = sign;
      world.scene.walls.push_back({normal, -half});
    }
  }
}

void fall_freely(World& world) {
  const double g = length(world.scene.gravity);
  for (Body& body : world.bodies) {
    body.acceleration = g;
    body.drift = drift(world, g);
  }
}

void fill_pile(const Stage& stage) {
  World& world = stage.world;
  const double unit = stage.unit, half = 3 * unit;
  box_of_walls(world, half, false);
  for (std::size_t i = 0; i < stage.bodies; ++i) {
    const double x = world.draw.uniform(-1.5, 1.5) * unit, z = world.draw.uniform(-1.5, 1.5) * unit;
    world.add(thrown(world, {x, -half + unit * (1.2 + 1.1 * static_cast<double>(i)), z}, {}));
  }
  fall_freely(world);
}

void fill_box(const Stage& stage) {
  World& world = stage.world;
  const double unit = stage.unit, half = 1.6 * unit * std::cbrt(static_cast<double>(stage.bodies)) + unit;
  box_of_walls(world, half, true);
  for (std::size_t i = 0; i < stage.bodies; ++i)
    world.add(thrown(
        world, (half - unit) * Vec3{world.draw.uniform(-1, 1), world.draw.uniform(-1, 1), world.draw.uniform(-1, 1)},
        3 * unit * world.draw.direction()));
  fall_freely(world);
}

// Density as in 4.2.5's tests, 100 bodies of radius 1 in a ball of radius 200, is too thin to see: 30 times that.
void fill_asteroids(const Stage& stage) {
  World& world = stage.world;
  const double unit = stage.unit, room = 14 * unit * std::cbrt(static_cast<double>(stage.bodies));
  for (std::size_t i = 0; i < stage.bodies; ++i)
    world.add(thrown(world, world.draw.in_ball(room), world.draw.uniform(1, 4) * unit * world.draw.direction()));
  fall_freely(world);
}

// Sizes with a heavy tail, in clumps: most bodies are small, a few are forty times as large.
void fill_clusters(const Stage& stage) {
  World& world = stage.world;
  const double unit = stage.unit, room = 12 * unit * std::cbrt(static_cast<double>(stage.bodies));
  Vec3 middle;
  for (std::size_t i = 0; i < stage.bodies; ++i) {
    if (i % 20 == 0) middle = world.draw.in_ball(room);
    Body body = thrown(world, middle + world.draw.in_ball(12 * unit),
                       world.draw.uniform(0.2, 2) * unit * world.draw.direction());
    body.scale = std::min(4.0, 0.1 / world.draw.uniform(0.02, 1));
    body.mass = body.scale * body.scale * body.scale;
    world.add(body);
  }
  fall_freely(world);
}

// ---------------------------------------------------------------- scripted motion

// Angles that swing: amplitude, frequency, phase. |q'| <= amplitude * frequency, and so on.
struct Swing {
  double amplitude, frequency, phase;
  double at(double t) const { return amplitude * std::sin(frequency * t + phase); }
  double rate() const { return amplitude * frequency; }
  double acceleration() const { return amplitude * frequency * frequency; }
};
constexpr Swing kJoints[] = {{2.5, 0.4, 0}, {0.9, 0.7, 1}, {1.2, 0.9, 2}, {1.0, 1.3, 3}};

// Each link hangs on the one before; velocities by the angles' own rates.
void move_arm(World& world, double time, double unit) {
  Quaternion attitude{1, 0, 0, 0};
  Vec3 place{0, 0, 0};
  for (std::uint32_t link = 0; link < std::size(kJoints); ++link) {
    Body& body = world.bodies[link];
    const Vec3 axis = link == 0 ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
    attitude = normalized(product(attitude, about(axis, kJoints[link].at(time))));
    const Vec3 way = turned(attitude, {0.8 * unit, 0, 0});
    const Vec3 position = place + way;
    body.velocity = (1 / world.scene.step) * (position - body.position);
    body.position = position;
    body.attitude = attitude;
    place = place + 2.0 * way;
  }
}

void fill_robot(const Stage& stage) {
  World& world = stage.world;
  const double unit = stage.unit;
  for (std::uint32_t link = 0; link < std::size(kJoints); ++link) {
    Body body;
    body.scripted = true;
    body.scale = 0.7;
    world.add(body);
  }
  for (const double time : {-world.scene.step, 0.0}) move_arm(world, time, unit);
  for (std::uint32_t link = 0; link < std::size(kJoints); ++link) {
    // A point at most `reach` from the base: its acceleration is at most reach (sum of q'' + 2 (sum of q')^2).
    double rate = 0, acceleration = 0;
    for (std::uint32_t i = 0; i <= link; ++i) rate += kJoints[i].rate(), acceleration += kJoints[i].acceleration();
    const double reach = 1.6 * unit * (link + 1);
    Body& body = world.bodies[link];
    body.acceleration = reach * (acceleration + 2 * rate * rate);
    body.drift = body.acceleration * world.scene.step;  // its velocity is a difference of positions
  }
  for (std::size_t i = 0; i < stage.bodies; ++i) {
    Body obstacle;
    obstacle.fixed = true;
    obstacle.scale = 0.6;
    obstacle.position = (3 + world.draw.uniform(0, 3)) * unit * world.draw.direction();
    obstacle.attitude = world.draw.attitude();
    world.add(obstacle);
  }
  world.scene.before = [unit](World& w, double time) { move_arm(w, time, unit); };
}

// Things on a belt, in three layers; a tenth of them is taken off at the end and put on at the beginning each second.
void put_on_belt(World& world, double unit, double x) {
  Body body;
  body.scripted = true;
  body.scale = world.draw.uniform(0.3, 0.6);
  body.position = {x, world.draw.uniform(0, 0.8) * unit, world.draw.uniform(-1, 1) * unit};
  body.velocity = {unit * world.draw.uniform(0.8, 1.2), 0, 0};
  body.attitude = world.draw.attitude();
  world.add(body);
}

void fill_conveyor(const Stage& stage) {
  World& world = stage.world;
  const double unit = stage.unit, belt = 0.5 * unit * static_cast<double>(stage.bodies);
  for (std::size_t i = 0; i < stage.bodies; ++i) put_on_belt(world, unit, world.draw.uniform(0, belt));
  world.scene.before = [unit, belt](World& w, double) {
    const std::size_t count = w.bodies.size();
    for (std::uint32_t i = 0; i < count; ++i) {
      Body& body = w.bodies[i];
      if (!body.there) continue;
      body.position = body.position + w.scene.step * body.velocity;
      if (body.position[0] < belt) continue;
      w.remove(i);
      put_on_belt(w, unit, 0);
    }
  };
}

struct Entry {
  std::size_t bodies;
  Response response;
  double frame, step, gravity;  // gravity in units
  void (*fill)(const Stage&);
};
const std::map<std::string, Entry>& scenes() {
  static const std::map<std::string, Entry> all{{"flight", {10, Response::jump_home, 0.1, 0.05, 0, fill_flight}},
                                                {"pile", {24, Response::push, 0.02, 0.01, 9, fill_pile}},
                                                {"asteroids", {1000, Response::push, 0.02, 0.01, 0, fill_asteroids}},
                                                {"robot", {12, Response::none, 0.02, 0.02, 0, fill_robot}},
                                                {"box", {30, Response::push, 0.02, 0.01, 3, fill_box}},
                                                {"conveyor", {60, Response::none, 0.02, 0.02, 0, fill_conveyor}},
                                                {"clusters", {200, Response::push, 0.02, 0.01, 0, fill_clusters}}};
  return all;
}

}  // namespace

std::uint64_t Draw::bits() {
  std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

double Draw::uniform(double low, double high) {
  return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
}

Vec3 Draw::in_ball(double radius) {
  while (true) {
    Vec3 v;
    for (double& x : v) x = uniform(-1, 1);
    if (dot(v, v) <= 1) return radius * v;
  }
}

Vec3 Draw::direction() {
  while (true) {
    const Vec3 v = in_ball(1);
    if (dot(v, v) > 1e-4) return unit(v);
  }
}

Quaternion Draw::attitude() {
  while (true) {
    Quaternion q{};
    double square = 0;
    for (double& x : q) {
      x = uniform(-1, 1);
      square += x * x;
    }
    if (square > 1e-4 && square <= 1) return normalized(q);
  }
}

bool is_scene(const std::string& name) { return scenes().contains(name); }

std::unique_ptr<World> make_world(const std::string& name, const std::vector<Shape>& shapes, std::size_t bodies,
                                  std::uint64_t seed) {
  const Entry& entry = scenes().at(name);
  const double size = shapes.front().radius;
  Scene scene;
  scene.name = name;
  scene.response = entry.response;
  scene.frame = entry.frame;
  scene.step = entry.step;
  scene.gravity = {0, -entry.gravity * size, 0};
  scene.max_acceleration = 400 * size;
  auto world = std::make_unique<World>(std::move(scene), shapes, seed);
  entry.fill({*world, size, bodies > 0 ? bodies : entry.bodies});
  return world;
}

}  // namespace orchard::simulation
