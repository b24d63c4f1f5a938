#pragma once
#include <span>
#include <string>
#include <vector>

#include "orchard/geometry/progress.h"
#include "robot/kinematics.h"
#include "robot/link_shape.h"

// Which pairs of links need no test for collision.
namespace orchard::robot {

struct SelfCollisionOptions {
  Index states = 10'000;  // of the joints, uniform within their limits
  std::uint64_t seed = 1;
};

enum class PairVerdict : std::uint8_t {
  adjacent,        // a joint joins them, or links without geometry do
  always,          // their solids touch in every state
  spheres_always,  // their spheres touch in every state, and their solids in some: with these spheres, it cannot be
                   // told
  never,           // their solids touch in no state
  sometimes        // to be tested
};

struct LinkPair {
  Index a = 0, b = 0;  // links of the robot, a < b
  PairVerdict verdict = PairVerdict::sometimes;
  Index touching = 0;          // states in which the solids touch or one lies in the other
  Index spheres_touching = 0;  // states in which a sphere of one touches one of the other
  bool ignored() const { return verdict != PairVerdict::sometimes; }
};

struct SelfCollision {
  Index states = 0;
  std::uint64_t seed = 0;
  std::vector<LinkPair> pairs;  // of links with spheres, all of them, ordered by a and b

  std::string in_words() const;  // how it was found, in one sentence without its full stop
};

const char* name(PairVerdict verdict);  // as SRDF's reasons are written

// Asks the run-time about the links' triangles in every state: its "no" and its "yes" are certain, so that "never" and
// "always" are of the states that were sampled, and of nothing between them. `spheres` are those of each shape. The
// same on any number of threads. O(states * pairs), a few microseconds each.
SelfCollision sample_self_collision(const Robot& robot, const std::vector<LinkShape>& shapes,
                                    const std::vector<std::vector<Sphere>>& spheres,
                                    const SelfCollisionOptions& options = {}, const Progress& progress = {});

}  // namespace orchard::robot
