#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "orchard/runtime/detector.h"
#include "runtime/numbers.h"
#include "support.h"
#include "support/effort.h"

// Rays, nearest points and overlaps among all bodies of a detector, against brute force over shapes and triangles.
namespace orchard::runtime {
namespace {

using test::kInfinity;

struct OracleShape {
  enum class Kind { tree, round, box } kind = Kind::tree;
  PackedSphereTree tree;
  Vec3 p{}, q{};  // of a box: half of its lengths in p
  double radius = 0;
  ShapeId id = kNoShape;
};

struct OracleBody {
  BodyId id;
  std::vector<std::size_t> shapes;
  std::vector<Pose> locals;
  BodyState state;
  bool is_static = false;
  std::uint32_t category = 1;
};

double distance(const OracleShape& shape, const Pose& pose, const Vec3& point) {
  if (shape.kind == OracleShape::Kind::tree) {
    long double least = std::numeric_limits<long double>::infinity();
    for (const test::Triangle& t : test::placed_triangles(shape.tree, pose)) {
      least = std::min(least, test::point_distance({point[0], point[1], point[2]}, t));
    }
    return static_cast<double>(least);
  }
  const Vec3 local = transform(inverse(pose), point);
  if (shape.kind == OracleShape::Kind::box) {
    Vec3 out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = std::max(0.0, std::fabs(local[i]) - shape.p[i]);
    return length(out) * pose.scale;
  }
  const Vec3 axis = shape.q - shape.p;
  const double square = dot(axis, axis);
  const double share = square > 0 ? std::clamp(dot(local - shape.p, axis) / square, 0.0, 1.0) : 0;
  return std::max(0.0, length(local - (shape.p + share * axis)) - shape.radius) * pose.scale;
}

class OracleWorld {
 public:
  OracleWorld(std::uint64_t seed, bool with_source) : draw_(seed), with_source_(with_source), values_(64) {
    world_ = with_source ? std::make_unique<Detector>(states_of(values_)) : std::make_unique<Detector>();
    make_shapes();
    for (int i = 0; i < 10; ++i) add_body(i % 4 == 3);
    half_ = world_->add_half_space({0, 0, 2}, -12);
  }

  void add_body(bool is_static) {
    OracleBody body;
    body.is_static = is_static;
    body.category = 1u << (bodies_.size() % 2);
    std::vector<BodyPart> parts;
    const std::size_t count = 1 + draw_.bits() % 2;
    for (std::size_t k = 0; k < count; ++k) {
      body.shapes.push_back(draw_.bits() % shapes_.size());
      body.locals.push_back(k == 0 ? Pose{} : draw_.pose(1));
      parts.push_back({shapes_[body.shapes[k]].id, body.locals[k]});
    }
    body.state.pose = draw_.pose(draw_.uniform(0, 5));
    body.state.velocity = is_static ? Vec3{} : 3.0 * Vec3(draw_.direction());
    const BodyOptions options{.filter = {.category = body.category}};
    if (is_static) {
      body.id = world_->add_static(parts, body.state.pose, options);
    } else {
      body.id = world_->add_body(parts, options);
      if (with_source_) values_[body.id.index] = body.state;
      if (!with_source_) {
        EXPECT_TRUE(world_->set_state(body.id, body.state));
      }
    }
    bodies_.push_back(body);
  }

  void remove_one() {
    ASSERT_TRUE(world_->remove(bodies_.back().id));
    bodies_.pop_back();
  }

  void step(double time) {
    for (OracleBody& body : bodies_) {
      body.state.pose.translation = Vec3(body.state.pose.translation) + (time - time_) * body.state.velocity;
      if (with_source_) values_[body.id.index] = body.state;
    }
    time_ = time;
    world_->step(time);
  }

  double distance_to(const OracleBody& body, const Vec3& point) const {
    double least = kInfinity;
    for (std::size_t k = 0; k < body.shapes.size(); ++k) {
      least = std::min(least, distance(shapes_[body.shapes[k]], compose(body.state.pose, body.locals[k]), point));
    }
    return least;
  }
  double height(const Vec3& point) const { return std::max(0.0, point[2] + 6); }
  double distance_to_all(const Vec3& point, std::uint32_t mask) const {
    double least = (mask & 1u) != 0 ? height(point) : kInfinity;
    for (const OracleBody& body : bodies_) {
      if ((body.category & mask) != 0) least = std::min(least, distance_to(body, point));
    }
    return least;
  }

  test::Draw draw_;
  bool with_source_;
  std::vector<BodyState> values_;
  std::unique_ptr<Detector> world_;
  std::vector<OracleShape> shapes_;
  std::vector<OracleBody> bodies_;
  BodyId half_;
  double time_ = 0;

 private:
  void make_shapes() {
    shapes_.resize(4);
    shapes_[0].tree = test::build_tree(test::torus(8, 5, 0.75, 0.25));
    shapes_[0].id = world_->add_shape(shapes_[0].tree);
    shapes_[1].kind = shapes_[2].kind = OracleShape::Kind::round;
    shapes_[1].radius = 0.6;
    shapes_[1].id = world_->add_sphere(0.6);
    shapes_[2].p = {-0.5, 0.1, 0}, shapes_[2].q = {0.7, 0, 0.2}, shapes_[2].radius = 0.3;
    shapes_[2].id = world_->add_capsule(shapes_[2].p, shapes_[2].q, 0.3);
    shapes_[3].kind = OracleShape::Kind::box;
    shapes_[3].p = {0.4, 0.9, 0.2};
    shapes_[3].id = world_->add_box(shapes_[3].p);
  }
};

// By going on as far as nothing can be, again and again. Nothing where a ray passes too near to tell.
struct Traced {
  bool told = true, hit = false;
  double along = 0;
};
Traced trace(const OracleWorld& world, const Ray& ray, std::uint32_t mask) {
  const double speed = length(ray.direction);
  double least = kInfinity;
  Traced result;
  for (int i = 0; i < 400 && result.along <= ray.longest; ++i) {
    const double gap = world.distance_to_all(Vec3(ray.origin) + result.along * Vec3(ray.direction), mask);
    if (gap < 1e-8) return {true, true, result.along};
    least = std::min(least, gap);
    result.along += gap / speed;
  }
  result.told = result.along > ray.longest && least > 1e-4;
  return result;
}

void check_rays(OracleWorld& world, int count) {
  for (int i = 0; i < count; ++i) {
    const std::uint32_t mask = i % 3 == 0 ? 2u : 0xffffffffu;
    Ray ray{6.0 * Vec3(world.draw_.direction()), 2.0 * Vec3(world.draw_.direction()), i % 2 == 0 ? 4.0 : 1.0};
    ray.origin[2] += 4;
    const Traced expected = trace(world, ray, mask);
    const auto found = world.world_->cast_ray(ray, {.mask = mask});
    if (!expected.told) continue;
    ASSERT_EQ(found.has_value(), expected.hit) << i;
    if (!found) continue;
    EXPECT_NEAR(found->distance, expected.along, 1e-5);
    const Vec3 place = Vec3(ray.origin) + found->distance * Vec3(ray.direction);
    EXPECT_LT(length(place - found->point), 1e-9);
    if (found->body == world.half_) continue;
    const auto body = std::find_if(world.bodies_.begin(), world.bodies_.end(),
                                   [&](const OracleBody& b) { return b.id == found->body; });
    ASSERT_NE(body, world.bodies_.end());
    EXPECT_LT(world.distance_to(*body, found->point), 1e-8);
  }
}

void check_points(OracleWorld& world, int count) {
  for (int i = 0; i < count; ++i) {
    const std::uint32_t mask = i % 3 == 0 ? 2u : 0xffffffffu;
    const Vec3 point = world.draw_.uniform(0, 7) * Vec3(world.draw_.direction());
    const double expected = world.distance_to_all(point, mask);
    const auto found = world.world_->nearest(point, kInfinity, {.mask = mask});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance, expected, 1e-9);
    EXPECT_NEAR(length(point - found->point), expected, 1e-9);
    if (expected > 0) {
      EXPECT_FALSE(world.world_->nearest(point, expected * (1 - 1e-9), {.mask = mask}));
    }

    const double radius = world.draw_.uniform(0, 3);
    std::set<BodyIndex> touching, found_touching;
    bool doubtful = false;
    const auto judge = [&](BodyId id, double distance, std::uint32_t category) {
      if ((category & mask) == 0) return;
      doubtful = doubtful || std::fabs(distance - radius) < 1e-9;
      if (distance <= radius) touching.insert(id.index);
    };
    for (const OracleBody& body : world.bodies_) judge(body.id, world.distance_to(body, point), body.category);
    judge(world.half_, world.height(point), 1);
    const auto all = world.world_->touching_sphere(point, radius, {.mask = mask});
    for (const BodyId& id : all) found_touching.insert(id.index);
    EXPECT_EQ(found_touching.size(), all.size());
    if (!doubtful) {
      EXPECT_EQ(found_touching, touching);
    }
  }
}

TEST(WorldQueries, FindWhatBruteForceFindsAtEveryStep) {
  for (std::uint64_t seed = 0; seed < 3 * orchard::test::more(); ++seed) {
    OracleWorld world(orchard::test::first_seed() + seed, seed % 2 != 0);
    for (int step = 0; step < 3; ++step) {
      world.step(0.2 * step);
      check_rays(world, 12);
      check_points(world, 8);
      step == 0 ? world.add_body(false) : world.remove_one();
      check_points(world, 3);
    }
  }
}

TEST(WorldQueries, FollowChangesBetweenTwoSteps) {
  Detector world;
  const ShapeId ball = world.add_sphere(1);
  EXPECT_FALSE(world.nearest({0, 0, 0}));
  EXPECT_FALSE(world.cast_ray({{-5, 0, 0}, {1, 0, 0}}));
  const BodyId a = world.add_body(ball, {.pose = {.translation = {3, 0, 0}}});
  auto hit = world.cast_ray({{-5, 0, 0}, {2, 0, 0}});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->body, a);
  EXPECT_NEAR(hit->distance, 3.5, 1e-12);
  EXPECT_TRUE(world.set_state(a, {.pose = {.translation = {8, 0, 0}}}));
  EXPECT_NEAR(world.cast_ray({{-5, 0, 0}, {2, 0, 0}})->distance, 6, 1e-12);
  const BodyId rock = world.add_static({{ball}}, {.translation = {0, 5, 0}});
  EXPECT_EQ(world.nearest({0, 0, 0})->body, rock);
  EXPECT_TRUE(world.move_static(rock, {.translation = {0, 50, 0}}));
  EXPECT_EQ(world.nearest({0, 0, 0})->body, a);
  EXPECT_TRUE(world.remove(a));
  EXPECT_TRUE(world.touching_sphere({8, 0, 0}, 1).empty());
}

TEST(WorldQueries, AskTheSourceOnlyForWhatTheStepHasNotAskedForAndChangeNoAnswer) {
  const auto events_of = [](bool asks) {
    std::vector<BodyState> values(40);
    Detector world(states_of(values), {.watch = false});
    const ShapeId ball = world.add_sphere(1);
    test::Draw draw(7);
    for (BodyState& state : values) {
      state.pose.translation = 12.0 * Vec3(draw.direction()), state.velocity = -4.0 * Vec3(draw.direction());
      world.add_body({{ball}});
    }
    std::vector<double> all;
    for (int step = 0; step < 60; ++step) {
      for (BodyState& state : values) {
        state.pose.translation = Vec3(state.pose.translation) + (step == 0 ? 0 : 0.01) * state.velocity;
      }
      const Frame frame = world.step(0.01 * step);
      for (const PairEvent& event : frame.events) all.insert(all.end(), {event.time, double(event.a.index)});
      all.push_back(double(frame.motions_asked));
      if (asks) {
        EXPECT_TRUE(world.nearest({0, 0, 0}));
      }
    }
    return all;
  };
  EXPECT_EQ(events_of(false), events_of(true));
}

TEST(WorldQueries, RefuseWhatIsNoQuestion) {
  Detector world;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const ShapeId ball = world.add_sphere(1);
  world.add_body(ball, {});
  EXPECT_FALSE(world.cast_ray({{nan, 0, 0}, {1, 0, 0}}));
  EXPECT_FALSE(world.cast_ray({{0, 0, 0}, {0, 0, 0}}));
  EXPECT_FALSE(world.cast_ray({{0, 0, 0}, {1, 0, 0}, -1}));
  EXPECT_FALSE(world.nearest({0, nan, 0}));
  EXPECT_FALSE(world.nearest({0, 0, 0}, -1));
  EXPECT_TRUE(world.touching_sphere({0, 0, 0}, -1).empty());
  EXPECT_TRUE(world.touching_sphere({0, 0, 0}, kInfinity).empty());
  EXPECT_FALSE(world.nearest({0, 0, 0}, kInfinity, {.mask = 0}));
  EXPECT_EQ(world.cast_ray({{0, 0, 0}, {1, 0, 0}})->distance, 0);  // it begins inside
}

}  // namespace
}  // namespace orchard::runtime
