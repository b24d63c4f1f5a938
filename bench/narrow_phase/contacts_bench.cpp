// Contacts of pairs, ours and FCL's, scene by scene:  contacts_bench [-n queries] [-ours times] [-only part of a
// scene's name] [body.obj|body.orchard ..] Each row has the mean of the best of a few passes, in microseconds, and a
// hash of all manifolds: a change that is to leave them as they are leaves it, too. `-ours`: asks ours alone that many
// times, for instruments that count.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

#include "bodies.h"
#include "orchard/runtime/contacts.h"
#include "orchard/runtime/detector.h"
#include "rival.h"
#include "support.h"

namespace {

using namespace orchard::bench;
using namespace orchard::runtime;
using Clock = std::chrono::steady_clock;

constexpr int kPasses = 5;

double best_mean(std::size_t queries, const std::function<void(std::size_t)>& run) {
  std::vector<double> best(queries, 1e300);
  for (int pass = 0; pass < kPasses; ++pass) {
    for (std::size_t i = 0; i < queries; ++i) {
      const auto start = Clock::now();
      run(i);
      const std::chrono::duration<double, std::micro> time = Clock::now() - start;
      best[i] = std::min(best[i], time.count());
    }
  }
  double sum = 0;
  for (const double x : best) sum += x;
  return sum / static_cast<double>(queries);
}

class Hash {
 public:
  void add(const Manifold& m) {
    add(static_cast<double>(m.count));
    for (std::uint32_t i = 0; i < m.count; ++i) {
      for (const double x : m.points[i].place) add(x);
      add(m.points[i].depth);
    }
    for (const double x : m.normal) add(x);
    add(m.depth);
  }
  std::uint64_t value() const { return hash_; }

 private:
  // Six digits of every number: what is beyond them is rounding.
  void add(double x) {
    const long long rounded = std::llround(x * 1e6);
    hash_ = (hash_ ^ static_cast<std::uint64_t>(rounded)) * 0x100000001b3u;
  }
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

struct Scene {
  std::string name;
  std::vector<Query> queries;
};

struct Options {
  std::size_t count = 20;
  int repeats = 0;  // of ours alone
  std::string only;
  bool wants(const std::string& name) const { return name.find(only) != std::string::npos; }
};

class Bench {
 public:
  Bench(const PackedSphereTree& a, const PackedSphereTree& b, const Options& options)
      : prepared_a_(a), prepared_b_(b), pair_(prepared_a_, prepared_b_), options_(options) {
    if (options.repeats > 0) return;
    for (const auto& make : {fcl_float, fcl_double}) {
      if (auto rival = make(a, b)) rivals_.push_back(std::move(rival));
    }
  }

  void measure(const Scene& scene) {
    const std::vector<Query>& queries = scene.queries;
    if (!options_.wants(scene.name)) return;
    if (options_.repeats > 0) {
      for (int i = 0; i < options_.repeats; ++i) {
        for (const Query& q : queries) contacts(workspace_, pair_, q.a, q.b);
      }
      return;
    }
    Hash hash;
    for (const Query& q : queries) hash.add(contacts(workspace_, pair_, q.a, q.b));
    const double all =
        best_mean(queries.size(), [&](std::size_t i) { contacts(workspace_, pair_, queries[i].a, queries[i].b); });
    const double points = best_mean(queries.size(), [&](std::size_t i) {
      contacts(workspace_, pair_, queries[i].a, queries[i].b, {.depth = false});
    });
    std::printf("%-34s %9.2f %9.2f", scene.name.c_str(), all, points);
    for (const auto& rival : rivals_) {
      rival->place(queries);
      const double theirs = best_mean(queries.size(), [&](std::size_t i) { rival->contacts(i); });
      std::printf(" %9.2f %8.3f", theirs, all / theirs);
    }
    std::printf("  %016llx\n", static_cast<unsigned long long>(hash.value()));
    std::fflush(stdout);
  }

 private:
  PreparedTree prepared_a_, prepared_b_;
  TreePair pair_;
  Workspace workspace_;
  Options options_;
  std::vector<std::unique_ptr<PairRival>> rivals_;
};

// Two copies of a body: behind their first contact by 0.1 % and 1 % of the radius, and deep in each other.
void measure_body(const std::string& path, const Options& options) {
  const PackedSphereTree tree = read_body(path);
  const double radius = double{tree.blocks[0].radius[0]};
  const std::vector<Query> all = approaches(tree, options.count, 1000);
  const std::string name = path.substr(path.rfind('/') + 1);
  Scene shallow{name + ", 0.1 % of R", {}}, middle{name + ", 1 % of R", {}}, deep{name + ", 30 % of R", {}};
  for (std::size_t i = 0; i + 5 < all.size(); i += kClasses) {
    shallow.queries.push_back(all[i + 4]);
    middle.queries.push_back(all[i + 5]);
    Query q = all[i + 5];
    const Vec3 back = Vec3(all[i + 4].b.translation) - Vec3(q.b.translation);  // 0.9 % of R long
    q.b.translation = Vec3(q.b.translation) - (0.29 * radius / length(back)) * back;
    deep.queries.push_back(q);
  }
  Bench bench(tree, tree, options);
  for (const Scene& scene : {shallow, middle, deep}) bench.measure(scene);
}

orchard::runtime::test::Mesh terrain(int side) {
  orchard::runtime::test::Mesh mesh;
  mesh.closed = false;
  for (int i = 0; i <= side; ++i) {
    for (int j = 0; j <= side; ++j) {
      const double x = 0.1 * i, y = 0.1 * j;
      mesh.vertices.push_back({x, y, 0.6 * std::sin(1.1 * x) * std::cos(0.7 * y) + 0.1 * std::sin(3.1 * x + 2.3 * y)});
    }
  }
  const auto at = [side](int i, int j) { return static_cast<std::uint32_t>(i * (side + 1) + j); };
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

// The second body sunk into the terrain by so much of its radius.
Scene resting(const std::string& name, const PackedSphereTree& ground, const PackedSphereTree& body, std::size_t count,
              double sunk) {
  const double radius = double{body.blocks[0].radius[0]};
  Scene scene{name, {}};
  orchard::runtime::test::Draw draw(17);
  while (scene.queries.size() < count) {
    Query q{{}, draw.pose(0), 0};
    const auto middle = rotate(q.b, body.origin);
    Vec3 place = {draw.uniform(3, 22), draw.uniform(3, 22), 5};
    const auto hit = cast_ray(ground, {}, place, Vec3{0, 0, -1});
    if (!hit) continue;
    place[2] = hit->point[2] + (1 - sunk) * radius;
    q.b.translation = place - Vec3(middle);
    scene.queries.push_back(q);
  }
  return scene;
}

// A ball of a detector on the terrain.
void measure_ball(const PackedSphereTree& ground, const Options& options) {
  const std::string name = "ball of a detector on terrain";
  if (!options.wants(name)) return;
  constexpr double kRadius = 0.3;
  Detector world({.time_step = 0.01});
  const ShapeId land = world.add_shape(ground), ball = world.add_sphere(kRadius);
  const BodyId floor = world.add_static({{land}}, Pose{});
  orchard::runtime::test::Draw draw(18);
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < options.count; ++i) {
    Vec3 place = {draw.uniform(3, 22), draw.uniform(3, 22), 5};
    if (const auto hit = cast_ray(ground, {}, place, Vec3{0, 0, -1})) {
      BodyState state;
      state.pose.translation = Vec3{place[0], place[1], hit->point[2] + 0.9 * kRadius};
      world.add_body(ball, state);
      places.push_back(state.pose.translation);
    }
  }
  std::vector<PairEvent> events;
  for (const PairEvent& event : world.step(0, {}).events) {
    if (event.a == floor || event.b == floor) events.push_back(event);
  }
  if (options.repeats > 0) {
    for (int i = 0; i < options.repeats; ++i) {
      for (const PairEvent& event : events) world.manifold(event);
    }
    return;
  }
  Hash hash;
  for (const PairEvent& event : events) hash.add(world.manifold(event));
  const double all = best_mean(events.size(), [&](std::size_t i) { world.manifold(events[i]); });
  const double near = best_mean(places.size(), [&](std::size_t i) { nearest_point(ground, {}, places[i]); });
  std::printf("%-34s %9.2f %9.2f (nearest point) %zu %016llx\n", name.c_str(), all, near, events.size(),
              static_cast<unsigned long long>(hash.value()));
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  std::vector<std::string> paths;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "-n" && i + 1 < argc) {
      options.count = static_cast<std::size_t>(std::atoi(argv[++i]));
    } else if (word == "-ours" && i + 1 < argc) {
      options.repeats = std::atoi(argv[++i]);
    } else if (word == "-only" && i + 1 < argc) {
      options.only = argv[++i];
    } else {
      paths.push_back(word);
    }
  }
  if (options.repeats == 0) {
    std::printf("%-34s %9s %9s %9s %8s %9s %8s  %s\n", "", "ours, us", "points", "FCL float", "ratio", "double",
                "ratio", "hash of ours");
  }
  for (const std::string& path : paths) measure_body(path, options);
  if (options.only.find(".obj") != std::string::npos) return 0;  // no scene of the ground
  using orchard::runtime::test::build_tree;
  const PackedSphereTree ground = build_tree(terrain(256), {.leaf_triangles = 4, .bounds = false});
  const PackedSphereTree ball =
      build_tree(orchard::runtime::test::uv_sphere(32, 16, 0.3), {.leaf_triangles = 4, .bounds = false});
  Bench(ground, ball, options)
      .measure(resting("sphere of 960 on terrain, 10 % of R", ground, ball, options.count, 0.1));
  measure_ball(ground, options);
  return 0;
}
