// The scenes beside each other, so that they read alike: hence more than 300 lines.
#include "scenes.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace orchard::runtime::test {
namespace {

// By which angle the one is turned from the other, at least.
double turned(const std::array<double, 9>& from, const std::array<double, 9>& to) {
  double square = 0;
  for (std::size_t i = 0; i < 9; ++i) square += (to[i] - from[i]) * (to[i] - from[i]);
  const double chord = std::sqrt(square / 2) * (1 + 1e-9) + 1e-12;  // what a unit vector moves at most
  return chord >= 2 ? std::acos(-1.0) : 2 * std::asin(chord / 2);
}

// A ball that stands for a body, and turns at a constant rate.
struct Ball {
  Vec3 place{}, velocity{}, axis{0, 0, 1};
  double spin = 0, angle = 0, radius = 1, scale = 1;
  std::array<double, 4> attitude = {1, 0, 0, 0};  // before it turned by `angle`
  bool fixed = false;

  Pose pose() const {
    Pose result = *pose_from_quaternion(quaternion(), place);
    result.scale = scale;
    return result;
  }
  void turn(const Vec3& about, double fast) {  // from now on
    attitude = quaternion();
    axis = about, spin = fast, angle = 0;
  }

 private:
  std::array<double, 4> quaternion() const {
    const double half = angle / 2, s = std::sin(half), w = std::cos(half);
    const Vec3 v = s * axis, u = {attitude[1], attitude[2], attitude[3]};
    const Vec3 across = {v[1] * u[2] - v[2] * u[1], v[2] * u[0] - v[0] * u[2], v[0] * u[1] - v[1] * u[0]};
    const Vec3 product = w * u + attitude[0] * v + across;
    return {w * attitude[0] - dot(v, u), product[0], product[1], product[2]};
  }
};

// Springs between balls that overlap, and between balls and planes; semi-implicit Euler.
class PenaltySolver {
 public:
  std::vector<Ball> balls;
  std::vector<ScenePlane> planes;
  Vec3 gravity{};
  double stiffness = 400, damping = 2;

  void advance(double dt) {
    forces_.assign(balls.size(), gravity);
    for_near_pairs([this](std::size_t i, std::size_t j) { push(i, j); });
    for (std::size_t i = 0; i < balls.size(); ++i) {
      Ball& ball = balls[i];
      for (const ScenePlane& plane : planes) {
        const double depth = plane.offset + ball.radius - dot(plane.normal, ball.place);
        if (depth <= 0) continue;
        const double towards = dot(plane.normal, ball.velocity);
        forces_[i] = forces_[i] + (stiffness * depth - damping * towards) * plane.normal;
      }
      if (!ball.fixed) {
        ball.velocity = ball.velocity + dt * forces_[i];
        ball.place = ball.place + dt * ball.velocity;
      }
      ball.angle += dt * ball.spin;
    }
  }

 private:
  void push(std::size_t i, std::size_t j) {
    const Vec3 way = balls[j].place - balls[i].place;
    const double distance = length(way), depth = balls[i].radius + balls[j].radius - distance;
    if (depth <= 0 || distance <= 0) return;
    const Vec3 normal = (1 / distance) * way;
    const double apart = dot(balls[j].velocity - balls[i].velocity, normal);
    const Vec3 force = (stiffness * depth - damping * apart) * normal;
    forces_[i] = forces_[i] - force;
    forces_[j] = forces_[j] + force;
  }

  template <typename Visit>
  void for_near_pairs(Visit&& visit) {
    double cell = 0;
    for (const Ball& ball : balls) cell = std::max(cell, 2 * ball.radius);
    std::unordered_map<std::int64_t, std::vector<std::uint32_t>> grid;
    const auto key = [](std::int64_t x, std::int64_t y, std::int64_t z) { return (x * 1'000'003 + y) * 1'000'003 + z; };
    const auto at = [cell](double x) { return static_cast<std::int64_t>(std::floor(x / cell)); };
    for (std::uint32_t j = 0; j < balls.size(); ++j) {
      const Vec3& p = balls[j].place;
      for (int dx = -1; dx <= 1; ++dx) {
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dz = -1; dz <= 1; ++dz) {
            const auto found = grid.find(key(at(p[0]) + dx, at(p[1]) + dy, at(p[2]) + dz));
            if (found == grid.end()) continue;
            for (const std::uint32_t i : found->second) visit(i, j);
          }
        }
      }
      grid[key(at(p[0]), at(p[1]), at(p[2]))].push_back(j);
    }
  }

  std::vector<Vec3> forces_;
};

SceneShape tree_shape(const Mesh& mesh) {
  SceneShape shape;
  shape.tree = build_tree(mesh, {.bounds = mesh.triangles.size() < 200});
  return shape;
}

SceneShape round_shape(const Vec3& p, const Vec3& q, double radius) {
  SceneShape shape;
  shape.kind = SceneShape::Kind::round;
  shape.p = p, shape.q = q, shape.radius = radius;
  return shape;
}

SceneShape box_shape(const Vec3& half) {
  SceneShape shape;
  shape.kind = SceneShape::Kind::box;
  shape.p = half;
  shape.tree = build_tree(box({-half[0], -half[1], -half[2]}, half), {.bounds = false});
  return shape;
}

// Of radius 1, all of them.
std::vector<SceneShape> mixed_shapes() {
  std::vector<SceneShape> shapes;
  shapes.push_back(tree_shape(torus(12, 6, 0.75, 0.25)));
  shapes.push_back(tree_shape(scaled(spikes(5, 9, 7), 0.7)));
  shapes.push_back(box_shape({0.6, 0.5, 0.4}));
  shapes.push_back(round_shape({-0.6, 0, 0}, {0.6, 0, 0}, 0.4));
  shapes.push_back(round_shape({}, {}, 0.8));
  return shapes;
}

void record(Scene& scene, PenaltySolver& solver) {
  for (int step = 0; step < scene.steps; ++step) {
    auto& poses = scene.poses.emplace_back();
    for (const Ball& ball : solver.balls) poses.push_back(ball.pose());
    solver.advance(scene.dt);
  }
  scene.planes = solver.planes;
}

// A cube around the origin, whose sides are that far from it.
void add_walls(PenaltySolver& solver, double wall) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Vec3 normal{};
    normal[axis] = 1;
    solver.planes.push_back({normal, -wall});
    solver.planes.push_back({-1.0 * normal, -wall});
  }
}

Ball random_ball(Draw& draw, double around, double speed) {
  Ball ball;
  ball.place = {draw.uniform(-around, around), draw.uniform(-around, around), draw.uniform(-around, around)};
  ball.velocity = draw.uniform(0, speed) * Vec3(draw.direction());
  ball.axis = draw.direction();
  ball.spin = draw.uniform(-3, 3);
  ball.radius = 0.62;  // the bodies' shapes get into each other before their balls do
  return ball;
}

void add_bodies(Scene& scene, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    scene.bodies.push_back({.parts = {i % scene.shapes.size()}});
    scene.bodies.back().options.importance = static_cast<std::uint8_t>(i % 3);
  }
}

}  // namespace

// Forward differences: then the position n steps later is off by at most M (n dt)^2 / 2, with M the largest second
// difference over dt^2 on the way.
BodyState Scene::state(int step, std::size_t body, int horizon) const {
  BodyState state = bounded(step, 1, steps - 1, body, horizon);
  if (!bodies[body].is_static) state.expiry = std::min(steps - 1, step + horizon) * dt;
  return state;
}

BodyState Scene::state_backwards(int step, double time, std::size_t body, int horizon) const {
  BodyState state = bounded(step, -1, 0, body, horizon);
  if (!bodies[body].is_static) state.expiry = time + std::min(step, horizon) * dt;
  return state;
}

// Steps go by `way` up to `end`.
BodyState Scene::bounded(int step, int way, int end, std::size_t body, int horizon) const {
  const auto rotation = [&](int k) { return poses[static_cast<std::size_t>(k)][body].rotation; };
  const auto place = [&](int k) { return Vec3(poses[static_cast<std::size_t>(k)][body].translation); };
  BodyState state;
  state.pose = poses[static_cast<std::size_t>(step)][body];
  if (bodies[body].is_static) return state;
  const int from = step == end ? end - way : step;  // the last velocity is the one before
  state.velocity = (1 / dt) * (place(from + way) - place(from));
  const int known = std::min(horizon, std::abs(end - step) - 1);  // the last one is for the velocity then
  for (int k = 1; k <= known; ++k) {
    const int at = step + k * way;
    const Vec3 change = place(at + 1) - 2.0 * place(at) + place(at - 1);
    state.acceleration = std::max(state.acceleration, length(change) / (dt * dt) * (1 + 1e-9) + 1e-9);
  }
  // An angle that is larger than its chord, and the sum of such ones at least the whole way.
  state.angular_speed = 0;
  for (int k = 0; k < std::min(horizon, std::abs(end - step)); ++k) {
    const int at = step + k * way;
    state.angular_speed = std::max(state.angular_speed, turned(rotation(at), rotation(at + way)) / dt);
  }
  return state;
}

// 7.2: ships with a throttle and a rudder, in a small neighbourhood.
Scene flight(std::size_t bodies, int steps, std::uint64_t seed) {
  Scene scene;
  scene.name = "flight", scene.steps = steps;
  Draw draw(seed);
  scene.shapes.push_back(tree_shape(l_shape()));
  scene.shapes.push_back(tree_shape(scaled(spikes(3, 9, 7), 0.8)));
  add_bodies(scene, bodies);
  PenaltySolver solver;
  const double around = 1.3 * std::cbrt(static_cast<double>(bodies));
  for (std::size_t i = 0; i < bodies; ++i) solver.balls.push_back(random_ball(draw, around, 2));
  for (int step = 0; step < steps; ++step) {
    auto& poses = scene.poses.emplace_back();
    for (Ball& ball : solver.balls) {
      poses.push_back(ball.pose());
      if (step % 40 == 0) {
        const Vec3 axis = draw.direction();
        ball.turn(axis, draw.uniform(-4, 4));
      }
      const Vec3 forward = rotate(ball.pose(), {1, 0, 0});
      ball.velocity = ball.velocity + (0.05 * forward) - (0.002 * ball.place);
    }
    solver.advance(scene.dt);
  }
  return scene;
}

Scene falling_pile(std::size_t bodies, int steps, std::uint64_t seed) {
  Scene scene;
  scene.name = "falling pile", scene.steps = steps;
  Draw draw(seed);
  scene.shapes = mixed_shapes();
  add_bodies(scene, bodies);
  PenaltySolver solver;
  solver.gravity = {0, 0, -9.81};
  const auto side = static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(bodies))));
  const double wall = 0.8 * static_cast<double>(side);
  solver.planes = {{{0, 0, 1}, 0}, {{1, 0, 0}, -wall}, {{-1, 0, 0}, -wall}, {{0, 1, 0}, -wall}, {{0, -1, 0}, -wall}};
  for (std::size_t i = 0; i < bodies; ++i) {
    Ball ball = random_ball(draw, 0.1, 0.5);
    const auto at = [&](std::size_t k) { return 1.5 * (static_cast<double>(k) - 0.5 * static_cast<double>(side - 1)); };
    const std::size_t layer = i / side / side;
    ball.place = ball.place + Vec3{at(i % side), at(i / side % side), 1 + 1.5 * static_cast<double>(layer)};
    ball.spin *= 0.3;
    solver.balls.push_back(ball);
  }
  record(scene, solver);
  return scene;
}

Scene asteroid_field(std::size_t bodies, int steps, std::uint64_t seed) {
  Scene scene;
  scene.name = "asteroid field", scene.steps = steps;
  Draw draw(seed);
  scene.shapes.push_back(tree_shape(spikes(5, 9, 7)));
  scene.shapes.push_back(tree_shape(torus(12, 6, 0.75, 0.25)));
  add_bodies(scene, bodies);
  PenaltySolver solver;
  const double around = 1.6 * std::cbrt(static_cast<double>(bodies));
  for (std::size_t i = 0; i < bodies; ++i) solver.balls.push_back(random_ball(draw, around, 4));
  record(scene, solver);
  return scene;
}

// A base and links that swing, each on the one before, among static obstacles.
Scene robot_arm(std::size_t obstacles, int steps, std::uint64_t seed) {
  Scene scene;
  scene.name = "robot arm", scene.steps = steps;
  Draw draw(seed);
  scene.shapes = mixed_shapes();
  const std::size_t link = scene.shapes.size();
  scene.shapes.push_back(tree_shape(box({0, -0.2, -0.2}, {1.6, 0.2, 0.2})));
  scene.shapes.push_back(round_shape({0, 0, 0}, {1.4, 0, 0}, 0.2));
  constexpr std::size_t kLinks = 5;
  SceneBody arm;
  for (std::size_t i = 0; i < kLinks; ++i) arm.parts.push_back(link + i % 2);
  scene.bodies.push_back(arm);
  for (std::size_t i = 0; i < obstacles; ++i) {
    scene.bodies.push_back({.parts = {i % link}, .is_static = true});
  }
  std::vector<Pose> places(1);
  for (std::size_t i = 0; i < obstacles; ++i) {
    Pose place = draw.pose(draw.uniform(2, 6));
    place.scale = draw.uniform(0.3, 1.2);
    places.push_back(place);
  }
  for (int step = 0; step < steps; ++step) {
    const double t = 8 * step * scene.dt;
    scene.poses.push_back(places);
    auto& locals = scene.locals.emplace_back(scene.bodies.size());
    Pose joint;
    for (std::size_t i = 0; i < kLinks; ++i) {
      const double angle = std::sin((1 + 0.3 * static_cast<double>(i)) * t + static_cast<double>(i));
      const Vec3 axis = i % 2 == 0 ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
      const double s = std::sin(angle / 2);
      const Pose turn = *pose_from_quaternion({std::cos(angle / 2), s * axis[0], s * axis[1], s * axis[2]}, {});
      joint = compose(joint, turn);
      joint = made_rigid(joint).value_or(joint);
      locals[0].push_back(joint);
      joint = compose(joint, Pose{.translation = {1.5, 0, 0}});
    }
  }
  scene.planes = {{{0, 0, 1}, -3}};
  return scene;
}

// Bodies of several sizes that bounce in a box, of one to four parts, which all but every third one moves about itself.
Scene machines(std::size_t bodies, int steps, std::uint64_t seed) {
  Scene scene;
  scene.name = "machines", scene.steps = steps;
  Draw draw(seed);
  scene.shapes = mixed_shapes();
  PenaltySolver solver;
  solver.damping = 0;
  const double wall = 1.3 * std::cbrt(static_cast<double>(bodies)) + 1;
  add_walls(solver, wall);
  struct Joint {
    Vec3 place, axis;
    double turn, scale;
  };
  std::vector<std::vector<Joint>> joints(bodies);
  for (std::size_t i = 0; i < bodies; ++i) {
    Ball ball = random_ball(draw, wall - 1, 6);
    ball.scale = draw.uniform(0.4, 1.1);
    solver.balls.push_back(ball);
    SceneBody& body = scene.bodies.emplace_back();
    for (std::size_t k = 0; k < 1 + i % 4; ++k) {
      body.parts.push_back((i + k) % scene.shapes.size());
      joints[i].push_back({draw.uniform(0.2, 1.2) * Vec3(draw.direction()), draw.direction(), draw.uniform(-4, 4),
                           draw.uniform(0.3, 0.8)});
    }
  }
  record(scene, solver);
  for (int step = 0; step < steps; ++step) {
    auto& locals = scene.locals.emplace_back(bodies);
    for (std::size_t i = 0; i < bodies; ++i) {
      for (const Joint& joint : joints[i]) {
        const double half = i % 3 == 0 ? joint.turn : joint.turn * step * scene.dt, s = std::sin(half);
        const Vec3& u = joint.axis;
        Pose local = *pose_from_quaternion({std::cos(half), s * u[0], s * u[1], s * u[2]}, joint.place);
        local.scale = joint.scale;
        locals[i].push_back(local);
      }
    }
  }
  return scene;
}

Scene bouncing_box(std::size_t bodies, int steps, std::uint64_t seed) {
  Scene scene;
  scene.name = "bouncing box", scene.steps = steps;
  Draw draw(seed);
  scene.shapes = mixed_shapes();
  add_bodies(scene, bodies);
  PenaltySolver solver;
  solver.damping = 0;
  const double wall = 1.1 * std::cbrt(static_cast<double>(bodies)) + 1;
  add_walls(solver, wall);
  for (std::size_t i = 0; i < bodies; ++i) solver.balls.push_back(random_ball(draw, wall - 1, 6));
  record(scene, solver);
  return scene;
}

// Bodies that pass by: a tenth of them is replaced at each step.
Scene conveyor(std::size_t bodies, int steps, std::uint64_t seed) {
  Scene scene;
  scene.name = "conveyor", scene.steps = steps;
  Draw draw(seed);
  scene.shapes = mixed_shapes();
  const std::size_t each = std::max<std::size_t>(1, bodies / 10);
  std::vector<Ball> balls;
  for (int step = -10; step < steps; ++step) {
    for (std::size_t i = 0; i < each; ++i) {
      Ball ball = random_ball(draw, 0.6 * std::cbrt(static_cast<double>(bodies)), 1);
      ball.velocity = ball.velocity + Vec3{5, 0, 0};
      ball.place = ball.place + (-step * scene.dt) * ball.velocity;
      if (step + 10 <= 0) continue;
      balls.push_back(ball);
      scene.bodies.push_back(
          {.parts = {balls.size() % scene.shapes.size()}, .birth = std::max(0, step), .death = step + 10});
    }
  }
  for (int step = 0; step < steps; ++step) {
    auto& poses = scene.poses.emplace_back();
    for (const Ball& ball : balls) {
      Ball now = ball;
      now.place = ball.place + (step * scene.dt) * ball.velocity;
      now.angle = step * scene.dt * ball.spin;
      poses.push_back(now.pose());
    }
  }
  return scene;
}

// Sizes with a heavy tail, in a few clumps.
Scene clusters(std::size_t bodies, int steps, std::uint64_t seed) {
  Scene scene;
  scene.name = "clusters", scene.steps = steps;
  Draw draw(seed);
  scene.shapes = mixed_shapes();
  add_bodies(scene, bodies);
  PenaltySolver solver;
  const std::size_t clumps = 3 + bodies / 100;
  std::vector<Vec3> middles;
  for (std::size_t i = 0; i < clumps; ++i) {
    middles.push_back(random_ball(draw, 3 * std::cbrt(static_cast<double>(bodies)), 0).place);
  }
  for (std::size_t i = 0; i < bodies; ++i) {
    Ball ball = random_ball(draw, 0.6 * std::cbrt(static_cast<double>(bodies)), 2);
    ball.place = ball.place + middles[i % clumps];
    ball.scale = std::min(5.0, 0.3 * std::pow(draw.uniform(1e-3, 1), -1 / 1.5));
    ball.radius *= ball.scale;
    solver.balls.push_back(ball);
  }
  record(scene, solver);
  return scene;
}

// Rings linked in each other, one across the next, that sway slowly: close all the time, and seldom touching.
Scene chain(std::size_t bodies, int steps, std::uint64_t seed) {
  Scene scene;
  scene.name = "chain", scene.steps = steps;
  Draw draw(seed);
  scene.shapes.push_back(tree_shape(torus(64, 16, 0.75, 0.12)));
  add_bodies(scene, bodies);
  struct Sway {
    Vec3 axis, way;
    double rate, phase;
  };
  std::vector<Sway> sways;
  for (std::size_t i = 0; i < bodies; ++i) {
    sways.push_back({draw.direction(), draw.direction(), draw.uniform(8, 24), draw.uniform(0, 6)});
  }
  const double c = std::sqrt(0.5);
  for (int step = 0; step < steps; ++step) {
    auto& poses = scene.poses.emplace_back();
    for (std::size_t i = 0; i < bodies; ++i) {
      const Sway& sway = sways[i];
      const double at = std::sin(sway.rate * step * scene.dt + sway.phase), half = 0.03 * at, s = std::sin(half);
      const Vec3 place = Vec3{1.2 * static_cast<double>(i), 0, 0} + 0.03 * at * sway.way;
      const Pose across = i % 2 == 0 ? Pose{} : *pose_from_quaternion({c, c, 0, 0}, {});
      const Pose turn =
          *pose_from_quaternion({std::cos(half), s * sway.axis[0], s * sway.axis[1], s * sway.axis[2]}, {});
      Pose pose = compose(turn, across);
      pose = made_rigid(pose).value_or(pose);
      pose.translation = place;
      poses.push_back(pose);
    }
  }
  return scene;
}

std::vector<Scene> every_scene(std::size_t bodies, int steps, std::uint64_t seed) {
  std::vector<Scene> scenes;
  scenes.push_back(flight(bodies, steps, seed));
  scenes.push_back(falling_pile(bodies, steps, seed + 1));
  scenes.push_back(asteroid_field(bodies, steps, seed + 2));
  scenes.push_back(robot_arm(bodies, steps, seed + 3));
  scenes.push_back(machines(bodies, steps, seed + 7));
  scenes.push_back(bouncing_box(bodies, steps, seed + 4));
  scenes.push_back(conveyor(bodies, steps, seed + 5));
  scenes.push_back(clusters(bodies, steps, seed + 6));
  return scenes;
}

}  // namespace orchard::runtime::test
