#pragma once
#include <functional>
#include <string>
#include <vector>

#include "detection.h"
#include "orchard/runtime/packed_tree.h"

namespace orchard::simulation {

// SplitMix64, with maps of its own from bits to numbers: the same on every machine.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits();
  double uniform(double low, double high);
  Vec3 in_ball(double radius);
  Vec3 direction();
  Quaternion attitude();

 private:
  std::uint64_t state_;
};

// A floor or a wall: the bodies' side is normal . x >= offset.
struct Wall {
  Vec3 normal;
  double offset;
};

// What the user does with the steered ship, a number in [-1, 1] each.
struct Steering {
  double throttle = 0, yaw = 0, pitch = 0;
  friend bool operator==(const Steering&, const Steering&) = default;
};

// What a collision does: nothing; a drone jumps home, and the steered ship, body 0, flies on (7.2); or springs push the
// bodies apart.
enum class Response { none, jump_home, push };

// What a scene starts with and how it goes on. Its functions are called by World, which has the bodies.
struct World;
struct Scene {
  std::string name;
  double frame = 0.1;  // seconds of simulated time between two pictures
  double step = 0.05;  // between two looks for collisions, dt_d; frame is a multiple
  Vec3 gravity{};
  std::vector<Wall> walls;
  Response response = Response::none;
  double stiffness = 900;         // of contacts, per mass: 1/s^2
  double damping = 12;            // per mass: 1/s
  double max_acceleration = 400;  // that forces can cause
  // Before each step: controls, scripted motion, bodies that come and go.
  std::function<void(World&, double time)> before = [](World&, double) {};
};

// All that moves, and who detects.
struct World {
  World(Scene scene, std::vector<Shape> shapes, std::uint64_t seed);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  std::uint32_t add(Body body);  // takes the radius from its shape and scale
  void remove(std::uint32_t body);
  void jump(std::uint32_t body, const Vec3& position, const Vec3& velocity);  // what was promised is void

  Scene scene;
  std::vector<Shape> shapes;
  std::vector<Body> bodies;
  Draw draw;
  Steering steering;
  Detection detection;
  double time = 0;

  // Depth of the contact that holds a pair, by what has come nearer since it began.
  struct Contact {
    std::uint32_t a, b;
    double depth;
    bool seen;
  };
  std::vector<Contact> contacts;  // ascending by bodies
};

inline constexpr const char* kSceneNames[] = {"flight", "pile", "asteroids", "robot", "box", "conveyor", "clusters"};
bool is_scene(const std::string& name);

// One of kSceneNames with so many bodies beside what is always there (0: as many as it usually has), all of the first
// shape where a scene does not need others.
std::unique_ptr<World> make_world(const std::string& scene, const std::vector<Shape>& shapes, std::size_t bodies,
                                  std::uint64_t seed);

// Moves everything to the next step's time, by the forces of the outcome of this one.
void respond_and_move(World& world, const StepOutcome& outcome);

}  // namespace orchard::simulation
