#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "orchard/runtime/orchard_detector.h"
#include "orchard/runtime/tree_file.h"
#include "support.h"

namespace {

struct World {
  std::vector<orchard_body_state> states = std::vector<orchard_body_state>(16);
  orchard_detector* detector = nullptr;
  explicit World(orchard_detector_options options = orchard_default_detector()) {
    for (orchard_body_state& state : states) {
      std::memset(&state, 0, sizeof state);
      state.pose = orchard_identity();
    }
    detector = orchard_detector_new(&World::source, this, &options);
  }
  ~World() { orchard_detector_free(detector); }

  static void source(void* context, double, const uint32_t* bodies, size_t count, orchard_body_state* states) {
    for (size_t i = 0; i < count; ++i) states[i] = static_cast<World*>(context)->states[bodies[i]];
  }
  orchard_body add(orchard_shape shape) const {
    const orchard_part part = {shape, orchard_identity()};
    const orchard_body_options options = orchard_default_body();
    return orchard_detector_add_body(detector, &part, 1, &options);
  }
  void put(orchard_body body, double x) { states[body.index].pose.translation[0] = x; }
};

constexpr orchard_budget kNoLimit = {ORCHARD_NO_LIMIT, ORCHARD_NO_LIMIT};

int refuse(void* context, orchard_body, orchard_body) { return ++*static_cast<int*>(context), 0; }

void run_backwards(void*, size_t count, void (*job)(void*, size_t), void* data) {
  while (count > 0) job(data, --count);
}

TEST(CDetector, TellsWhatBeginsAndEnds) {
  orchard_detector_options options = orchard_default_detector();
  options.executor = {run_backwards, nullptr, 4};
  World w(options);
  const auto bytes =
      orchard::runtime::serialize(orchard::runtime::test::build_tree(orchard::runtime::test::torus(12, 6, 0.75, 0.25)));
  orchard_tree* const tree = orchard_tree_load(bytes.data(), bytes.size(), nullptr);
  const orchard_body a = w.add(orchard_detector_add_tree(w.detector, tree));
  const double center[3] = {0, 0, 0}, p[3] = {-1, 0, 0}, half[3] = {1, 1, 1}, normal[3] = {1, 0, 0};
  const orchard_body b = w.add(orchard_detector_add_sphere(w.detector, 0.5, center));
  const orchard_body c = w.add(orchard_detector_add_capsule(w.detector, p, center, 0.5));
  const orchard_body d = w.add(orchard_detector_add_box(w.detector, half));
  const orchard_body_options with = orchard_default_body();
  orchard_detector_add_half_space(w.detector, normal, -100, &with);
  EXPECT_EQ(orchard_detector_size(w.detector), 5u);
  w.put(a, 0), w.put(b, 10), w.put(c, 20), w.put(d, 30);
  for (orchard_body_state& state : w.states) state.expiry = 0;
  EXPECT_EQ(orchard_detector_step(w.detector, 0, kNoLimit).events, 0u);
  w.put(b, 1.4);
  w.put(d, -99.5);
  orchard_frame frame = orchard_detector_step(w.detector, 0.01, kNoLimit);
  ASSERT_EQ(frame.events, 2u);
  EXPECT_EQ(frame.counts.certain, frame.counts.pairs);
  const orchard_pair_event event = orchard_detector_event(w.detector, 0);
  EXPECT_EQ(event.change, ORCHARD_BEGIN);
  EXPECT_EQ(event.a.index, a.index);
  EXPECT_EQ(event.b.index, b.index);
  EXPECT_EQ(event.verdict.answer, ORCHARD_YES);
  EXPECT_NEAR(event.verdict.contact_center[0], 1, 0.01);
  EXPECT_TRUE(std::isnan(event.impact_from));
  const orchard_manifold manifold = orchard_detector_manifold(w.detector, 0);
  EXPECT_EQ(manifold.answer, ORCHARD_YES);
  ASSERT_GE(manifold.count, 1u);
  EXPECT_NEAR(std::fabs(manifold.normal[0]), 1, 0.1);
  EXPECT_GT(manifold.depth, 0);
  EXPECT_EQ(orchard_detector_event(w.detector, 0).a.index, a.index);  // events stay
  EXPECT_EQ(orchard_detector_event(w.detector, 1).a.index, d.index);
  orchard_step_load loads[4];
  EXPECT_EQ(orchard_detector_predict_load(w.detector, loads, 4), 4u);
  EXPECT_GT(loads[0].work, 0);
  EXPECT_EQ(orchard_detector_remove(w.detector, a), 1);
  EXPECT_EQ(orchard_detector_remove(w.detector, a), 0);
  frame = orchard_detector_step(w.detector, 0.02, kNoLimit);
  ASSERT_EQ(frame.events, 2u);
  EXPECT_EQ(orchard_detector_event(w.detector, 0).change, ORCHARD_END);
  EXPECT_EQ(orchard_detector_event(w.detector, 1).change, ORCHARD_STAY);
  orchard_tree_close(tree);
}

TEST(CDetector, HasTheOtherCallsToo) {
  orchard_detector_options options = orchard_default_detector();
  options.watch = 1;
  World w(options);
  const double center[3] = {0, 0, 0}, bad[3] = {NAN, 0, 0};
  EXPECT_EQ(orchard_detector_add_sphere(w.detector, -1, center), ORCHARD_NO_SHAPE);
  EXPECT_EQ(orchard_detector_add_box(w.detector, bad), ORCHARD_NO_SHAPE);
  const orchard_shape ball = orchard_detector_add_sphere(w.detector, 1, center);
  EXPECT_EQ(w.add(ball + 1).index, ORCHARD_NO_BODY);
  const orchard_body a = w.add(ball), b = w.add(ball);
  const orchard_part part = {ball, orchard_identity()};
  const orchard_body_options with = orchard_default_body();
  orchard_pose place = orchard_identity();
  place.translation[0] = 50;
  const orchard_body still = orchard_detector_add_static(w.detector, &part, 1, &place, &with);
  for (orchard_body_state& state : w.states) state.expiry = INFINITY;
  int asked = 0;
  EXPECT_EQ(orchard_detector_set_pair_filter(w.detector, refuse, &asked), 1);
  EXPECT_EQ(orchard_detector_step(w.detector, 0, kNoLimit).events, 0u);
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(orchard_detector_set_pair_filter(w.detector, nullptr, nullptr), 1);
  EXPECT_EQ(orchard_detector_step(w.detector, 0.01, kNoLimit).events, 1u);
  orchard_body_filter filter = orchard_default_filter();
  filter.category = filter.mask = 2;
  EXPECT_EQ(orchard_detector_set_filter(w.detector, a, &filter), 1);
  EXPECT_EQ(orchard_detector_step(w.detector, 0.02, kNoLimit).events, 1u);  // an end
  w.put(b, 49);                                                             // it had promised not to move
  const orchard_frame frame = orchard_detector_step(w.detector, 0.03, kNoLimit);
  ASSERT_EQ(frame.broken, 1u);
  EXPECT_EQ(orchard_detector_broken(w.detector, 0), b.index);
  EXPECT_EQ(orchard_detector_motion_bound_violations(w.detector), 1u);
  EXPECT_EQ(frame.events, 1u);
  w.states[a.index].pose.scale = -1;
  const orchard_frame next = orchard_detector_step(w.detector, 0.04, kNoLimit);
  (void)next;
  place.translation[0] = 500;
  EXPECT_EQ(orchard_detector_move_static(w.detector, still, &place), 1);
  EXPECT_EQ(orchard_detector_move_static(w.detector, a, &place), 0);
  EXPECT_EQ(orchard_detector_set_local(w.detector, b, 0, &place), 1);
  EXPECT_EQ(orchard_detector_set_local(w.detector, b, 1, &place), 0);
  EXPECT_EQ(orchard_detector_set_importance(w.detector, b, 3), 1);
  EXPECT_EQ(orchard_detector_teleport(w.detector, b), 1);
  EXPECT_EQ(orchard_detector_cancel(w.detector, b), 1);
  EXPECT_EQ(orchard_detector_sleep(w.detector, b), 1);
  EXPECT_EQ(orchard_detector_wake(w.detector, b), 1);
  EXPECT_EQ(orchard_detector_sleep(w.detector, still), 0);
  EXPECT_TRUE(orchard_detector_step(w.detector, NAN, kNoLimit).time_refused);
  const orchard_frame last = orchard_detector_step(w.detector, 0.05, {1000, 1'000'000'000});
  ASSERT_EQ(last.refused, 1u);
  EXPECT_EQ(orchard_detector_refused(w.detector, 0), a.index);
}

TEST(CDetector, KeepsStatesWhereThereIsNoSource) {
  const orchard_detector_options options = orchard_default_detector();
  orchard_detector* const detector = orchard_detector_new(nullptr, nullptr, &options);
  const char* error = nullptr;
  EXPECT_EQ(orchard_detector_load(detector, "no such file", &error), ORCHARD_NO_SHAPE);
  EXPECT_NE(error, nullptr);
  const double center[3] = {0, 0, 0};
  const orchard_part part = {orchard_detector_add_sphere(detector, 1, center), orchard_identity()};
  const orchard_body_options with = orchard_default_body();
  const orchard_body a = orchard_detector_add_body(detector, &part, 1, &with),
                     b = orchard_detector_add_body(detector, &part, 1, &with);
  orchard_pose place = orchard_identity();
  place.translation[1] = 50;
  const orchard_body still = orchard_detector_add_static(detector, &part, 1, &place, &with);
  orchard_body_state state = orchard_default_state();
  state.pose.translation[0] = 10;
  state.velocity[0] = -100;
  EXPECT_EQ(orchard_detector_set_state(detector, b, &state), 1);
  EXPECT_EQ(orchard_detector_set_state(detector, still, &state), 0);
  EXPECT_EQ(orchard_detector_step(detector, 0, kNoLimit).events, 0u);
  EXPECT_EQ(orchard_detector_step(detector, 0.07, kNoLimit).events, 0u);
  EXPECT_EQ(orchard_detector_step(detector, 0.09, kNoLimit).events, 2u);  // at 0.08 and at 0.09
  EXPECT_NEAR(orchard_detector_state(detector, b).pose.translation[0], 1, 1e-12);
  const double velocity[3] = {0, 100, 0};
  EXPECT_EQ(orchard_detector_set_velocity(detector, a, velocity), 1);
  EXPECT_EQ(orchard_detector_step(detector, 0.11, kNoLimit).events, 2u);  // stays, and ends
  EXPECT_EQ(orchard_detector_state(detector, a).velocity[1], 100);
  EXPECT_NEAR(orchard_detector_state(detector, b).pose.translation[0], -1, 1e-12);
  EXPECT_FALSE(orchard_default_state().turns_bounded);
  state.turns_bounded = true;
  state.angular_speed = 2;
  EXPECT_EQ(orchard_detector_set_state(detector, a, &state), 1);
  EXPECT_TRUE(orchard_detector_state(detector, a).turns_bounded);
  EXPECT_EQ(orchard_detector_state(detector, a).angular_speed, 2);
  state.angular_speed = -2;
  EXPECT_EQ(orchard_detector_set_state(detector, a, &state), 0);
  EXPECT_EQ(orchard_detector_moves(detector, a), 1);
  EXPECT_EQ(orchard_detector_moves(detector, still), 0);
  orchard_detector_free(detector);
}

TEST(CDetector, AnswersQuestionsAboutAllBodies) {
  orchard_detector* const world = orchard_detector_new(nullptr, nullptr, nullptr);
  ASSERT_NE(world, nullptr);
  const double origin_of_shape[3] = {0, 0, 0};
  const orchard_shape ball = orchard_detector_add_sphere(world, 1, origin_of_shape);
  orchard_part part{};
  part.shape = ball;
  part.local = orchard_identity();
  const orchard_body a = orchard_detector_add_body(world, &part, 1, nullptr);
  orchard_pose there = orchard_identity();
  there.translation[0] = 5;
  const orchard_body b = orchard_detector_add_static(world, &part, 1, &there, nullptr);
  const double origin[3] = {-4, 0, 0}, along[3] = {2, 0, 0}, point[3] = {2.4, 0, 0};
  orchard_world_point found{};
  ASSERT_EQ(orchard_detector_cast_ray(world, origin, along, 100, nullptr, &found), 1);
  EXPECT_EQ(found.body.index, a.index);
  EXPECT_NEAR(found.distance, 1.5, 1e-12);
  EXPECT_NEAR(found.point[0], -1, 1e-12);
  EXPECT_EQ(orchard_detector_cast_ray(world, origin, along, 1, nullptr, &found), 0);
  ASSERT_EQ(orchard_detector_nearest(world, point, 100, nullptr, &found), 1);
  EXPECT_EQ(found.body.index, a.index);
  EXPECT_NEAR(found.distance, 1.4, 1e-12);
  const orchard_query_filter none = {0, 0};
  EXPECT_EQ(orchard_detector_nearest(world, point, 100, &none, &found), 0);
  orchard_body touching[2];
  ASSERT_EQ(orchard_detector_touching_sphere(world, point, 1.61, nullptr, touching, 2), 2u);
  EXPECT_EQ(touching[1].index, b.index);
  EXPECT_EQ(orchard_detector_touching_sphere(world, point, 1.5, nullptr, nullptr, 0), 1u);
  orchard_detector_free(world);
}

}  // namespace
