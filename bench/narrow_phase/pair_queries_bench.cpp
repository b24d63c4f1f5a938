// What the narrow phase answers besides yes and no, against other libraries at the same poses in the same run:
//   pair_queries_bench [-n approaches] body.obj|body.orchard ..
// Times are means in microseconds of one thread; of each query the best of a few passes, all engines in turn,
// each query beside its rivals: hence more than 300 lines.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

#include "bodies.h"
#include "collision/coherent_pair.h"
#include "orchard/runtime/contacts.h"
#include "orchard/runtime/shape_query.h"
#include "orchard/runtime/time_of_impact.h"
#include "rival.h"
#include "support.h"

namespace {

using namespace orchard::bench;
using namespace orchard::runtime;
using Clock = std::chrono::steady_clock;

constexpr int kPasses = 3;

// The mean over all queries of the best of a few passes.
struct Engine {
  std::string name;
  std::function<void(std::size_t)> run;
  std::vector<double> best = {};
};

void measure(std::vector<Engine>& engines, std::size_t queries) {
  for (Engine& engine : engines) engine.best.assign(queries, 1e300);
  for (int pass = 0; pass < kPasses; ++pass) {
    for (Engine& engine : engines) {
      for (std::size_t i = 0; i < queries; ++i) {
        const auto start = Clock::now();
        engine.run(i);
        const std::chrono::duration<double, std::micro> time = Clock::now() - start;
        engine.best[i] = std::min(engine.best[i], time.count());
      }
    }
  }
}

double mean(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x;
  return v.empty() ? 0 : sum / static_cast<double>(v.size());
}

// Ratios are to the engines from `rivals` on.
void print(const char* title, std::vector<Engine>& engines, std::size_t queries, std::size_t rivals) {
  measure(engines, queries);
  std::printf("%s, %zu queries\n", title, queries);
  for (std::size_t e = 0; e < engines.size(); ++e) {
    std::printf("  %-34s %9.3f us", engines[e].name.c_str(), mean(engines[e].best));
    for (std::size_t r = rivals; e < rivals && r < engines.size(); ++r) {
      std::printf("   %.3f of %s", mean(engines[e].best) / mean(engines[r].best), engines[r].name.c_str());
    }
    std::printf("\n");
  }
}

struct Bodies {
  explicit Bodies(const PackedSphereTree& from) : tree(from), prepared(from), pair(prepared, prepared) {
    const SiblingBlock& root = tree.blocks[0];
    radius = double{root.radius[0]};
    for (std::size_t i = 0; i < 3; ++i) middle[i] = prepared.root[i];
    for (const auto& make : {fcl_float, fcl_double, bullet}) {
      if (auto rival = make(tree, tree)) rivals.push_back(std::move(rival));
    }
  }
  void place(const std::vector<Query>& queries) {
    for (const auto& rival : rivals) rival->place(queries);
  }
  const PackedSphereTree& tree;
  PreparedTree prepared;
  TreePair pair;
  Workspace workspace;
  double radius = 0;
  std::array<double, 3> middle{};
  std::vector<std::unique_ptr<PairRival>> rivals;
};

// A pair that moves from the poses of one class on.
struct Motion {
  Motion(const Bodies& bodies, const std::vector<Query>& starts, int pose_class, double degrees, double share) {
    constexpr int steps = 100;
    for (const Query& start : starts) {
      if (start.pose_class != pose_class) continue;
      test::Draw draw(queries.size());
      Pose b = start.b;
      const auto axis = draw.direction(), way = draw.direction();
      const double half = 0.5 * 0.0174532925 * degrees;
      const Pose turn = *pose_from_quaternion(
          {std::cos(half), std::sin(half) * axis[0], std::sin(half) * axis[1], std::sin(half) * axis[2]}, {0, 0, 0});
      for (int step = 0; step < steps; ++step) {
        queries.push_back({start.a, b, pose_class});
        first.push_back(step == 0);
        const auto at = transform(b, bodies.middle);
        b.rotation = compose(turn, b).rotation;
        if (const auto rigid = made_rigid(b)) b = *rigid;
        const auto moved = rotate(b, bodies.middle);
        for (std::size_t i = 0; i < 3; ++i) b.translation[i] = at[i] - moved[i] + share * bodies.radius * way[i];
      }
    }
  }
  std::vector<Query> queries;
  std::vector<bool> first;
};

// How coherent answers come about, and what each way costs: remembered, or searched.
void print_ways(Bodies& bodies, const Motion& motion, const std::vector<double>& times) {
  static constexpr const char* names[] = {"no, remembered", "no, searched", "yes, remembered", "yes, searched"};
  std::size_t count[4] = {};
  double time[4] = {};
  TreePair pair = bodies.pair;
  for (std::size_t i = 0; i < motion.queries.size(); ++i) {
    if (motion.first[i]) pair.forget();
    const Query& q = motion.queries[i];
    Verdict verdict;
    CoherentPair coherent(bodies.workspace, pair, q.a, q.b);
    const bool known = coherent.recall(verdict);
    if (!known) verdict = coherent.search();
    const std::size_t way = (verdict.answer == Answer::yes ? 2u : 0u) + (known ? 0u : 1u);
    ++count[way];
    time[way] += times[i];
  }
  std::printf("  coherently:");
  for (std::size_t way = 0; way < 4; ++way) {
    if (count[way] == 0) continue;
    std::printf("  %s %.0f %% (%.3f us)", names[way],
                100.0 * static_cast<double>(count[way]) / static_cast<double>(motion.queries.size()),
                time[way] / static_cast<double>(count[way]));
  }
  std::printf("\n");
}

// Adds the sums of the times of "coherently", "each from scratch" and of FCL to `sums`.
void coherent(Bodies& bodies, const Motion& motion, const std::string& title, std::array<double, 3>& sums) {
  const std::vector<Query>& queries = motion.queries;
  bodies.place(queries);
  TreePair pair = bodies.pair;
  std::vector<Engine> engines;
  engines.push_back({"orchard, coherently", [&](std::size_t i) {
                       if (motion.first[i]) pair.forget();
                       collide_coherently(bodies.workspace, pair, queries[i].a, queries[i].b);
                     }});
  engines.push_back({"orchard, each from scratch",
                     [&](std::size_t i) { collide(bodies.workspace, bodies.pair, queries[i].a, queries[i].b); }});
  engines.push_back({"orchard, closer than 1 % of R", [&](std::size_t i) {
                       closer_than(bodies.workspace, bodies.pair, queries[i].a, queries[i].b, 0.01 * bodies.radius);
                     }});
  const std::size_t ours = engines.size();
  if (!bodies.rivals.empty()) {
    engines.push_back({bodies.rivals[0]->name(), [&](std::size_t i) { bodies.rivals[0]->collide(i); }});
  }
  print(title.c_str(), engines, queries.size(), ours);
  print_ways(bodies, motion, engines[0].best);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t engine = i < 2 ? i : ours;
    if (engine < engines.size()) sums[i] += mean(engines[engine].best);
  }
}

void coherent_classes(Bodies& bodies, const std::vector<Query>& starts) {
  std::array<double, 3> sums{}, slow{};
  for (int c = 0; c < kClasses; ++c) {
    const std::string name = kClassNames[static_cast<std::size_t>(c)];
    coherent(bodies, Motion(bodies, starts, c, 1, 0.005), "in motion, from " + name, sums);
  }
  std::printf("in motion, all classes: of FCL's mean: coherently %.3f, each from scratch %.3f\n", sums[0] / sums[2],
              sums[1] / sums[2]);
  coherent(bodies, Motion(bodies, starts, 3, 0.1, 0.0005), "at a tenth of that speed, from gap 0.1 % R", slow);
}

// FCL's is exact whatever relative error it is allowed: it does not heed it.
void distances(Bodies& bodies, const std::vector<Query>& queries) {
  bodies.place(queries);
  std::vector<Engine> engines;
  engines.push_back({"orchard, exact", [&](std::size_t i) {
                       distance(bodies.workspace, bodies.pair, queries[i].a, queries[i].b,
                                {.relative = 0, .absolute = 0});
                     }});
  engines.push_back(
      {"orchard, to 1 %", [&](std::size_t i) { distance(bodies.workspace, bodies.pair, queries[i].a, queries[i].b); }});
  engines.push_back({"orchard, to 10 %", [&](std::size_t i) {
                       distance(bodies.workspace, bodies.pair, queries[i].a, queries[i].b,
                                {.relative = 0.1, .absolute = 0});
                     }});
  if (!bodies.rivals.empty() && bodies.rivals[0]->measures_distance()) {
    engines.push_back({bodies.rivals[0]->name(), [&](std::size_t i) { bodies.rivals[0]->distance(i); }});
  }
  print("distance, all classes", engines, queries.size(), 3);
}

void contact_points(Bodies& bodies, const std::vector<Query>& starts) {
  std::vector<Query> queries;
  for (const Query& q : starts) {
    if (q.pose_class >= 4) queries.push_back(q);
  }
  bodies.place(queries);
  std::vector<Engine> engines;
  engines.push_back({"orchard, points, normal, depth",
                     [&](std::size_t i) { contacts(bodies.workspace, bodies.pair, queries[i].a, queries[i].b); }});
  engines.push_back({"orchard, first normal's depth", [&](std::size_t i) {
                       contacts(bodies.workspace, bodies.pair, queries[i].a, queries[i].b, {.refinements = 0});
                     }});
  engines.push_back({"orchard, points and normal", [&](std::size_t i) {
                       contacts(bodies.workspace, bodies.pair, queries[i].a, queries[i].b, {.depth = false});
                     }});
  const std::size_t ours = engines.size();
  for (const auto& rival : bodies.rivals) {
    if (!rival->finds_contacts()) continue;
    engines.push_back({rival->name(), [r = rival.get()](std::size_t i) { r->contacts(i); }});
  }
  print("contacts, penetration 0.1 % and 1 % R", engines, queries.size(), ours);
}

// From apart to the pose a tenth of R deeper than a contact, turning by up to a radian.
void impacts(Bodies& bodies, const std::vector<Query>& starts) {
  std::vector<Query> queries;
  std::vector<Travel> travels;
  std::vector<Pose> ends;
  for (std::size_t i = 0; i + 5 < starts.size(); i += kClasses) {
    Query q = starts[i];
    q.a = starts[i + 5].a;
    test::Draw draw(i);
    const auto axis = draw.direction();
    const double half = draw.uniform(0, 0.5);
    Pose to = starts[i + 5].b;
    to.rotation = compose(*pose_from_quaternion({std::cos(half), std::sin(half) * axis[0], std::sin(half) * axis[1],
                                                 std::sin(half) * axis[2]},
                                                {0, 0, 0}),
                          q.b)
                      .rotation;
    if (const auto rigid = made_rigid(to)) to = *rigid;
    queries.push_back(q);
    travels.push_back(travel_between(q.b, to));
    ends.push_back(to);
  }
  bodies.place(queries);
  const double tolerance = 1e-3 * bodies.radius;
  std::vector<double> ours_at(queries.size()), rivals_at(queries.size());
  double steps = 0;
  std::vector<Engine> engines;
  engines.push_back({"orchard", [&](std::size_t i) {
                       Travel rest;
                       rest.start = queries[i].a;
                       const Impact impact =
                           time_of_impact(bodies.workspace, bodies.pair, rest, travels[i], {.tolerance = tolerance});
                       ours_at[i] = impact.t0;
                       steps += impact.steps;
                     }});
  for (const auto& rival : bodies.rivals) {
    if (!rival->moves()) continue;
    engines.push_back({rival->name(), [&, r = rival.get()](std::size_t i) {
                         rivals_at[i] = r->time_of_impact(i, ends[i], tolerance);
                       }});
  }
  print("time of impact, to 0.1 % R", engines, queries.size(), 1);
  double apart = 0;
  for (std::size_t i = 0; i < queries.size(); ++i) apart = std::max(apart, std::fabs(ours_at[i] - rivals_at[i]));
  std::printf("  %.1f steps in the mean; times differ by at most %.4f\n",
              steps / static_cast<double>(kPasses * queries.size()), apart);
}

void rays(Bodies& bodies, std::size_t count) {
  std::vector<Ray> all;
  std::vector<std::array<double, 3>> ends, points, others;
  test::Draw draw(7);
  for (std::size_t i = 0; i < count; ++i) {
    const auto from = draw.direction(), at = draw.direction(), near = draw.direction(), way = draw.direction();
    Ray ray;
    std::array<double, 3> end{}, point{}, other{};
    const double part = draw.uniform(0, 0.7), away = draw.uniform(0, 1.5);
    for (std::size_t k = 0; k < 3; ++k) {
      ray.origin[k] = bodies.middle[k] + 2 * bodies.radius * from[k];
      const double target = bodies.middle[k] + part * bodies.radius * at[k];
      ray.direction[k] = 2 * (target - ray.origin[k]);
      end[k] = ray.origin[k] + ray.direction[k];
      point[k] = bodies.middle[k] + away * bodies.radius * near[k];
      other[k] = point[k] + 0.2 * bodies.radius * way[k];
    }
    ray.longest = 1;
    all.push_back(ray), ends.push_back(end), points.push_back(point), others.push_back(other);
  }
  const TreeView tree = bodies.tree;
  std::vector<Engine> engines;
  engines.push_back(
      {"orchard", [&](std::size_t i) { cast_ray(tree, {}, all[i].origin, all[i].direction, all[i].longest); }});
  for (const auto& rival : bodies.rivals) {
    if (!rival->casts_rays()) continue;
    engines.push_back({rival->name(), [&, r = rival.get()](std::size_t i) { r->cast_ray(all[i].origin, ends[i]); }});
  }
  print("rays", engines, count, 1);
  const double near = 0.1 * bodies.radius;
  std::vector<Engine> shapes;
  shapes.push_back({"orchard, nearest point", [&](std::size_t i) { nearest_point(tree, {}, points[i]); }});
  shapes.push_back({"orchard, sphere of 0.1 R touches",
                    [&](std::size_t i) { touches_capsule(tree, {}, points[i], points[i], near); }});
  shapes.push_back({"orchard, capsule of 0.1 R touches",
                    [&](std::size_t i) { touches_capsule(tree, {}, points[i], others[i], near); }});
  shapes.push_back({"orchard, box of 0.2 R touches", [&](std::size_t i) {
                      touches_box(tree, {}, {near, near, near}, Pose{.translation = points[i]});
                    }});
  shapes.push_back({"orchard, contains", [&](std::size_t i) { contains(tree, {}, points[i]); }});
  print("shapes", shapes, count, shapes.size());
}

// What a pair costs that is asked for the first time.
void making(const PackedSphereTree& tree) {
  const PreparedTree a(tree), b(tree);
  Workspace workspace;
  constexpr int count = 1000;
  double least = 1e300;  // of many rounds: others use the machine, too
  for (int round = 0; round < 50; ++round) {
    const auto begin = Clock::now();
    for (int i = 0; i < count; ++i) workspace.narrow.bind(a, b);
    least = std::min(least, std::chrono::duration<double, std::nano>(Clock::now() - begin).count() / count);
  }
  const auto start = Clock::now();
  const PreparedTree again(tree);
  const std::chrono::duration<double, std::micro> prepare = Clock::now() - start;
  std::printf("a pair has %zu bytes; it binds in %.0f ns; a tree is prepared in %.0f us (fingerprint %04x)\n",
              sizeof(TreePair), least, prepare.count(), static_cast<unsigned>(again.fingerprint & 0xffff));
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t count = 30;
  bool any = false;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "-n" && i + 1 < argc) {
      count = static_cast<std::size_t>(std::atoi(argv[++i]));
      continue;
    }
    any = true;
    const PackedSphereTree tree = read_body(argv[i]);
    std::printf("\n%s: %zu triangles\n", argv[i], tree.triangles.size());
    making(tree);
    Bodies bodies(tree);
    const auto starts = approaches(tree, count, 1000);
    coherent_classes(bodies, starts);
    distances(bodies, starts);
    contact_points(bodies, starts);
    impacts(bodies, starts);
    rays(bodies, 2000);
    std::fflush(stdout);
  }
  if (!any) std::fprintf(stderr, "usage: pair_queries_bench [-n approaches] body.obj|body.orchard ..\n");
  return any ? 0 : 2;
}
