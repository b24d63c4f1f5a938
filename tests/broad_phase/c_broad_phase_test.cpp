// The C interface beside the C++ one, function after function: hence more than 300 lines.
#include <gtest/gtest.h>

#include <cmath>

#include "../runtime/allocation.h"
#include "orchard/runtime/broad_queries.h"
#include "orchard/runtime/orchard_broad_phase.h"
#include "runtime/numbers.h"
#include "worlds.h"

// The broad phase in C: says what it says in C++, refuses what it refuses, and lets no exception out.
namespace {

using namespace orchard::runtime;

using orchard::runtime::test::kStep;

orchard_motion in_c(const Motion& m) {
  orchard_motion motion = orchard_default_motion();
  std::copy_n(m.position.begin(), 3, motion.position);
  std::copy_n(m.velocity.begin(), 3, motion.velocity);
  std::copy_n(m.half_space.begin(), 3, motion.half_space);
  motion.radius = m.radius, motion.acceleration = m.acceleration, motion.drift = m.drift, motion.expiry = m.expiry;
  return motion;
}

void from_bodies(void* context, double time, const uint32_t* bodies, size_t count, orchard_motion* motions) {
  const auto& moving = *static_cast<const test::MovingBodies*>(context);
  for (size_t i = 0; i < count; ++i) motions[i] = in_c(moving.motion(bodies[i], time));
}
void from_values(void* context, double, const uint32_t* bodies, size_t count, orchard_motion* motions) {
  const auto& values = *static_cast<const std::vector<orchard_motion>*>(context);
  for (size_t i = 0; i < count; ++i) motions[i] = values[bodies[i]];
}

struct Freed {
  void operator()(orchard_broad_phase* world) const { orchard_broad_phase_free(world); }
};
using World = std::unique_ptr<orchard_broad_phase, Freed>;
World made(orchard_motion_source source, void* context, const orchard_broad_phase_options& options) {
  return World(orchard_broad_phase_new(source, context, &options));
}

// All that the two say about the same bodies.
class Twins {
 public:
  explicit Twins(test::MovingBodies& bodies)
      : in_cpp_(bodies.source()), queries_(in_cpp_), in_c_(made(from_bodies, &bodies, orchard_default_broad_phase())) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const auto rank = static_cast<std::uint8_t>(i % 3);
      const orchard_body_filter filter{1, 0xffffffffu, i % 4 == 0 ? -1 : 0, false};
      const BodyId id = in_cpp_.add(rank, {filter.category, filter.mask, filter.group});
      const orchard_body body = orchard_broad_phase_add(in_c_.get(), rank, &filter);
      EXPECT_TRUE(body.index == id.index && body.generation == id.generation);
    }
    EXPECT_EQ(orchard_broad_phase_size(in_c_.get()), bodies.size());
  }

  bool advance(double t, const orchard_budget* budget) {
    const Advance a = budget == nullptr ? in_cpp_.advance(t) : in_cpp_.advance(t, Budget{.work = budget->tests});
    const orchard_advance b = orchard_broad_phase_advance(in_c_.get(), t, budget, 0);
    EXPECT_EQ(a.time, b.time);
    EXPECT_EQ(a.pairs.size(), b.pair_count);
    for (std::size_t i = 0; i < std::min(a.pairs.size(), b.pair_count); ++i) {
      EXPECT_TRUE(a.pairs[i].a == b.pairs[2 * i] && a.pairs[i].b == b.pairs[2 * i + 1]);
    }
    EXPECT_EQ(a.incomplete_from, b.incomplete_from);
    EXPECT_EQ(a.left_over, b.left_over);
    EXPECT_EQ(a.work, b.work);
    EXPECT_EQ(a.refused.size(), b.refused_count);
    EXPECT_FALSE(b.time_refused || b.out_of_memory);
    EXPECT_EQ(in_cpp_.next_time(), orchard_broad_phase_next_time(in_c_.get()));
    EXPECT_EQ(in_cpp_.motions_asked(), orchard_broad_phase_motions_asked(in_c_.get()));
    pairs_ += a.pairs.size();
    return !a.pairs.empty();
  }

  void ask(test::Draw& draw) {
    orchard_broad_phase* const c = in_c_.get();
    const Vec3 p = draw.in_ball(12), q = draw.in_ball(12), way = draw.direction();
    const QueryFilter filter{static_cast<std::uint32_t>(draw.bits() | 1), static_cast<std::uint32_t>(draw.bits() | 1)};
    const orchard_query_filter which{filter.category, filter.mask};
    EXPECT_EQ(queries_.time(), orchard_broad_phase_query_time(c));
    orchard_body_hit hit{};
    const auto same_first = [&](const std::optional<BodyHit>& a, int b) {
      ASSERT_EQ(a.has_value(), b == 1);
      EXPECT_TRUE(!a || (a->body == hit.body && a->along == hit.along));
    };
    const Ray ray{p, way, 20};
    same_first(queries_.first_hit(ray, filter),
               orchard_broad_phase_first_hit(c, p.data(), way.data(), 20, &which, &hit));
    same_first(queries_.first_on_segment(p, q),
               orchard_broad_phase_first_on_segment(c, p.data(), q.data(), nullptr, &hit));
    orchard_body_hit hits[3];
    const auto same_hits = [&](std::span<const BodyHit> a, std::size_t b) {
      ASSERT_EQ(a.size(), b);
      for (std::size_t i = 0; i < std::min<std::size_t>(3, b); ++i) {
        EXPECT_TRUE(a[i].body == hits[i].body && a[i].along == hits[i].along);
      }
    };
    same_hits(queries_.all_hits(ray, filter),
              orchard_broad_phase_all_hits(c, p.data(), way.data(), 20, &which, hits, 3));
    same_hits(queries_.all_on_segment(p, q, filter),
              orchard_broad_phase_all_on_segment(c, p.data(), q.data(), &which, hits, 3));
    std::uint32_t bodies[500];
    const auto same_bodies = [&](std::span<const BodyIndex> a, std::size_t b) {
      ASSERT_EQ(a.size(), b);
      EXPECT_TRUE(std::equal(a.begin(), a.end(), bodies));
      found_ += b;
    };
    same_bodies(queries_.touching_sphere(p, 3, filter),
                orchard_broad_phase_touching_sphere(c, p.data(), 3, &which, bodies, 500));
    const Vec3 upper = p + Vec3{4, 4, 4};
    same_bodies(queries_.touching_box(p, upper),
                orchard_broad_phase_touching_box(c, p.data(), upper.data(), nullptr, bodies, 500));
    orchard_near_body near[5];
    const auto expected = queries_.nearest(p, 5);
    ASSERT_EQ(orchard_broad_phase_nearest(c, p.data(), 5, nullptr, near), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_TRUE(near[i].body == expected[i].body && near[i].distance == expected[i].distance);
    }
  }
  void predict_load(double time) {
    std::array<StepsAhead, 20> steps;
    std::array<orchard_steps_ahead, 20> in_c;
    const std::size_t known = in_cpp_.predict_load(time, steps);
    ASSERT_EQ(orchard_broad_phase_predict_load(in_c_.get(), time, in_c.data(), 20), known);
    for (std::size_t i = 0; i < known; ++i) {
      EXPECT_TRUE(steps[i].updates == in_c[i].updates && steps[i].meetings == in_c[i].meetings &&
                  steps[i].overlaps == in_c[i].overlaps);
    }
  }
  std::size_t pairs() const { return pairs_; }
  std::size_t found() const { return found_; }

 private:
  BroadPhase in_cpp_;
  BodyQueries queries_;
  World in_c_;
  std::size_t pairs_ = 0, found_ = 0;
};

TEST(CBroadPhase, SaysWhatItSaysInCpp) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    test::MovingBodies bodies({.bodies = seed % 2 == 0 ? 40u : 400u, .ball = 12, .min_radius = 0.1, .end = 0.5}, seed);
    Twins twins(bodies);
    test::Draw draw(seed);
    const orchard_budget budget{1 + draw.bits() % 500, ORCHARD_NO_LIMIT};
    for (int step = 0; step < 40; ++step) {
      while (twins.advance(kStep * step, step % 3 == 0 ? &budget : nullptr)) {
      }
      twins.ask(draw);
      twins.predict_load(kStep * step);
      if (testing::Test::HasFailure()) FAIL() << "seed " << seed << " step " << step;
    }
    EXPECT_GT(twins.pairs(), 10u);
    EXPECT_GT(twins.found(), 10u);
  }
}

int count_and_refuse(void* context, orchard_body a, orchard_body b) {
  EXPECT_LT(a.index, b.index);
  ++*static_cast<int*>(context);
  return 0;
}
void note(void* context, const orchard_motion_bound_violation* broken) {
  static_cast<std::vector<orchard_motion_bound_violation>*>(context)->push_back(*broken);
}

TEST(CBroadPhase, TakesChangesAndTellsOfBrokenPromises) {
  std::vector<orchard_motion> values(3, orchard_default_motion());
  EXPECT_EQ(values[0].expiry, std::numeric_limits<double>::infinity());
  for (orchard_motion& motion : values) motion.radius = 1;
  std::vector<orchard_motion_bound_violation> broken;
  orchard_broad_phase_options options = orchard_default_broad_phase();
  options.validate = true;
  options.broken = note, options.broken_context = &broken;
  const World world = made(from_values, &values, options);
  orchard_broad_phase* const w = world.get();
  const orchard_body a = orchard_broad_phase_add(w, 0, nullptr);
  const orchard_body_filter filter = orchard_default_filter();
  const orchard_body b = orchard_broad_phase_add(w, 7, &filter);
  const orchard_body wall = orchard_broad_phase_add_static(w, &values[2], 0, nullptr);
  EXPECT_EQ(orchard_broad_phase_body(w, wall.index).generation, wall.generation);
  EXPECT_EQ(orchard_broad_phase_body(w, 9).index, ORCHARD_NO_BODY);
  orchard_advance now = orchard_broad_phase_advance(w, 0, nullptr, 0);
  ASSERT_EQ(now.pair_count, 3u);
  EXPECT_EQ(now.pairs[4], 1u);
  EXPECT_EQ(now.pairs[5], 2u);
  const orchard_body_filter apart{1, 0xffffffffu, -1, false};
  EXPECT_EQ(orchard_broad_phase_set_filter(w, a, &apart), 1);
  EXPECT_EQ(orchard_broad_phase_set_filter(w, b, &apart), 1);
  EXPECT_EQ(orchard_broad_phase_advance(w, kStep, nullptr, 0).pair_count, 2u);
  int asked = 0;
  EXPECT_EQ(orchard_broad_phase_set_pair_filter(w, count_and_refuse, &asked), 1);
  EXPECT_EQ(orchard_broad_phase_advance(w, 2 * kStep, nullptr, 0).pair_count, 0u);
  EXPECT_GE(asked, 2);
  EXPECT_EQ(orchard_broad_phase_set_pair_filter(w, nullptr, nullptr), 1);
  EXPECT_TRUE(broken.empty());
  values[1].position[0] = 0.25;
  EXPECT_EQ(orchard_broad_phase_advance(w, 3 * kStep, nullptr, 0).pair_count, 2u);
  ASSERT_EQ(broken.size(), 1u);
  EXPECT_EQ(broken[0].body.index, b.index);
  EXPECT_NEAR(broken[0].position, 0.25, 1e-9);
  EXPECT_EQ(broken[0].given.position[0], 0.25);
  EXPECT_EQ(orchard_broad_phase_motion_bound_violations(w), 1u);
  values[1].radius = NAN;
  EXPECT_EQ(orchard_broad_phase_cancel(w, b), 1);
  now = orchard_broad_phase_advance(w, 4 * kStep, nullptr, 0);
  ASSERT_EQ(now.refused_count, 1u);
  EXPECT_EQ(now.refused[0], b.index);
  orchard_motion far = values[2];
  far.position[1] = 50;
  EXPECT_EQ(orchard_broad_phase_move_static(w, wall, &far), 1);
  EXPECT_EQ(orchard_broad_phase_set_importance(w, a, 3), 1);
  EXPECT_EQ(orchard_broad_phase_remove(w, b), 1);
  EXPECT_EQ(orchard_broad_phase_advance(w, 5 * kStep, nullptr, 0).pair_count, 0u);
  EXPECT_EQ(orchard_broad_phase_size(w), 2u);
  EXPECT_EQ(orchard_broad_phase_move_static(w, wall, &values[2]), 1);
  EXPECT_EQ(orchard_broad_phase_advance(w, 6 * kStep, nullptr, 0).pair_count, 1u);
  const orchard_body_filter ignoring{1, 0xffffffffu, 0, true};
  EXPECT_EQ(orchard_broad_phase_set_filter(w, a, &ignoring), 1);
  EXPECT_EQ(orchard_broad_phase_advance(w, 7 * kStep, nullptr, 0).pair_count, 0u);
  EXPECT_GT(orchard_broad_phase_memory_bytes(w), sizeof(orchard_motion));
  for (const orchard_body none : {b, orchard_body{ORCHARD_NO_BODY, 0}, orchard_body{0, 0}, orchard_body{77, 1}}) {
    EXPECT_EQ(orchard_broad_phase_remove(w, none), 0);
    EXPECT_EQ(orchard_broad_phase_cancel(w, none), 0);
    EXPECT_EQ(orchard_broad_phase_move_static(w, none, &far), 0);
    EXPECT_EQ(orchard_broad_phase_set_importance(w, none, 0), 0);
    EXPECT_EQ(orchard_broad_phase_set_filter(w, none, nullptr), 0);
  }
  EXPECT_EQ(orchard_broad_phase_move_static(w, a, &far), 0);  // it is not static
}

void run_backwards(void* context, size_t count, void (*job)(void* data, size_t index), void* data) {
  ++*static_cast<std::size_t*>(context);
  while (count > 0) job(data, --count);
}

TEST(CBroadPhase, CutsUpdatesOfManyBodiesIntoJobs) {
  std::vector<orchard_motion> values(20000);
  test::Draw draw(3);
  for (orchard_motion& value : values) {
    Motion m;
    m.position = draw.in_ball(60), m.radius = 1;
    value = in_c(m);
  }
  std::size_t batches = 0;
  std::vector<std::vector<std::uint32_t>> reports;
  for (const bool jobs : {false, true}) {
    orchard_broad_phase_options options = orchard_default_broad_phase();
    if (jobs) options.executor = {run_backwards, &batches, 2};
    const World world = made(from_values, &values, options);
    for (std::size_t i = 0; i < values.size(); ++i) orchard_broad_phase_add(world.get(), 0, nullptr);
    const orchard_advance now = orchard_broad_phase_advance(world.get(), 0, nullptr, 0);
    reports.emplace_back(now.pairs, now.pairs + 2 * now.pair_count);
    EXPECT_EQ(batches > 0, jobs);
  }
  EXPECT_GT(reports[0].size(), 1000u);
  EXPECT_EQ(reports[0], reports[1]);
}

TEST(CBroadPhase, RefusesWhatIsNone) {
  orchard_broad_phase_free(nullptr);
  orchard_broad_phase_options options = orchard_default_broad_phase();
  const World still = made(nullptr, nullptr, options);
  EXPECT_EQ(orchard_broad_phase_add(still.get(), 0, nullptr).index, ORCHARD_NO_BODY);
  orchard_motion place = orchard_default_motion();
  EXPECT_NE(orchard_broad_phase_add_static(still.get(), &place, 0, nullptr).index, ORCHARD_NO_BODY);
  place.radius = -1;
  EXPECT_EQ(orchard_broad_phase_add_static(still.get(), &place, 0, nullptr).index, ORCHARD_NO_BODY);
  for (const double t : {double{NAN}, double{INFINITY}, 1e300}) {
    EXPECT_TRUE(orchard_broad_phase_advance(still.get(), t, nullptr, 0).time_refused);
  }
  options.time_step = 0;
  place.radius = 1;
  const World none = made(nullptr, nullptr, options);
  EXPECT_EQ(orchard_broad_phase_valid(none.get()), 0);
  EXPECT_EQ(orchard_broad_phase_add_static(none.get(), &place, 0, nullptr).index, ORCHARD_NO_BODY);
  EXPECT_EQ(orchard_broad_phase_set_pair_filter(none.get(), nullptr, nullptr), 0);
  EXPECT_TRUE(orchard_broad_phase_advance(none.get(), 0, nullptr, 0).time_refused);
  const double zero[3] = {0, 0, 0}, one[3] = {1, 1, 1}, bad[3] = {0, NAN, 0};
  orchard_body_hit hit;
  for (orchard_broad_phase* const w : {still.get(), none.get()}) {
    const double* const way = w == still.get() ? zero : one;
    EXPECT_EQ(orchard_broad_phase_first_hit(w, zero, way, INFINITY, nullptr, &hit), -1);
    EXPECT_EQ(orchard_broad_phase_first_on_segment(w, bad, one, nullptr, &hit), -1);
    EXPECT_EQ(orchard_broad_phase_all_hits(w, bad, one, 1, nullptr, nullptr, 0), ORCHARD_REFUSED);
    EXPECT_EQ(orchard_broad_phase_all_on_segment(w, one, bad, nullptr, nullptr, 0), ORCHARD_REFUSED);
    EXPECT_EQ(orchard_broad_phase_touching_sphere(w, zero, -1, nullptr, nullptr, 0), ORCHARD_REFUSED);
    EXPECT_EQ(orchard_broad_phase_touching_box(w, one, zero, nullptr, nullptr, 0), ORCHARD_REFUSED);
    EXPECT_EQ(orchard_broad_phase_nearest(w, bad, 0, nullptr, nullptr), ORCHARD_REFUSED);
  }
  EXPECT_EQ(orchard_broad_phase_touching_sphere(still.get(), zero, 1, nullptr, nullptr, 0), 1u);
  EXPECT_EQ(orchard_broad_phase_first_hit(still.get(), zero, one, 1, nullptr, nullptr), 1);
}

// The k-th allocation fails, for every k: every function says so, and the broad phase stays right or refuses all.
TEST(CBroadPhase, LetsNoExceptionOut) {
  int kept = 0, lost = 0;
  for (std::size_t failing = 1;; ++failing) {
    std::vector<orchard_motion> values(260, orchard_default_motion());
    for (std::size_t i = 0; i < values.size(); ++i) values[i].position[0] = static_cast<double>(i);
    for (orchard_motion& motion : values) motion.radius = 0.6;
    const orchard_broad_phase_options options = orchard_default_broad_phase();
    test::failing_allocation = test::allocations + failing;
    const World world = made(from_values, &values, options);
    bool failed = world == nullptr;
    std::uint32_t added = 0;
    while (world && added < values.size()) {
      const bool there = orchard_broad_phase_add(world.get(), 0, nullptr).index != ORCHARD_NO_BODY;
      added += there;
      failed = failed || !there;
      if (added % 50 != 49 || !there) continue;
      const orchard_body body = orchard_broad_phase_body(world.get(), added - 1);
      const orchard_body_filter filter{2, 0xffffffffu, 0, false};
      for (int tries = 0; tries < 2 && orchard_broad_phase_set_filter(world.get(), body, &filter) == 0; ++tries) {
        failed = true;
      }
    }
    const orchard_advance now = world ? orchard_broad_phase_advance(world.get(), 0, nullptr, 0) : orchard_advance{};
    const double p[3] = {10, 0, 0};
    const size_t touching =
        world ? orchard_broad_phase_touching_sphere(world.get(), p, 2, nullptr, nullptr, 0) : ORCHARD_REFUSED;
    const bool out = test::allocations >= test::failing_allocation;
    test::failing_allocation = 0;
    if (now.out_of_memory) {
      ++lost;
      EXPECT_EQ(orchard_broad_phase_valid(world.get()), 0);
      EXPECT_TRUE(orchard_broad_phase_advance(world.get(), kStep, nullptr, 0).time_refused);
    } else if (world) {
      kept += failed;
      EXPECT_EQ(now.pair_count, values.size() - 1);
      EXPECT_TRUE(touching == 5 || out);
      EXPECT_EQ(orchard_broad_phase_touching_sphere(world.get(), p, 2, nullptr, nullptr, 0), 5u);
    }
    if (!out) break;
  }
  EXPECT_GT(kept, 10);
  EXPECT_GT(lost, 10);
}

}  // namespace
