// Sweeps beside dense sampling, all in the same few scenes: hence more than 300 lines.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "orchard/runtime/detector.h"
#include "support.h"
#include "support/effort.h"

// What bodies meet between two steps, against dense sampling of the way by brute force, and against closed forms.
namespace orchard::runtime {
namespace {

constexpr double kSweepStep = 0.02;

// A surface, which is solid if it is a box's, or a segment with a radius around it.
struct Form {
  PackedSphereTree tree;
  Vec3 half{};  // of a box
  Vec3 p{}, q{};
  double radius = 0;
  enum class Kind { tree, box, round } kind = Kind::tree;

  Vec3 center() const {
    if (kind != Kind::tree) return 0.5 * (p + q);
    const SiblingBlock& root = tree.blocks[0];
    return {double{root.x[0]}, double{root.y[0]}, double{root.z[0]}};
  }
  ShapeId add_to(Detector& detector) const {
    return kind == Kind::tree  ? detector.add_shape(tree)
           : kind == Kind::box ? detector.add_box(half)
                               : detector.add_capsule(p, q, radius);
  }
  std::vector<test::Triangle> placed(const Pose& pose) const {
    if (kind != Kind::round) return test::placed_triangles(tree, pose);
    const auto at = [&](const Vec3& v) {
      const auto w = transform(pose, v);
      return std::array<long double, 3>{w[0], w[1], w[2]};
    };
    return {{at(p), at(q), at(q)}};
  }
};

Form tree_of(const test::Mesh& mesh) {
  Form form;
  form.tree = test::build_tree(mesh);
  return form;
}

Form box_of(Vec3 half) {
  for (double& h : half) h = double{static_cast<float>(h)};  // as trees store it
  Form form;
  form.kind = Form::Kind::box;
  form.half = half;
  form.tree = test::build_tree(test::box(-1.0 * half, half));
  return form;
}

Form round_of(const Vec3& p, const Vec3& q, double radius) {
  Form form;
  form.kind = Form::Kind::round;
  form.p = p, form.q = q, form.radius = radius;
  return form;
}

std::vector<Form> forms() {
  std::vector<Form> all;
  all.push_back(tree_of(test::box({-1, -1, -1e-4}, {1, 1, 1e-4})));  // a thin plate
  all.push_back(tree_of(test::box({-1.2, -0.05, -0.05}, {1.2, 0.05, 0.05})));
  all.push_back(tree_of(test::spikes(3, 6, 4)));
  all.push_back(tree_of(test::torus(6, 4, 1, 0.3)));
  all.push_back(box_of({0.5, 0.7, 0.3}));
  all.push_back(box_of({1, 0.8, 1e-6}));
  all.push_back(round_of({}, {}, 0.2));
  all.push_back(round_of({-0.5, 0, 0.1}, {0.6, 0.2, 0}, 0.1));
  all.push_back(round_of({}, {}, 0));
  return all;
}

bool inside(const Form& box, const Pose& pose, const std::vector<test::Triangle>& other) {
  if (box.kind != Form::Kind::box) return false;
  const Pose back = inverse(pose);
  const auto& v = other[0][0];
  const Vec3 at = transform(back, {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])});
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::fabs(at[i]) > box.half[i]) return false;
  }
  return true;
}

// At most 0: they touch.
long double apart(const Form& a, const Pose& pose_a, const Form& b, const Pose& pose_b) {
  const auto p = a.placed(pose_a), q = b.placed(pose_b);
  if (inside(a, pose_a, q) || inside(b, pose_b, p)) return 0;
  const long double radii =
      static_cast<long double>(a.radius * pose_a.scale) + static_cast<long double>(b.radius * pose_b.scale);
  if (radii > 0) return test::surface_distance(p, q) - radii;
  return test::surfaces_intersect(p, q) ? 0 : test::surface_distance(p, q);
}

// The centre straight, the rotation at a constant speed.
struct Way {
  Pose start;
  Vec3 center{}, velocity{}, axis{0, 0, 1};
  double angle = 0;

  Pose at(double time) const {
    const double s = std::sin(time * angle), h = std::sin(time * angle / 2), c = 2 * h * h;
    Pose pose = start;
    for (std::size_t column = 0; column < 3; ++column) {
      const Vec3 v = {start.rotation[column], start.rotation[3 + column], start.rotation[6 + column]};
      const Vec3 kv = {axis[1] * v[2] - axis[2] * v[1], axis[2] * v[0] - axis[0] * v[2],
                       axis[0] * v[1] - axis[1] * v[0]};
      const Vec3 kkv = {axis[1] * kv[2] - axis[2] * kv[1], axis[2] * kv[0] - axis[0] * kv[2],
                        axis[0] * kv[1] - axis[1] * kv[0]};
      const Vec3 w = v + s * kv + c * kkv;
      for (std::size_t row = 0; row < 3; ++row) pose.rotation[3 * row + column] = w[row];
    }
    const Vec3 place = Vec3(transform(start, center)) + time * velocity, arm = rotate(pose, center);
    pose.translation = place - pose.scale * arm;
    return made_rigid(pose).value_or(pose);
  }
};

struct Met {
  bool possible = false, touched = false;
  double from = 2, to = 2;  // of the way
};

// What the detector says of the step from 0 to 1.
Met sweep(const Form& a, const Way& way_a, const Form& b, const Way& way_b, const Budget& budget = {}) {
  std::vector<BodyState> states(2);
  for (BodyState& state : states) state.expiry = 0;
  Detector detector(states_of(states), {.time_step = kSweepStep, .watch = false});
  const double speed = 1.01 *
                       (length(way_a.velocity) + length(way_b.velocity) + way_a.angle * length(way_a.center) * 4 +
                        way_b.angle * length(way_b.center) * 4) /
                       kSweepStep;
  const BodyId first = detector.add_body({{a.add_to(detector), {}}}, {.continuous_speed = speed});
  const BodyId second = detector.add_body({{b.add_to(detector), {}}});
  Met met;
  for (int step = 0; step < 2; ++step) {
    states[first.index].pose = way_a.at(step), states[second.index].pose = way_b.at(step);
    const Frame frame = detector.step(step * kSweepStep, step == 0 ? Budget{} : budget);
    if (step == 0) continue;
    for (const PairEvent& event : frame.events) {
      if (event.change == PairChange::end) continue;
      met.possible = event.verdict.answer == Answer::maybe;
      met.touched = event.verdict.answer == Answer::yes;
      met.from = event.impact_from / kSweepStep, met.to = event.impact_to / kSweepStep;
    }
  }
  return met;
}

// Judges by samples of the way; returns whether they see a contact.
bool judge(const Form& a, const Way& way_a, const Form& b, const Way& way_b, const Met& met, int samples,
           std::uint64_t seed) {
  std::optional<double> first;
  for (int i = 0; i <= samples && !first; ++i) {
    const double time = double(i) / samples;
    if (apart(a, way_a.at(time), b, way_b.at(time)) <= 0) first = time;
  }
  if (first) {
    EXPECT_TRUE(met.touched || met.possible) << "tunnels: " << seed;
    // NaN: a contact at the end only, that the sweep has not seen.
    EXPECT_TRUE(met.from <= *first + 1e-9 || *first == 1) << seed << ": " << met.from << " " << *first;
  }
  if (met.touched && std::isfinite(met.to)) {
    EXPECT_LE(met.from, met.to + 1e-12) << seed;
    EXPECT_LE(apart(a, way_a.at(met.to), b, way_b.at(met.to)), 1e-9L) << seed;
    if (met.from > 1e-9) {
      EXPECT_GT(apart(a, way_a.at(met.from - 1e-9), b, way_b.at(met.from - 1e-9)), 0) << seed;
    }
  }
  return first.has_value();
}

TEST(Sweeps, MissNothingThatSamplingSees) {
  const std::vector<Form> all = forms();
  int touched = 0, apart_all_the_way = 0, possible = 0, started = 0, tight = 0;
  const std::uint64_t first = orchard::test::first_seed(), more = orchard::test::more();
  for (std::uint64_t seed = first; seed < first + 120 * more; ++seed) {
    test::Draw draw(seed);
    const Form &a = all[draw.bits() % all.size()], &b = all[draw.bits() % all.size()];
    const bool fast = seed % 3 == 0, spin = seed % 4 == 1, in_contact = seed % 7 == 2;
    const auto way_of = [&](const Form& form, double far) {
      Way way;
      way.start = draw.pose(0);
      way.start.scale = seed % 5 == 0 ? draw.uniform(0.5, 1.5) : 1;
      way.center = form.center();
      const Vec3 place = far * Vec3(draw.direction()), now = transform(way.start, way.center);
      way.start.translation = Vec3(way.start.translation) + place - now;
      way.axis = draw.direction();
      way.angle = spin ? draw.uniform(2, 3.1) : draw.uniform(0, 1);
      // Towards where the other one is, past it, and out again if it is fast.
      way.velocity = (fast ? -draw.uniform(1.5, 30) : -draw.uniform(0, 2)) * place + 0.3 * Vec3(draw.direction());
      return way;
    };
    const Way way_a = way_of(a, 0), way_b = way_of(b, in_contact ? draw.uniform(0, 0.3) : draw.uniform(0.8, 3));
    const Met met = sweep(a, way_a, b, way_b);
    const bool seen = judge(a, way_a, b, way_b, met, 80, seed);
    // A point is on a surface for no time at all.
    possible += met.possible && &a != &all.back() && &b != &all.back();
    touched += met.touched, started += met.touched && met.to <= 0;
    apart_all_the_way += !met.touched && !met.possible;
    tight += met.touched && met.to - met.from < 1e-3;
    EXPECT_TRUE(!met.possible || seen || met.from < 1) << seed;
  }
  EXPECT_GT(touched, 40 * static_cast<int>(more));
  EXPECT_GT(tight, touched * 9 / 10);
  EXPECT_GT(started, 3);
  EXPECT_GT(apart_all_the_way, 15);
  EXPECT_LE(possible, static_cast<int>(1 + 2 * more));
}

// Two balls that pass each other with a hair between, or not: known in closed form.
TEST(Sweeps, TellGrazingBallsApart) {
  const std::uint64_t first = orchard::test::first_seed();
  for (std::uint64_t seed = first; seed < first + 60 * orchard::test::more(); ++seed) {
    test::Draw draw(seed);
    const double p = draw.uniform(0.1, 1), q = draw.uniform(0.1, 1), speed = draw.uniform(4, 1e4);
    const double hair = std::pow(10, -draw.uniform(2, 8)) * (seed % 2 == 0 ? 1 : -1), pass = p + q + hair;
    Way still, past;
    past.start.translation = {-speed / 2, pass, 0};
    past.velocity = {speed, 0, 0};
    const Met met = sweep(round_of({}, {}, p), past, round_of({}, {}, q), still);
    if (hair > 1e-4) {
      EXPECT_FALSE(met.touched || met.possible) << seed;
    }
    if (hair > 0) {
      EXPECT_FALSE(met.touched) << seed;
      continue;
    }
    EXPECT_TRUE(met.touched || (met.possible && hair > -1e-5)) << seed << " " << hair;
    const double half = std::sqrt((p + q) * (p + q) - pass * pass) / speed;
    EXPECT_LE(met.from, 0.5 - half + 1e-9) << seed;
    if (met.touched) {
      EXPECT_GE(met.to, 0.5 - half - 1e-9) << seed;
      EXPECT_LE(met.to, 0.5 + half + 1e-9) << seed;
    }
  }
}

// A box that spins on its way through a plane, against the lowest of its corners.
TEST(Sweeps, FindTheFirstCornerOnAHalfSpace) {
  const Vec3 half = {0.5, 0.3, 0.2};
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    test::Draw draw(seed);
    Way way;
    way.start = draw.pose(0);
    way.start.translation = {0, 0, draw.uniform(0.7, 3)};
    way.velocity = {draw.uniform(-3, 3), draw.uniform(-3, 3), draw.uniform(-6, 1)};
    way.axis = draw.direction();
    way.angle = draw.uniform(0, 3);
    const auto height = [&](double time) {
      double least = 1e300;
      for (unsigned corner = 0; corner < 8; ++corner) {
        const Vec3 v = {corner & 1 ? half[0] : -half[0], corner & 2 ? half[1] : -half[1],
                        corner & 4 ? half[2] : -half[2]};
        least = std::min(least, transform(way.at(time), v)[2]);
      }
      return least;
    };
    double first = 2;
    for (int i = 0; i <= 20'000 && first > 1; ++i) first = height(i / 20'000.0) <= 0 ? i / 20'000.0 : 2;
    std::vector<BodyState> states(1);
    states[0].expiry = 0;
    Detector detector(states_of(states), {.time_step = kSweepStep, .watch = false});
    detector.add_body({{detector.add_box(half), {}}}, {.continuous_speed = 1e3});
    detector.add_half_space({0, 0, 1}, 0);
    states[0].pose = way.at(0);
    detector.step(0);
    states[0].pose = way.at(1);
    const Frame frame = detector.step(kSweepStep);
    ASSERT_EQ(frame.events.empty(), first > 1) << seed;
    if (frame.events.empty()) continue;
    EXPECT_EQ(frame.events[0].verdict.answer, Answer::yes) << seed;
    EXPECT_NEAR(frame.events[0].impact_from / kSweepStep, first, 1e-4) << seed;
    EXPECT_LE(frame.events[0].impact_from / kSweepStep, first) << seed;
    EXPECT_GE(frame.events[0].impact_to / kSweepStep, first - 1e-4) << seed;
  }
}

// Whatever the budget, nothing that touches on the way is "no", and the bracket holds.
TEST(Sweeps, TellNothingWrongWithinABudget) {
  const std::vector<Form> all = forms();
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    test::Draw draw(seed);
    const Form &a = all[draw.bits() % all.size()], &b = all[draw.bits() % all.size()];
    Way still, past;
    still.center = a.center(), past.center = b.center();
    still.start = draw.pose(0);
    past.start = draw.pose(0);
    past.start.translation = {2.5, 0.1, -0.1};
    past.velocity = {-5, 0, 0};
    past.axis = draw.direction(), past.angle = 1;
    for (const std::uint64_t work : {50u, 200u, 1000u, 5000u}) {
      judge(a, still, b, past, sweep(a, still, b, past, {.work = work}), 60, seed);
    }
  }
}

// Where the budget has not sufficed to ask where bodies are, no body that flies on is said to have met nothing.
TEST(Sweeps, AreNotSilentAboutWhatAnInterruptedStepHasNotSeen) {
  const PackedSphereTree wall = test::build_tree(test::box({-5, -5, -0.001}, {5, 5, 0.001}));
  std::vector<BodyState> states(101);
  for (BodyState& state : states) state.expiry = 0;
  Detector detector(states_of(states), {.time_step = kSweepStep, .watch = false});
  const BodyId id = detector.add_static({{detector.add_shape(wall), {}}}, {});
  const ShapeId ball = detector.add_sphere(0.01);
  for (int i = 0; i < 100; ++i) detector.add_body({{ball, {}}}, {.continuous_speed = 110});
  for (int step = 0; step < 3; ++step) {
    for (std::size_t i = 0; i < states.size(); ++i) {
      states[i].pose.translation = {0.08 * double(i) - 4, 0, step < 2 ? 1.0 : -1.0};
    }
    const Frame frame = detector.step(step * kSweepStep, {.work = step < 2 ? 1 : Budget{}.work});
    if (step < 2) {
      EXPECT_NE(frame.unfinished.incomplete_from, kNoClass);
      continue;
    }
    std::size_t told = 0;
    for (const PairEvent& event : frame.events) {
      told += (event.a == id || event.b == id) && event.verdict.answer != Answer::no;
    }
    EXPECT_EQ(told, 100u);
  }
}

// The step on which a body is put to sleep leads somewhere, too; and it does not move after that.
TEST(Sweeps, SeeTheLastStepBeforeSleep) {
  const PackedSphereTree wall = test::build_tree(test::box({-5, -5, -0.001}, {5, 5, 0.001}));
  std::vector<BodyState> states(2);
  for (BodyState& state : states) state.expiry = 0;
  Detector detector(states_of(states), {.time_step = kSweepStep, .watch = false});
  detector.add_static({{detector.add_shape(wall), {}}}, {});
  const BodyId bullet = detector.add_body({{detector.add_sphere(0.01), {}}}, {.continuous_speed = 200});
  states[bullet.index].pose.translation = {0, 0, 1};
  EXPECT_TRUE(detector.step(0).events.empty());
  states[bullet.index].pose.translation = {0, 0, -1};
  detector.sleep(bullet);
  const Frame frame = detector.step(kSweepStep);
  ASSERT_EQ(frame.events.size(), 1u);
  EXPECT_EQ(frame.events[0].change, PairChange::begin);
  EXPECT_NEAR(frame.events[0].impact_from, kSweepStep * (1 - 0.011) / 2, 1e-6);
  const Frame after = detector.step(2 * kSweepStep);
  ASSERT_EQ(after.events.size(), 1u);
  EXPECT_EQ(after.events[0].change, PairChange::end);
}

}  // namespace
}  // namespace orchard::runtime
