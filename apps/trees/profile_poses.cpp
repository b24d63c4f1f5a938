#include "trees/profile_poses.h"

#include <cmath>

#include "orchard/geometry/random.h"
#include "orchard/runtime/narrow_phase.h"
#include "orchard/runtime/pose.h"

namespace orchard::apps {
namespace {

using runtime::Pose;
using runtime::Vec3;

constexpr std::uint64_t kStage = 700;  // of the random numbers
constexpr double kStep = 1.0 / 16;     // of the radii's sum

// By throwing away what falls outside of the ball: sines may differ between maths libraries.
Vec3 random_direction(Random& random) {
  while (true) {
    const Vec3 v{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    const double square = dot(v, v);
    if (square > 1e-4 && square <= 1) return (1 / std::sqrt(square)) * v;
  }
}

Pose random_rotation(Random& random) {
  while (true) {
    std::array<double, 4> q{};
    double square = 0;
    for (double& x : q) {
      x = random.uniform(-1, 1);
      square += x * x;
    }
    if (square <= 1e-4 || square > 1) continue;
    if (const auto pose = runtime::pose_from_quaternion(q, {0, 0, 0})) return *pose;
  }
}

// Turned, with the ball's centre at `place`.
Pose centered(Pose turned, const Vec3& center, const Vec3& place) {
  turned.translation = place - Vec3(runtime::rotate(turned, center));
  return turned;
}

Vec3 perpendicular(Random& random, const Vec3& way) {
  while (true) {
    const Vec3 v = random_direction(random);
    const Vec3 across = v - dot(v, way) * way;
    const double square = dot(across, across);
    if (square > 1e-4) return (1 / std::sqrt(square)) * across;
  }
}

}  // namespace

RootBall root_ball(const runtime::TreeView& tree) {
  const runtime::SiblingBlock& root = tree.blocks[0];
  return {Vec3{tree.origin[0] + root.x[0], tree.origin[1] + root.y[0], tree.origin[2] + root.z[0]},
          double{root.radius[0]}};
}

std::vector<PosePair> flight_poses(const runtime::TreeView& a, const runtime::TreeView& b, unsigned flights,
                                   std::uint64_t seed) {
  const runtime::PreparedTree body_a(a), body_b(b);
  runtime::NarrowPhase pair(body_a, body_b, 1);
  const RootBall ball_a = root_ball(a), ball_b = root_ball(b);
  const double reach = ball_a.radius + ball_b.radius;
  std::vector<PosePair> poses;
  for (unsigned flight = 0; flight < flights; ++flight) {
    Random random(seed, kStage, flight);
    const Pose pose_a = centered(random_rotation(random), ball_a.center, {});
    const Pose turned = random_rotation(random);
    const Vec3 way = random_direction(random), aside = perpendicular(random, way);
    const double off = reach * std::sqrt(random.uniform()), half = std::sqrt(reach * reach - off * off);
    const double begin = -half + kStep * reach * random.uniform();
    for (int step = 0; begin + step * kStep * reach < half; ++step) {
      const double t = begin + step * kStep * reach;
      const PosePair poses_now{pose_a, centered(turned, ball_b.center, off * aside + t * way)};
      poses.push_back(poses_now);
      if (pair.start(poses_now.a, poses_now.b) != runtime::Answer::no && pair.refine_exactly() != runtime::Answer::no)
        break;
    }
  }
  return poses;
}

}  // namespace orchard::apps
