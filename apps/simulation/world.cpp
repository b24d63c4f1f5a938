#include <algorithm>
#include <cmath>

#include "orchard/runtime/motion_helpers.h"
#include "scene.h"

namespace orchard::simulation {
namespace {

constexpr double kFriction = 3;  // per mass: 1/s, sideways at contacts
// Where the budget ended before the triangles, a "maybe" this near counts as a contact, in radii.
constexpr double kNear = 0.05;

bool in_contact(const World& world, const PairOutcome& pair) {
  const runtime::Verdict& v = pair.verdict;
  if (v.answer == runtime::Answer::no) return false;
  if (v.answer == runtime::Answer::yes) return true;
  return v.separation_bound <= kNear * std::min(world.bodies[pair.a].radius, world.bodies[pair.b].radius);
}

void push(Body& body, const Vec3& force, const Vec3& place) {
  body.force = body.force + force;
  body.torque = body.torque + cross(place - body.position, force);
}

Vec3 velocity_at(const Body& body, const Vec3& place) {
  return body.velocity + cross(body.spin, place - body.position);
}

// The spring of a contact is as short as the bodies have come nearer since it began: overlapping meshes do not tell how
// deep they are in each other.
double deepened(World& world, const PairOutcome& pair, double nearer) {
  auto& contacts = world.contacts;
  auto at = std::lower_bound(contacts.begin(), contacts.end(), pair, [](const World::Contact& c, const PairOutcome& p) {
    return c.a != p.a ? c.a < p.a : c.b < p.b;
  });
  if (at == contacts.end() || at->a != pair.a || at->b != pair.b) at = contacts.insert(at, {pair.a, pair.b, 0, true});
  at->seen = true;
  at->depth = std::max(0.0, at->depth + nearer);
  return at->depth;
}

void push_apart(World& world, const PairOutcome& pair) {
  Body &a = world.bodies[pair.a], &b = world.bodies[pair.b];
  const Vec3 place = pair.verdict.contact.center;
  Vec3 normal = pair.verdict.contact.normal;
  if (dot(normal, b.position - a.position) < 0) normal = -1.0 * normal;  // a guess that would pull them together
  const Vec3 relative = velocity_at(b, place) - velocity_at(a, place);
  const double parting = dot(relative, normal);
  const double mass = a.fixed || a.scripted   ? b.mass
                      : b.fixed || b.scripted ? a.mass
                                              : a.mass * b.mass / (a.mass + b.mass);
  const double depth = deepened(world, pair, -parting * world.scene.step);
  const double size = mass * std::max(0.0, world.scene.stiffness * depth - world.scene.damping * parting);
  const Vec3 force = size * normal - (mass * kFriction) * (relative - parting * normal);
  push(b, force, place);
  push(a, -1.0 * force, place);
}

bool is_free(const World& world, const Vec3& place, std::uint32_t body) {
  for (std::uint32_t i = 0; i < world.bodies.size(); ++i)
    if (i != body && length(world.bodies[i].position - place) <= world.bodies[i].radius + world.bodies[body].radius)
      return false;
  return true;
}

// Drones jump home and go on from there; the steered ship is a juggernaut (7.2). Where another ship is at home they go
// to the next one's that is free: otherwise they would sit in each other, which the text wants to avoid.
void send_home(World& world, const PairOutcome& pair) {
  const std::size_t count = world.bodies.size();
  for (const std::uint32_t body : {pair.a, pair.b}) {
    if (body == 0) continue;
    Vec3 home = world.bodies[body].home;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t other = 1 + (body - 1 + i) % (count - 1);
      if (!is_free(world, world.bodies[other].home, body)) continue;
      home = world.bodies[other].home;
      break;
    }
    world.jump(body, home, world.bodies[body].velocity);
  }
}

// The deepest vertex of the body's mesh holds the weight; none if the bounding sphere stays clear of the wall.
void push_from_wall(const World& world, Body& body, const Wall& wall) {
  if (dot(wall.normal, body.position) - body.radius > wall.offset) return;
  const Shape& shape = world.shapes[body.shape];
  const Pose pose = pose_of(body, shape);
  double lowest = wall.offset;
  Vec3 place;
  for (const auto& vertex : shape.tree.vertices) {
    const Vec3 point = runtime::transform(
        pose, {vertex[0] + shape.tree.origin[0], vertex[1] + shape.tree.origin[1], vertex[2] + shape.tree.origin[2]});
    const double height = dot(wall.normal, point);
    if (height < lowest) {
      lowest = height;
      place = point;
    }
  }
  const double depth = wall.offset - lowest;
  if (depth <= 0) return;
  const Vec3 velocity = velocity_at(body, place);
  const double parting = dot(velocity, wall.normal);
  const double size = body.mass * std::max(0.0, world.scene.stiffness * depth - world.scene.damping * parting);
  push(body, size * wall.normal - (body.mass * kFriction) * (velocity - parting * wall.normal), place);
}

// In free flight a body promises what its scene's forces are; held by others, all that forces can be.
void promise(World& world, std::uint32_t index, double acceleration) {
  Body& body = world.bodies[index];
  if (acceleration <= body.acceleration) return;
  body.acceleration = acceleration;
  body.drift = runtime::drift_of(runtime::Integrator::semi_implicit_euler, world.scene.step, acceleration);
  body.half_space = {};
  world.detection.cancel(index);
}

}  // namespace

World::World(Scene s, std::vector<Shape> the_shapes, std::uint64_t seed)
    : scene(std::move(s)), shapes(std::move(the_shapes)), draw(seed), detection(bodies, shapes, scene.step) {}

std::uint32_t World::add(Body body) {
  const auto index = static_cast<std::uint32_t>(bodies.size());
  body.radius = body.scale * shapes[body.shape].radius;
  body.inertia = 0.4 * body.mass * body.radius * body.radius;
  bodies.push_back(body);
  detection.add(index);
  return index;
}

void World::remove(std::uint32_t body) {
  bodies[body].there = false;
  detection.remove(body);
}

void World::jump(std::uint32_t body, const Vec3& position, const Vec3& velocity) {
  bodies[body].position = position;
  bodies[body].velocity = velocity;
  detection.teleport(body);
}

void respond_and_move(World& world, const StepOutcome& outcome) {
  const Scene& scene = world.scene;
  for (World::Contact& contact : world.contacts) contact.seen = false;
  for (const PairOutcome& pair : outcome.pairs) {
    // What is not excluded when the budget ends counts as a collision (7.3).
    if (scene.response == Response::jump_home && pair.verdict.answer != runtime::Answer::no) send_home(world, pair);
    if (scene.response == Response::push && in_contact(world, pair)) push_apart(world, pair);
  }
  std::erase_if(world.contacts, [](const World::Contact& contact) { return !contact.seen; });
  for (std::uint32_t i = 0; i < world.bodies.size(); ++i) {
    Body& body = world.bodies[i];
    if (!body.there || body.fixed || body.scripted || scene.response == Response::none) continue;
    for (const Wall& wall : scene.walls) push_from_wall(world, body, wall);
    const bool held = dot(body.force, body.force) > 0;
    body.force = body.force + body.mass * scene.gravity;
    if (scene.response == Response::push) promise(world, i, held ? scene.max_acceleration : length(scene.gravity));
    integrate(body, scene.step, scene.max_acceleration);
  }
  world.time += scene.step;
}

}  // namespace orchard::simulation
