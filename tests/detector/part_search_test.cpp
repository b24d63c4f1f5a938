#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "detector/sphere_tree.h"
#include "orchard/runtime/detector.h"
#include "runtime/numbers.h"
#include "support.h"
#include "support/effort.h"

namespace orchard::runtime {
namespace {

using test::Draw;
using Touching = std::set<std::pair<std::size_t, std::size_t>>;

using test::kStep;

// Sizes from crumbs to what holds all others, some in one place, and some that may be anywhere.
detail::BoundingSphere drawn_sphere(Draw& draw) {
  if (draw.uniform(0, 1) < 0.01) return {};
  const bool coarse = draw.uniform(0, 1) < 0.2;
  Vec3 at = draw.uniform(0, 10) * Vec3(draw.direction());
  for (double& x : at) x = coarse ? std::round(x / 4) * 4 : x;
  return {at, std::exp(draw.uniform(-6, draw.uniform(0, 1) < 0.1 ? 2 : 0))};
}

// Whatever the leaves, those near a sphere have all that touch it, and few others.
TEST(SphereTree, FindsWhatAScanFinds) {
  std::size_t touching = 0, offered = 0, all = 0;
  const std::uint64_t first = orchard::test::first_seed(), count = 30 * orchard::test::more();
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    Draw draw(seed);
    const auto bodies = static_cast<BodyIndex>(std::exp(draw.uniform(0, seed % 10 == 0 ? 10 : 6)));
    std::vector<detail::BoundingSphere> spheres(bodies);
    detail::SphereTree tree;
    for (BodyIndex body = 0; body < bodies; ++body) tree.add(spheres[body] = drawn_sphere(draw), body, body % 3);
    tree.build(static_cast<std::uint32_t>(draw.uniform(1, 40)));
    ASSERT_EQ(tree.parts().size(), bodies);
    for (int round = 0; round < 20; ++round) {
      const Vec3 center = draw.uniform(0, 10) * Vec3(draw.direction());
      const double radius = std::exp(draw.uniform(-4, 1));
      std::set<BodyIndex> found;
      tree.walk([&](const Vec3& low, const Vec3& high) { return detail::square_to_box(low, high, center); },
                [&] { return radius * radius; },
                [&](std::uint32_t begin, std::uint32_t end) {
                  for (std::uint32_t i = begin; i < end; ++i) {
                    EXPECT_EQ(tree.parts()[i].part, tree.parts()[i].body % 3);
                    EXPECT_TRUE(found.insert(tree.parts()[i].body).second) << seed;
                  }
                });
      all += bodies, offered += found.size();
      for (BodyIndex body = 0; body < bodies; ++body) {
        if (!(length(spheres[body].center - center) <= spheres[body].reach + radius)) continue;
        ++touching;
        EXPECT_TRUE(found.contains(body)) << seed << ' ' << body;
      }
    }
  }
  EXPECT_GT(touching, 1000u);
  EXPECT_LT(offered, all / 2);
}

// What a body is in the world, and who it is for the judge.
struct Thing {
  std::vector<BodyPart> parts;
  Pose pose;
  bool is_static = false;
  std::uint32_t group = 1, mask = ~0u;
  BodyId id = kNoBody;
};

std::vector<ShapeId> add_small_shapes(Detector& world) {
  static const PackedSphereTree beam = test::build_tree(test::box({0, -0.1, -0.1}, {2, 0.1, 0.1}));
  static const PackedSphereTree corner = test::build_tree(test::scaled(test::l_shape(), 0.3));
  return {world.add_shape(beam), world.add_shape(corner), world.add_capsule({0, 0, 0}, {2, 0.2, 0}, 0.1),
          world.add_box({0.4, 0.3, 0.2}), world.add_sphere(0.3)};
}

// Each part is a body of its own in a detector that knows nothing of any other step.
Touching judge(const std::vector<Thing>& things) {
  std::vector<BodyState> states;
  std::vector<std::size_t> owner;
  Detector own(states_of(states), {.time_step = kStep, .watch = false});
  add_small_shapes(own);
  for (std::size_t i = 0; i < things.size(); ++i) {
    if (things[i].id == kNoBody) continue;
    for (const BodyPart& part : things[i].parts) {
      const Pose pose = made_rigid(compose(things[i].pose, part.local)).value();
      const BodyId id = things[i].is_static ? own.add_static({{part.shape}}, pose) : own.add_body({{part.shape}});
      EXPECT_EQ(id.index, owner.size());
      owner.push_back(i);
      states.emplace_back().pose = pose;
    }
  }
  Touching result;
  for (const PairEvent& event : own.step(0).events) {
    const auto [a, b] = std::minmax(owner[event.a.index], owner[event.b.index]);
    EXPECT_NE(event.verdict.answer, Answer::maybe);
    if (a != b && event.verdict.answer == Answer::yes) result.insert({a, b});
  }
  return result;
}

// Arms among static bodies, of which they have many in reach, while all that can change does.
class Factory {
 public:
  Factory(std::uint64_t seed, bool watch, bool filters)
      : draw_(seed), filters_(filters), world_(states_of(states_), {.time_step = kStep, .watch = watch}) {
    states_.resize(1000);
    if (seed % 5 > 2) unit_ = std::pow(10, draw_.uniform(-3, 4));
    if (seed % 5 == 4) middle_ = unit_ * draw_.uniform(0, 1000) * Vec3(draw_.direction());
    shapes_ = add_small_shapes(world_);
    const auto arms = static_cast<std::size_t>(draw_.uniform(1, 4));
    for (std::size_t i = 0; i < arms; ++i) add_arm();
    for (int k = static_cast<int>(draw_.uniform(30, 350)); k > 0; --k) add_static();
    if (!filters_) return;
    world_.set_pair_filter([this](BodyId a, BodyId b) { return !excluded(a, b); });
  }

  void step(int step, const Budget& budget) {
    const double time = step * kStep;
    move_joints(time);
    if (step % 4 == 3) change();
    const Frame frame = world_.step(time, budget);
    pairs += frame.pairs;
    const Touching touch = judge(things_);
    Touching yes, named;
    for (const PairEvent& event : frame.events) {
      const auto pair = pair_of(event);
      if (event.change == PairChange::end) continue;
      named.insert(pair);
      if (event.verdict.answer == Answer::yes && std::isnan(event.impact_from)) yes.insert(pair);
      EXPECT_TRUE(allowed(pair));
    }
    for (const auto& pair : yes) EXPECT_TRUE(touch.contains(pair)) << step << ": " << pair.first << ' ' << pair.second;
    for (const auto& pair : touch) {
      if (!allowed(pair)) continue;
      ++touching;
      const bool told = named.contains(pair) && (budget.work < kWholeStep || yes.contains(pair) || any_bullet_);
      EXPECT_TRUE(told || frame.unfinished.incomplete_from != kNoClass)
          << step << ": " << pair.first << ' ' << pair.second;
    }
  }
  std::size_t touching = 0;
  std::uint64_t pairs = 0;

 private:
  // What is around 0 there is here.
  Pose placed(Pose pose) const {
    pose.translation = middle_ + unit_ * Vec3(pose.translation);
    pose.scale *= unit_;
    return pose;
  }
  void add(Thing thing) {
    BodyOptions options;
    if (filters_ && draw_.uniform(0, 1) < 0.3) thing.group = 2;
    options.filter = {.category = thing.group, .mask = thing.mask};
    thing.id =
        thing.is_static ? world_.add_static(thing.parts, thing.pose, options) : world_.add_body(thing.parts, options);
    ASSERT_NE(thing.id, kNoBody);
    if (!thing.is_static) states_[thing.id.index].pose = thing.pose;
    things_.push_back(thing);
  }
  ShapeId any_shape() { return shapes_[static_cast<std::size_t>(draw_.uniform(0, 5))]; }
  void add_arm() {
    Thing arm;
    arm.pose = placed(draw_.pose(draw_.uniform(0, 6)));
    for (int k = static_cast<int>(draw_.uniform(2, 5)); k > 0; --k) arm.parts.push_back({any_shape(), {}});
    for (BodyPart& part : arm.parts) part.local = draw_.pose(draw_.uniform(0, 5));
    add(arm);
  }
  Pose static_pose() {
    Pose pose = draw_.pose(draw_.uniform(0, 8));
    pose.scale = draw_.uniform(0, 1) < 0.05 ? 10 : draw_.uniform(0.2, 1.5);
    return placed(pose);
  }
  void add_static() {
    Thing thing;
    thing.is_static = true;
    thing.pose = static_pose();
    for (int k = draw_.uniform(0, 1) < 0.2 ? 3 : 1; k > 0; --k) thing.parts.push_back({any_shape(), {}});
    if (thing.parts.size() > 1) {
      for (BodyPart& part : thing.parts) part.local = draw_.pose(draw_.uniform(0, 3));
    }
    add(thing);
  }
  void move_joints(double time) {
    for (Thing& thing : things_) {
      if (thing.is_static || thing.id == kNoBody) continue;
      for (std::size_t k = 0; k < thing.parts.size(); ++k) {
        if (draw_.uniform(0, 1) < 0.3) continue;
        Pose& local = thing.parts[k].local;
        local = *made_rigid(compose(local, draw_.pose(0.1)));
        ASSERT_TRUE(world_.set_local(thing.id, k, local));
      }
      if (world_.asleep(thing.id)) continue;
      states_[thing.id.index].expiry = time;
      thing.pose.translation = Vec3(thing.pose.translation) + 0.05 * unit_ * Vec3(draw_.direction());
      states_[thing.id.index].pose = thing.pose;
    }
  }
  Thing& any_thing() {
    return things_[static_cast<std::size_t>(draw_.uniform(0, static_cast<double>(things_.size())))];
  }
  void change() {
    for (int k = static_cast<int>(draw_.uniform(0, 8)); k > 0; --k) {
      Thing& thing = any_thing();
      if (thing.id == kNoBody) continue;
      const auto what = static_cast<int>(draw_.uniform(0, 8));
      if (what == 0) {
        ASSERT_TRUE(world_.remove(thing.id));
        thing.id = kNoBody;
        thing.is_static ? add_static() : add_arm();
      } else if (what == 1 && filters_) {
        thing.group = draw_.uniform(0, 1) < 0.5 ? 1 : 2;
        thing.mask = draw_.uniform(0, 1) < 0.7 ? ~0u : 1;
        ASSERT_TRUE(world_.set_filter(thing.id, {.category = thing.group, .mask = thing.mask}));
      } else if (thing.is_static && what < 5) {
        thing.pose = static_pose();
        ASSERT_TRUE(world_.move_static(thing.id, thing.pose));
      } else if (thing.is_static) {
        const std::size_t part = thing.parts.size() - 1;
        thing.parts[part].local = draw_.pose(draw_.uniform(0, 3));
        ASSERT_TRUE(world_.set_local(thing.id, part, thing.parts[part].local));
      } else if (what < 4) {
        thing.pose = placed(draw_.pose(draw_.uniform(0, draw_.uniform(0, 1) < 0.2 ? 100 : 6)));
        states_[thing.id.index].pose = thing.pose;
        world_.wake(thing.id);
        ASSERT_TRUE(world_.teleport(thing.id));
      } else if (what == 4) {
        world_.asleep(thing.id) ? world_.wake(thing.id) : world_.sleep(thing.id);
      } else if (what == 5 && draw_.uniform(0, 1) < 0.1) {  // from here on no body is looked for by parts
        add_bullet();
      }
    }
  }
  void add_bullet() {
    Thing bullet;
    bullet.pose = placed(draw_.pose(5));
    bullet.parts = {{shapes_[4], {}}};
    BodyOptions options;
    options.continuous_speed = 100 * unit_;
    bullet.id = world_.add_body(bullet.parts, options);
    ASSERT_NE(bullet.id, kNoBody);
    states_[bullet.id.index].pose = bullet.pose;
    things_.push_back(bullet);
    any_bullet_ = true;
  }
  bool excluded(BodyId a, BodyId b) const { return (a.index + b.index) % 5 == 0; }
  bool allowed(const std::pair<std::size_t, std::size_t>& pair) const {
    const Thing &a = things_[pair.first], &b = things_[pair.second];
    if (a.is_static && b.is_static) return false;
    return (a.mask & b.group) != 0 && (b.mask & a.group) != 0 && !(filters_ && excluded(a.id, b.id));
  }
  std::pair<std::size_t, std::size_t> pair_of(const PairEvent& event) const {
    std::size_t a = things_.size(), b = a;
    for (std::size_t i = 0; i < things_.size(); ++i) {
      if (things_[i].id == event.a) a = i;
      if (things_[i].id == event.b) b = i;
    }
    return std::minmax(a, b);
  }

  Draw draw_;
  bool filters_, any_bullet_ = false;
  double unit_ = 1;
  Vec3 middle_{};
  std::vector<BodyState> states_;
  Detector world_;
  std::vector<ShapeId> shapes_;
  std::vector<Thing> things_;
};

TEST(PartSearch, TellsWhoTouchesAmongManyStaticBodiesWhileAllChanges) {
  std::size_t touching = 0;
  const std::uint64_t first = orchard::test::first_seed(), count = 32 * orchard::test::more();
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    SCOPED_TRACE(seed);
    Factory factory(seed, seed % 2 == 1, seed / 2 % 2 == 1);
    Budget budget;
    if (seed / 4 % 3 == 2) budget.work = 1 + seed * 7919 % 3000;
    for (int step = 0; step < 60 && !::testing::Test::HasFailure(); ++step) factory.step(step, budget);
    touching += factory.touching;
  }
  EXPECT_GT(touching, 100 * count);
}

// 400 static bodies in a ring that an arm can reach, which only its two ends are near.
struct Ring {
  std::vector<BodyState> states{1};
  Detector world{states_of(states), {.time_step = kStep, .watch = false}};
  BodyId arm;
  int steps = 0;
  static constexpr std::size_t kStatics = 400;

  explicit Ring(const BodyOptions& options = {}) {
    const ShapeId ball = world.add_sphere(0.1);
    const std::vector<BodyPart> hands = {{ball, Pose{.translation = {5, 0, 0}}},
                                         {ball, Pose{.translation = {-5, 0, 0}}}};
    arm = world.add_body(hands, options);
    for (std::size_t i = 0; i < kStatics; ++i) {
      const double angle = 2 * std::acos(-1.0) * static_cast<double>(i) / kStatics;
      EXPECT_NE(world.add_static({{ball}}, Pose{.translation = {5 * std::cos(angle), 5 * std::sin(angle), 0}}),
                kNoBody);
    }
  }
  Frame turn_to(double angle) {
    for (std::size_t k = 0; k < 2; ++k) {
      const double side = k == 0 ? 5 : -5;
      EXPECT_TRUE(world.set_local(arm, k, {.translation = {side * std::cos(angle), side * std::sin(angle), 0}}));
    }
    return world.step(kStep * steps++);
  }
};

TEST(PartSearch, LeavesOutWhatIsInReachAndNotNearAPart) {
  Ring ring;
  ring.turn_to(0);
  for (int k = 1; k < 50; ++k) {
    const Frame frame = ring.turn_to(0.1 * k);
    EXPECT_LE(frame.pairs, 12u) << k;
    EXPECT_GE(frame.events.size(), 4u) << k;
  }
}

// A sphere around all of a ring's hands that none of the ring is in any more is the broad phase's again.
TEST(PartSearch, EndsWhereFewAreInReach) {
  Ring ring;
  for (int k = 0; k < 40; ++k) ring.turn_to(0.1 * k);
  ring.states[0].pose.translation = {1000, 0, 0};
  ring.states[0].expiry = 1e9;
  ASSERT_TRUE(ring.world.teleport(ring.arm));
  Frame frame;
  for (int k = 0; k < 40; ++k) frame = ring.world.step(kStep * ring.steps++);
  EXPECT_EQ(frame.pairs, 0u);
  EXPECT_GT(frame.next_time, kStep * ring.steps + 1);  // nothing to do
  ring.states[0].pose.translation = {};
  ASSERT_TRUE(ring.world.teleport(ring.arm));
  for (int k = 0; k < 40; ++k) EXPECT_GE(ring.turn_to(0.1 * k).events.size(), 4u) << k;
}

TEST(PartSearch, KeepsPairsPossibleWhereAPoseIsNotValid) {
  Ring ring;
  std::size_t touching = 0;
  for (int k = 0; k < 20; ++k) touching = ring.turn_to(0).events.size();
  ring.states[0].pose.translation = {std::numeric_limits<double>::quiet_NaN(), 0, 0};
  const Frame frame = ring.turn_to(0);
  ASSERT_EQ(frame.refused.size(), 1u);
  EXPECT_EQ(frame.refused[0], ring.arm.index);
  std::size_t possible = 0;
  for (const PairEvent& event : frame.events) possible += event.verdict.answer == Answer::maybe;
  EXPECT_GE(possible, touching);
}

TEST(PartSearch, AllocatesNothingNewWhileNothingIsNew) {
  Ring ring;
  for (int k = 0; k < 1000; ++k) ring.turn_to(0.05 * (k % 100));
  const std::size_t before = ring.world.memory_bytes();
  for (int k = 0; k < 100; ++k) ring.turn_to(0.05 * k);
  EXPECT_EQ(ring.world.memory_bytes(), before);
}

}  // namespace
}  // namespace orchard::runtime
