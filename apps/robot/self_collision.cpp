#include "robot/self_collision.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "orchard/runtime/collide.h"
#include "orchard/spheretree/octree.h"
#include "orchard/spheretree/pack.h"

namespace orchard::robot {
namespace {

constexpr std::uint64_t kStage = 0x726f626f74;  // of the random numbers
constexpr Index kBlock = 100;                   // states that a thread takes at a time

struct Body {
  runtime::PackedSphereTree packed;
  runtime::PreparedTree tree;
  std::vector<Sphere> spheres;
  Sphere ball;  // around the solid and the spheres
  bool solid = false;
};

runtime::Pose pose_of(const Motion& motion) {
  runtime::Pose pose;
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) pose.rotation[at(3 * row + column)] = motion.linear()(row, column);
    pose.translation[at(row)] = motion.translation()[row];
  }
  // Products of many rotations drift from one.
  if (const auto rigid = runtime::made_rigid(pose)) return *rigid;
  return pose;
}

class Sampler {
 public:
  Sampler(const Robot& robot, const std::vector<LinkShape>& shapes, const std::vector<std::vector<Sphere>>& spheres)
      : robot_(robot), shapes_(shapes), bodies_(shapes.size()) {
    tbb::parallel_for(std::size_t{0}, shapes.size(), [&](std::size_t i) {
      Body& body = bodies_[i];
      const Surface& surface = shapes[i].surface;
      body.packed = pack(octree(surface), surface);
      body.tree = runtime::PreparedTree(body.packed);
      body.spheres = spheres[i];
      body.solid = surface.solid();
      body.ball = surface.bounding_ball();
      for (const Sphere& sphere : body.spheres)
        body.ball.radius = std::max(body.ball.radius, (sphere.center - body.ball.center).norm() + sphere.radius);
    });
  }

  struct Counts {
    std::vector<Index> touching, spheres;
  };

  // Adds a state's answers for every pair.
  void add(const JointValues& values, runtime::Workspace& workspace, Counts& counts) const {
    const std::vector<Motion> motions = link_motions(robot_, values);
    std::vector<runtime::Pose> poses;
    std::vector<std::vector<Sphere>> placed;
    std::vector<Point> centers;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Motion& motion = motions[shapes_[i].link];
      poses.push_back(pose_of(motion));
      centers.push_back(motion * bodies_[i].ball.center);
      placed.push_back(bodies_[i].spheres);
      for (Sphere& sphere : placed.back()) sphere.center = motion * sphere.center;
    }
    std::size_t pair = 0;
    for (std::size_t a = 0; a < bodies_.size(); ++a) {
      for (std::size_t b = a + 1; b < bodies_.size(); ++b, ++pair) {
        if ((centers[a] - centers[b]).norm() > (1 + 1e-9) * (bodies_[a].ball.radius + bodies_[b].ball.radius)) continue;
        if (spheres_meet(placed[a], placed[b])) ++counts.spheres[pair];
        if (solids_meet(workspace, a, b, poses)) ++counts.touching[pair];
      }
    }
  }

 private:
  static bool spheres_meet(const std::vector<Sphere>& a, const std::vector<Sphere>& b) {
    for (const Sphere& one : a)
      for (const Sphere& other : b) {
        const double reach = one.radius + other.radius;
        if ((one.center - other.center).squaredNorm() <= reach * reach) return true;
      }
    return false;
  }

  // The answer "maybe" counts as touching.
  bool solids_meet(runtime::Workspace& workspace, std::size_t a, std::size_t b,
                   const std::vector<runtime::Pose>& poses) const {
    const Body &one = bodies_[a], &other = bodies_[b];
    const runtime::TreePair pair(one.tree, other.tree);
    if (runtime::collide(workspace, pair, poses[a], poses[b]).answer != runtime::Answer::no) return true;
    return lies_in(one, poses[a], other, poses[b]) || lies_in(other, poses[b], one, poses[a]);
  }

  static bool lies_in(const Body& inner, const runtime::Pose& at, const Body& outer, const runtime::Pose& outer_at) {
    return outer.solid && inner.tree.radius < outer.tree.radius &&
           runtime::contains_solid(outer.packed, outer_at, inner.packed, at);
  }

  const Robot& robot_;
  const std::vector<LinkShape>& shapes_;
  std::vector<Body> bodies_;
};

// The link above, past links that have no shape; nothing above a root.
std::optional<Index> link_above(const Robot& robot, const std::vector<bool>& has_shape, Index link) {
  while (const auto joint = robot.joint_above(link)) {
    link = robot.joints[*joint].parent;
    if (has_shape[link]) return link;
  }
  return std::nullopt;
}

PairVerdict verdict_of(const LinkPair& pair, bool adjacent, Index states) {
  if (adjacent) return PairVerdict::adjacent;
  if (pair.touching == 0) return PairVerdict::never;
  if (pair.touching == states) return PairVerdict::always;
  return pair.spheres_touching == states ? PairVerdict::spheres_always : PairVerdict::sometimes;
}

}  // namespace

const char* name(PairVerdict verdict) {
  switch (verdict) {
    case PairVerdict::adjacent:
      return "Adjacent";
    case PairVerdict::always:
    case PairVerdict::spheres_always:
      return "Always";
    case PairVerdict::never:
      return "Never";
    case PairVerdict::sometimes:
      break;
  }
  return "Sometimes";
}

std::string SelfCollision::in_words() const {
  return fmt::format(
      "found in {} joint states, uniform within the limits, seed {}: certain in each of them, unknown between them",
      states, seed);
}

SelfCollision sample_self_collision(const Robot& robot, const std::vector<LinkShape>& shapes,
                                    const std::vector<std::vector<Sphere>>& spheres,
                                    const SelfCollisionOptions& options, const Progress& progress) {
  const Sampler sampler(robot, shapes, spheres);
  const std::size_t pairs = shapes.size() * (shapes.size() - 1) / 2;
  // A robot without free joints has one state.
  const Index states = robot.free_joints().empty() ? 1 : options.states;
  const Index blocks = (states + kBlock - 1) / kBlock;
  std::vector<Sampler::Counts> counts(blocks);
  report_progress(progress, "self-collision", 0);
  tbb::parallel_for(Index{0}, blocks, [&](Index block) {
    runtime::Workspace workspace;
    counts[block] = {std::vector<Index>(pairs, 0), std::vector<Index>(pairs, 0)};
    for (Index state = block * kBlock; state < std::min(states, (block + 1) * kBlock); ++state) {
      Random random(options.seed, kStage, state);
      sampler.add(random_joint_values(robot, random), workspace, counts[block]);
    }
  });
  SelfCollision result{.states = states, .seed = options.seed, .pairs = {}};
  std::vector<bool> has_shape(robot.links.size(), false);
  for (const LinkShape& shape : shapes) has_shape[shape.link] = true;
  std::size_t pair = 0;
  for (std::size_t a = 0; a < shapes.size(); ++a) {
    for (std::size_t b = a + 1; b < shapes.size(); ++b, ++pair) {
      LinkPair own{.a = shapes[a].link, .b = shapes[b].link};
      for (const Sampler::Counts& block : counts) {
        own.touching += block.touching[pair];
        own.spheres_touching += block.spheres[pair];
      }
      const bool adjacent =
          link_above(robot, has_shape, own.a) == own.b || link_above(robot, has_shape, own.b) == own.a;
      own.verdict = verdict_of(own, adjacent, states);
      result.pairs.push_back(own);
    }
  }
  return result;
}

}  // namespace orchard::robot
