#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <set>

#include "detector/simple_pair.h"
#include "runtime/numbers.h"
#include "scene_run.h"
#include "support.h"
#include "support/effort.h"

// What a detector remembers of pairs that are apart, and round shapes against boxes.
namespace orchard::runtime {
namespace {

using test::kStep;

struct Actor {
  std::vector<BodyPart> parts;
  bool is_static = false;
  Pose pose;
  BodyId id;
};

// Bodies of all shapes that are moved a little at most steps, and in every other way at some.
class Crowd {
 public:
  explicit Crowd(std::uint64_t seed) : draw_(seed) {
    main_ = make(states_, 0);
    for (std::size_t i = 0; i < 20; ++i) {
      Actor actor;
      actor.is_static = i % 7 == 3;
      const std::size_t parts = i % 5 == 4 ? 2 : 1;
      for (std::size_t k = 0; k < parts; ++k) {
        actor.parts.push_back({static_cast<ShapeId>((i + k) % 5), k == 0 && i % 3 != 0 ? Pose{} : draw_.pose(0.7)});
      }
      actor.pose = draw_.pose(draw_.uniform(0, 4));
      actors_.push_back(actor);
      add(*main_, states_, actors_.back());
    }
  }

  void invalidate() {
    for (Actor& actor : actors_) {
      const double luck = draw_.uniform(0, 1);
      if (luck < 0.01) return_to_start(actor);
      if (actor.is_static) {
        if (luck > 0.02 && luck < 0.06) actor.pose = nudged(actor.pose, 0.3), main_->move_static(actor.id, actor.pose);
      } else {
        if (luck > 0.98) main_->teleport(actor.id);
        actor.pose = luck > 0.96 ? draw_.pose(draw_.uniform(0, 4)) : nudged(actor.pose, 0.02);
        if (luck > 0.9 && luck < 0.92) actor.pose.scale = draw_.uniform(0.6, 1.4);
      }
      if (luck > 0.5 && luck < 0.53) {
        const std::size_t part = actor.parts.size() - 1;
        actor.parts[part].local = nudged(actor.parts[part].local, luck < 0.51 ? 0.5 : 0.05);
        main_->set_local(actor.id, part, actor.parts[part].local);
      }
      states_[actor.id.index].pose = actor.pose;
    }
  }

  // By number, those that touch; planes are numbered from 100.
  using Pairs = std::set<std::pair<std::size_t, std::size_t>>;
  Pairs touching(int step, std::uint64_t& work) {
    for (Actor& actor : actors_) states_[actor.id.index].pose = actor.pose;
    return touching_of(*main_, step, actors_, work);
  }
  Pairs touching_without_memory(int step, std::uint64_t& work) {
    std::vector<BodyState> states = std::vector<BodyState>(64);
    const auto fresh = make(states, step * kStep);
    std::vector<Actor> actors = actors_;
    for (Actor& actor : actors) add(*fresh, states, actor);
    return touching_of(*fresh, step, actors, work);
  }

 private:
  std::unique_ptr<Detector> make(std::vector<BodyState>& states, double start) {
    for (BodyState& state : states) state.expiry = 0;
    auto detector = std::make_unique<Detector>(states_of(states),
                                               DetectorOptions{.time_step = kStep, .start = start, .watch = false});
    detector->add_shape(torus_);
    detector->add_shape(spikes_);
    detector->add_box({0.6, 0.5, 0.4});
    detector->add_capsule({-0.6, 0, 0}, {0.6, 0, 0}, 0.4);
    detector->add_sphere(0.8, {0.1, 0, 0});
    plane_ = detector->add_half_space({0, 0, 1}, -2);
    return detector;
  }
  static void add(Detector& detector, std::vector<BodyState>& states, Actor& actor) {
    actor.id = actor.is_static ? detector.add_static(actor.parts, actor.pose) : detector.add_body(actor.parts);
    states[actor.id.index].pose = actor.pose;
  }
  void return_to_start(Actor& actor) {
    main_->remove(actor.id);
    actor.pose = draw_.pose(draw_.uniform(0, 4));
    add(*main_, states_, actor);
  }
  Pose nudged(const Pose& pose, double by) {
    Pose result = pose;
    const Vec3 axis = Vec3(draw_.direction());
    const double half = draw_.uniform(-by, by) / 2, s = std::sin(half);
    const Pose turn = *pose_from_quaternion({std::cos(half), s * axis[0], s * axis[1], s * axis[2]}, {});
    result = compose(result, turn);
    result = made_rigid(result).value_or(pose);
    result.translation = Vec3(pose.translation) + draw_.uniform(0, by) * Vec3(draw_.direction());
    return result;
  }
  Pairs touching_of(Detector& detector, int step, const std::vector<Actor>& actors, std::uint64_t& work) const {
    const auto number = [&](BodyId id) {
      for (std::size_t i = 0; i < actors.size(); ++i) {
        if (actors[i].id == id) return i;
      }
      EXPECT_EQ(id, plane_);
      return std::size_t{100};
    };
    Pairs pairs;
    const Frame frame = detector.step(step * kStep);
    work += frame.work;
    EXPECT_EQ(frame.certain, frame.pairs);
    for (const PairEvent& event : frame.events) {
      if (event.change != PairChange::end) pairs.insert(std::minmax(number(event.a), number(event.b)));
    }
    return pairs;
  }

  test::Draw draw_;
  PackedSphereTree torus_ = test::build_tree(test::torus(12, 6, 0.75, 0.25));
  PackedSphereTree spikes_ = test::build_tree(test::scaled(test::spikes(5, 9, 7), 0.7));
  std::vector<BodyState> states_ = std::vector<BodyState>(64);
  std::unique_ptr<Detector> main_;
  std::vector<Actor> actors_;
  BodyId plane_;
};

// Against detectors that have just been made, which remember nothing.
TEST(Clearances, HideNoContactAndInventNone) {
  std::uint64_t work = 0, without = 0;
  std::size_t touches = 0;
  for (std::uint64_t seed = 0; seed < 6 * orchard::test::more(); ++seed) {
    Crowd crowd(orchard::test::first_seed() + seed);
    for (int step = 0; step < 100; ++step) {
      if (step > 0) crowd.invalidate();
      const Crowd::Pairs found = crowd.touching(step, work);
      touches += found.size();
      ASSERT_EQ(found, crowd.touching_without_memory(step, without)) << "seed " << seed << ", step " << step;
    }
  }
  EXPECT_GT(touches, 1000u);
  EXPECT_LT(static_cast<double>(work), 0.8 * static_cast<double>(without));
}

// Rings above each other, flat and nearer than their motion of a few steps, slide by: along the direction in which they
// are apart nothing moves.
TEST(Clearances, LastWhileBodiesSlideAlongEachOther) {
  const PackedSphereTree ring = test::build_tree(test::torus(12, 6, 0.75, 0.25));
  std::vector<BodyState> states(2);
  Detector detector(states_of(states), {.time_step = kStep, .watch = false});
  const ShapeId shape = detector.add_shape(ring);
  for (BodyState& state : states) state.expiry = 0;
  const BodyId lower = detector.add_body({{shape, {}}}), upper = detector.add_body({{shape, {}}});
  constexpr int kSteps = 30;
  int searched = 0;
  for (int step = 0; step < kSteps; ++step) {
    states[upper.index].pose.translation = {0.03 * step, 0.01 * step, 0.6};
    const Frame frame = detector.step(step * kStep);
    ASSERT_EQ(frame.pairs, 1u) << step;
    ASSERT_EQ(frame.certain, 1u) << step;
    ASSERT_TRUE(frame.events.empty()) << step;
    searched += frame.work > frame.motions_asked * kMotionWork;
  }
  EXPECT_EQ(searched, 1);
  states[upper.index].pose.translation[2] = 0.3;
  const Frame frame = detector.step(kSteps * kStep);
  ASSERT_EQ(frame.events.size(), 1u);
  EXPECT_EQ(frame.events[0].change, PairChange::begin);
  EXPECT_EQ(frame.events[0].a, lower);
}

// By bisection: the distance of a point on the segment from the box is convex.
TEST(RoundAgainstBox, TouchesWhereTheSegmentComesNearEnough) {
  std::size_t near = 0;
  for (std::uint64_t seed = 0; seed < 20000 * orchard::test::more(); ++seed) {
    test::Draw draw(orchard::test::first_seed() + seed);
    detail::ShapeTable shapes;
    const auto side = [&] { return seed % 11 == 0 ? 0.0 : draw.uniform(0.1, 1); };
    const Vec3 half = {side(), side(), draw.uniform(0.1, 1)};
    const Vec3 p = draw.uniform(0, 1) * Vec3(draw.direction());
    const Vec3 q = seed % 3 == 0 ? p : draw.uniform(0, 1) * Vec3(draw.direction());
    const double radius = draw.uniform(0, 0.5);
    const detail::Shape& box = shapes[shapes.add_box(half)];
    const detail::Shape& round = shapes[shapes.add_round(p, q, radius)];
    Pose at = draw.pose(draw.uniform(0, 3)), of_box = draw.pose(draw.uniform(0, 0.5));
    of_box.scale = draw.uniform(0.5, 2);
    const Verdict verdict = detail::test_simple(box, of_box, round, at);

    const Pose back = inverse(of_box);
    const Vec3 from = transform(back, transform(at, p)), to = transform(back, transform(at, q));
    const auto beyond = [&](double t) {
      double square = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const double x = from[i] + t * (to[i] - from[i]);
        square += std::pow(std::max(0.0, std::fabs(x) - box.p[i]), 2);
      }
      return std::sqrt(square) * of_box.scale;
    };
    double low = 0, high = 1;
    for (int i = 0; i < 200; ++i) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      (beyond(a) > beyond(b) ? low : high) = beyond(a) > beyond(b) ? a : b;
    }
    const double distance = std::min({beyond(0), beyond(1), beyond(low), beyond(high)});
    near += std::fabs(distance - radius) < 0.1;
    if (std::fabs(distance - radius) < 1e-7) continue;
    ASSERT_EQ(verdict.answer, distance < radius ? Answer::yes : Answer::no) << seed << ": " << distance - radius;
    if (verdict.answer == Answer::no) {
      ASSERT_NEAR(verdict.lower_bound, distance - radius, 1e-7) << seed;
      continue;
    }
    const Vec3 place = transform(back, verdict.contact.center);
    for (std::size_t i = 0; i < 3; ++i) ASSERT_LE(std::fabs(place[i]), box.p[i] + 1e-9) << seed;
    const Vec3 way = to - from;
    const double square = dot(way, way);
    const double t = square > 0 ? std::clamp(dot(place - from, way) / square, 0.0, 1.0) : 0;
    const Vec3 off = place - from - t * way;
    ASSERT_LE(std::sqrt(dot(off, off)) * of_box.scale, radius + 1e-7) << seed;
    const Vec3 normal = verdict.contact.normal;
    ASSERT_NEAR(dot(normal, normal), 1, 1e-9) << seed;
  }
  EXPECT_GT(near, 1000u);
}

}  // namespace
}  // namespace orchard::runtime
