#include <gtest/gtest.h>

#include "../runtime/allocation.h"
#include "any_broad_phase.h"
#include "runtime/numbers.h"
#include "worlds.h"

// Without memory at any moment: a call that throws has changed nothing, or the world says that it is no more.
namespace orchard::runtime {
namespace {

using test::kStep;
constexpr int kStepsOfWorlds = 40;
constexpr std::size_t kMaxCount = 60;

// An application all of whose calls go through attempt(), which makes one allocation of the library's fail.
class FailingApplication {
 public:
  FailingApplication(const test::AnyOptions& options, std::uint64_t seed, std::size_t failing)
      : draw_(seed), left_(failing), values_(kMaxCount), known_(kMaxCount) {
    world_.emplace(test::make_broad_phase(values_of(values_), options));
  }

  void run() {
    for (int step = 0; step < kStepsOfWorlds && world_->valid(); ++step) {
      for (BodyIndex i = 0; i < kMaxCount; ++i) {
        if (known_[i].alive && !known_[i].fixed)
          values_[i].position = values_[i].position + kStep * values_[i].velocity;
      }
      for (std::size_t changes = step == 0 ? 20 : draw_.bits() % 6; changes > 0; --changes) change();
      advance(step);
      if (testing::Test::HasFatalFailure()) return;
    }
  }

  bool failed() const { return failed_; }
  bool lost() const { return !world_->valid(); }

 private:
  struct Known {
    bool alive = false, fixed = false;
    BodyId id;
  };

  // Calls until there is memory; what throws has to have changed nothing that can be seen.
  template <typename Call>
  void attempt(Call&& call) {
    for (;;) {
      const std::size_t before = test::allocations, bodies = world_->size();
      test::failing_allocation = left_ > 0 ? before + left_ : 0;
      bool thrown = false;
      try {
        call();
      } catch (const std::bad_alloc&) {
        thrown = true;
      }
      test::failing_allocation = 0;
      const std::size_t used = test::allocations - before;
      left_ -= std::min(left_, used);
      failed_ = failed_ || thrown;
      if (!thrown || !world_->valid()) return;
      ASSERT_EQ(world_->size(), bodies);
      for (const Known& known : known_) ASSERT_EQ(world_->contains(known.id), known.alive);
    }
  }

  Motion random_motion() {
    Motion m;
    m.position = draw_.in_ball(8);
    m.velocity = draw_.uniform(0, 10) * draw_.direction();
    m.radius = draw_.uniform(0, 1.2);
    return m;
  }

  void change() {
    const auto i = static_cast<BodyIndex>(draw_.bits() % kMaxCount);
    Known& known = known_[i];
    const auto rank = static_cast<std::uint8_t>(draw_.bits() % 3 * 50);
    const double dice = draw_.uniform(0, 1);
    if (dice < 0.5) {
      if (world_->size() == kMaxCount) return;
      const Motion m = random_motion();
      const bool fixed = draw_.bits() % 3 == 0;
      BodyId id;
      attempt([&] { id = fixed ? world_->add_static(m, rank) : world_->add(rank); });
      ASSERT_NE(id, kNoBody);
      ASSERT_FALSE(known_[id.index].alive);
      known_[id.index] = {true, fixed, id};
      values_[id.index] = m;
    } else if (!known.alive) {
      return;
    } else if (dice < 0.65) {
      attempt([&] { ASSERT_TRUE(world_->remove(known.id)); });
      known.alive = false;
    } else if (dice < 0.8) {
      values_[i] = random_motion();
      attempt([&] { ASSERT_TRUE(known.fixed ? world_->move_static(known.id, values_[i]) : world_->cancel(known.id)); });
    } else if (dice < 0.9) {
      attempt([&] { ASSERT_TRUE(world_->set_importance(known.id, rank)); });
    } else if (dice < 0.98) {
      const BodyFilter filter{1, 0xffffffffu, static_cast<std::int32_t>(draw_.bits() % 3) - 2};
      attempt([&] { ASSERT_TRUE(world_->set_filter(known.id, filter)); });
    } else {
      filtered_ = !filtered_;
      PairFilter filter;
      if (filtered_) filter = [](BodyId a, BodyId b) { return (a.index + b.index) % 3 != 0; };
      attempt([&] { world_->set_pair_filter(filter); });
    }
  }

  void advance(int step) {
    std::vector<BodyPair> found, expected;
    found.reserve(kMaxCount * kMaxCount);
    const bool within = draw_.bits() % 3 == 0;
    attempt([&] {
      const Advance now =
          within ? world_->advance(kStep * step, Budget{.work = 1'000'000}) : world_->advance(kStep * step);
      found.assign(now.pairs.begin(), now.pairs.end());
    });
    if (!world_->valid()) {
      expect_refused(step);
      return;
    }
    for (BodyIndex i = 0; i < kMaxCount; ++i) {
      for (BodyIndex j = i + 1; j < kMaxCount; ++j) {
        const Known &a = known_[i], &b = known_[j];
        if (!a.alive || !b.alive || (a.fixed && b.fixed) || !spheres_touch(values_[i], values_[j])) continue;
        if (!may_pair(world_->filter_of(a.id), world_->filter_of(b.id)) || (filtered_ && (i + j) % 3 == 0)) continue;
        expected.push_back({i, j});
      }
    }
    ASSERT_EQ(found, expected) << "step " << step;
  }

  void expect_refused(int step) {
    const Advance now = world_->advance(kStep * (step + 1));
    EXPECT_TRUE(now.time_refused);
    EXPECT_TRUE(now.pairs.empty());
    EXPECT_EQ(world_->size(), 0u);
    EXPECT_EQ(world_->add(), kNoBody);
    EXPECT_EQ(world_->add_static(Motion{}), kNoBody);
    for (const Known& known : known_) {
      EXPECT_FALSE(world_->contains(known.id));
      EXPECT_FALSE(world_->cancel(known.id) || world_->remove(known.id) || world_->set_importance(known.id, 1));
    }
  }

  test::Draw draw_;
  std::size_t left_;  // allocations until one fails; 0: none will any more
  bool failed_ = false, filtered_ = false;
  std::vector<Motion> values_;
  std::vector<Known> known_;
  std::optional<BroadPhase> world_;
};

class WithoutMemory : public testing::TestWithParam<test::AnyMethod> {};
INSTANTIATE_TEST_SUITE_P(BroadPhase, WithoutMemory, testing::ValuesIn(test::kMethods));

TEST_P(WithoutMemory, NothingIsChangedOrAllIsRefused) {
  const bool events = GetParam() == test::AnyMethod::events;
  int kept = 0, lost = 0;
  // The others allocate in their search, thousands of times.
  for (std::size_t failing = 1;; failing += events ? 1 : 1 + failing / 10) {
    FailingApplication application({.method = GetParam(), .common = {.time_step = kStep}}, events ? failing : 3,
                                   failing);
    application.run();
    if (testing::Test::HasFatalFailure()) FAIL() << "the allocation number " << failing;
    if (!application.failed()) break;
    ++(application.lost() ? lost : kept);
  }
  EXPECT_GT(kept, events ? 20 : 3);
  EXPECT_GT(lost, 10);
}

// What the application's source throws is no different.
TEST(BroadPhase, WhoseSourceThrowsIsLost) {
  const MotionSource source = [&](double time, std::span<const BodyIndex>, std::span<Motion> motions) {
    if (time > 5 * kStep) throw 7;
    std::fill(motions.begin(), motions.end(), Motion{.radius = 1, .acceleration = 1e6});
  };
  BroadPhase world(source, {.time_step = kStep});
  world.add(), world.add();
  int step = 0;
  EXPECT_THROW(
      {
        for (; step < 1000; ++step) world.advance(kStep * step);
      },
      int);
  EXPECT_GE(step, 5);
  EXPECT_FALSE(world.valid());
  EXPECT_TRUE(world.advance(kStep * (step + 1)).time_refused);
}

}  // namespace
}  // namespace orchard::runtime
