// Exact answers against other libraries' at very many poses:
//   narrow_phase_check [-n poses] [-seed first] [-near] body.obj|body.orchard ..
// Half of the poses are random, half of them, or all (-near: FCL alone), next to the first contact (gaps and depths
// down to 1e-9 R). A difference is explained where moving the body by 1e-6 R, along the way it came or back, gives the
// other answer: it then lies within the rounding of one of the programs. Exits with 1 if one is not.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "bodies.h"
#include "orchard/runtime/distance.h"
#include "orchard/runtime/narrow_phase.h"
#include "support.h"

namespace {

using namespace orchard::bench;
using namespace orchard::runtime;

struct Place {
  Query query;
  std::array<double, 3> way;
};

bool touches(NarrowPhase& pair, const Pose& a, const Pose& b) {
  pair.start(a, b);
  return pair.refine_exactly() == Answer::yes;
}

Pose shifted(Pose pose, const std::array<double, 3>& way, double by) {
  for (std::size_t i = 0; i < 3; ++i) pose.translation[i] += by * way[i];
  return pose;
}

struct Options {
  std::size_t poses = 10000;
  std::uint64_t seed = 0;  // the first
  bool near = false;       // no poses that are not next to a contact
};

// Around one random approach: the contact by bisection, and steps of all sizes to both sides of it; and poses that have
// nothing to do with it.
void add_places(const TreeView& tree, std::uint64_t seed, bool near_only, std::vector<Place>& places) {
  orchard::runtime::test::Draw draw(seed);
  const PreparedTree body(tree);
  NarrowPhase pair(body, body, 1);
  const double r = double{tree.blocks[0].radius[0]};
  const auto way = draw.direction();
  const Pose a = draw.pose(0), b = draw.pose(0);
  double near = 0, far = 2.2 * r;
  while (far - near > 1e-11 * r) {
    const double middle = (near + far) / 2;
    (touches(pair, a, shifted(b, way, middle)) ? near : far) = middle;
  }
  for (int i = 0; i < 25; ++i) {
    const double step = std::pow(10, draw.uniform(-9, -1)) * r * (i % 2 == 0 ? 1 : -1);
    places.push_back({{a, shifted(b, way, near + step), 0}, way});
    if (!near_only) places.push_back({{draw.pose(0), draw.pose(draw.uniform(0, 2.2) * r), 1}, way});
  }
}

struct Count {
  std::size_t poses = 0, touching = 0, differ = 0, unexplained = 0;
};

Count compare(const TreeView& tree, PairRival& rival, const Options& options) {
  const std::size_t poses = options.poses;
  const PreparedTree body(tree);
  NarrowPhase pair(body, body, 1);
  const double step = 1e-6 * double{tree.blocks[0].radius[0]};
  Count count;
  for (std::uint64_t seed = options.seed; count.poses < poses;) {
    std::vector<Place> places;
    while (places.size() < 10000) add_places(tree, seed++, options.near, places);
    std::vector<Query> queries;
    for (const Place& place : places) queries.push_back(place.query);
    rival.place(queries);
    for (std::size_t i = 0; i < places.size() && count.poses < poses; ++i, ++count.poses) {
      const auto& [query, way] = places[i];
      const bool ours = touches(pair, query.a, query.b), theirs = rival.collide(i);
      count.touching += ours;
      if (ours == theirs) continue;
      ++count.differ;
      bool near = touches(pair, query.a, shifted(query.b, way, step)) == theirs ||
                  touches(pair, query.a, shifted(query.b, way, -step)) == theirs;
      if (!near && !ours) {
        DistanceQuery distance(body, body);
        distance.start(query.a, query.b);
        distance.refine();
        near = distance.upper() <= step;
      }
      if (near) continue;
      ++count.unexplained;
      std::printf("  unexplained: seed %llu, place %zu: orchard says %s\n", static_cast<unsigned long long>(seed), i,
                  ours ? "yes" : "no");
    }
  }
  return count;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  std::size_t failures = 0;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "-n" && i + 1 < argc) {
      options.poses = static_cast<std::size_t>(std::atoll(argv[++i]));
      continue;
    }
    if (std::string(argv[i]) == "-seed" && i + 1 < argc) {
      options.seed = std::strtoull(argv[++i], nullptr, 10);
      continue;
    }
    if (std::string(argv[i]) == "-near") {
      options.near = true;
      continue;
    }
    const PackedSphereTree tree = read_body(argv[i]);
    std::vector<std::pair<std::unique_ptr<PairRival>, std::size_t>> rivals;
    rivals.emplace_back(fcl_double(tree, tree), options.poses);
    if (!options.near) rivals.emplace_back(cgal(tree, tree), options.poses / 20);  // slower
    for (const auto& [rival, share] : rivals) {
      if (!rival) continue;
      const Count count = compare(tree, *rival, {share, options.seed, options.near});
      std::printf("%s: %zu triangles; %s: %zu poses, %zu touching, %zu answers differ, %zu of them beyond 1e-6 R\n",
                  argv[i], tree.triangles.size(), rival->name().c_str(), count.poses, count.touching, count.differ,
                  count.unexplained);
      std::fflush(stdout);
      failures += count.unexplained;
    }
  }
  return failures == 0 ? 0 : 1;
}
