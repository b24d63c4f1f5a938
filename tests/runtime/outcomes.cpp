// Prints a digest of everything that many queries say, level by level, for each pair of bodies.
#include <bit>
#include <cstdint>
#include <cstdio>

#include "bodies.h"
#include "orchard/runtime/contacts.h"
#include "orchard/runtime/shape_query.h"
#include "orchard/runtime/time_of_impact.h"
#include "support/effort.h"
#include "support/query_of_trees.h"

namespace {

using namespace orchard::runtime;
using namespace orchard::runtime::test;

class Digest {
 public:
  void add(std::uint64_t word) { state_ = (state_ ^ word) * 0x9e3779b97f4a7c15u, state_ ^= state_ >> 29; }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  void add(const NarrowPhase& query) {
    add(query.verdict());
    add(query.progress().pair_tests), add(query.progress().triangle_tests);
  }
  void add(const Verdict& v) {
    add(static_cast<std::uint64_t>(v.answer));
    add(v.separation_bound), add(v.lower_bound), add(v.work);
    for (std::size_t i = 0; i < 3; ++i) add(v.contact.center[i]), add(v.contact.normal[i]);
    add(v.contact.radius), add(std::uint64_t{v.contact.triangle_a}), add(std::uint64_t{v.contact.triangle_b});
  }
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 1;
};

// A small motion from some poses on, asked coherently.
void add_motion(Digest& digest, Workspace& workspace, TreePair pair, const Pose& a, Pose b, double step) {
  const Pose turn = *pose_from_quaternion({1, 0.01, -0.005, 0.008}, {0, 0, 0});
  for (int i = 0; i < 12; ++i) {
    digest.add(collide_coherently(workspace, pair, a, b));
    b.rotation = compose(turn, b).rotation;
    if (const auto rigid = made_rigid(b)) b = *rigid;
    b.translation[0] += step, b.translation[2] -= step / 2;
  }
}

}  // namespace

int main() {
  const auto all = bodies();
  Workspace workspace;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i; j < all.size(); ++j) {
      const PackedSphereTree &a = all[i].tree, &b = all[j].tree;
      test::OwnNarrowPhase query(a, b);
      test::OwnDistanceQuery distance(a, b);
      const PreparedTree first(a), second(b);
      const TreePair pair(first, second);
      const RayIndex index(a);
      std::vector<Ray> rays;
      std::vector<std::optional<RayHit>> hits(8);
      Digest digest;
      for (std::uint64_t seed = 0; seed < 12 * orchard::test::more(); ++seed) {
        Draw draw(seed);
        Pose pose_a = draw.pose(0), pose_b = draw.pose(draw.uniform(0, 1.2) * (a.bounding_radius + b.bounding_radius));
        if (seed % 3 == 0) pose_b.scale = draw.uniform(0.5, 2);
        pose_a = centered(a, pose_a), pose_b = centered(b, pose_b);
        query.start(pose_a, pose_b);
        for (digest.add(query); !query.finished(); digest.add(query)) query.refine();
        query.start(pose_a, pose_b);
        query.refine_exactly();
        digest.add(query);
        distance.start(pose_a, pose_b);
        distance.refine();
        digest.add(distance.lower()), digest.add(distance.upper()), digest.add(distance.work());
        const double size = a.bounding_radius + b.bounding_radius;
        digest.add(
            static_cast<std::uint64_t>(closer_than(workspace, pair, pose_a, pose_b, draw.uniform(0, 0.1) * size)));
        digest.add(workspace.distance.upper()), digest.add(workspace.distance.work());
        add_motion(digest, workspace, pair, pose_a, pose_b, 0.004 * size);
        const Manifold manifold = contacts(workspace, pair, pose_a, pose_b);
        digest.add(manifold.depth), digest.add(manifold.normal[0]), digest.add(std::uint64_t{manifold.count});
        Travel still, moving;
        still.start = pose_a, moving.start = pose_b;
        moving.velocity = {1, -2, 0.5}, moving.spin = {0.3, 0, 1};
        const Impact impact = time_of_impact(workspace, pair, still, moving);
        digest.add(impact.t0), digest.add(impact.work), digest.add(static_cast<std::uint64_t>(impact.answer));
        const auto near = nearest_point(a, pose_a, pose_b.translation);
        digest.add(near.distance), digest.add(std::uint64_t{near.triangle});
        const auto hit = cast_ray(a, pose_a, pose_b.translation, draw.direction());
        digest.add(hit ? hit->along : -1);
        rays.push_back({pose_b.translation, draw.direction()});
        if (rays.size() == 8) {
          cast_rays(index, pose_a, rays, hits);
          for (const auto& one : hits) digest.add(one ? one->along : -1);
          rays.clear();
        }
      }
      std::printf("%s / %s: %016llx\n", all[i].name.c_str(), all[j].name.c_str(),
                  static_cast<unsigned long long>(digest.value()));
    }
  }
  return 0;
}
