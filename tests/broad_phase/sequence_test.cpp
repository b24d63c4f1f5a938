#include <gtest/gtest.h>

#include <cmath>

#include "../support/effort.h"
#include "any_broad_phase.h"
#include "runtime/every_machine.h"
#include "runtime/numbers.h"
#include "worlds.h"

// Random sequences of everything an application can do, hostile values included, against comparing all bodies.
namespace orchard::runtime {
namespace {

constexpr std::uint64_t kSeeds = 150, kSeedsOfOthers = 12;
using test::kInfinity;
using test::kNaN;
using test::kStep;

class Sequence {
 public:
  Sequence(std::uint64_t seed, const test::AnyOptions& options, std::size_t crowd)
      : draw_(seed), crowd_(crowd), world_(test::make_broad_phase(values_of(values_), options)) {
    hostile_ = chance(0.5);
    filtered_ = chance(0.5);
    settled_ = chance(0.5);
    ball_ = draw_.uniform(1, 4) * std::cbrt(static_cast<double>(crowd));
    if (chance(0.3)) wind_ = draw_.uniform(0, 200) * draw_.direction();
  }

  void run(int steps) {
    for (int step = 0; step < steps; ++step) {
      move();
      change();
      if (chance(0.02)) do_nothing();
      advance(step);
      if (testing::Test::HasFatalFailure()) FAIL() << "step " << step;
    }
  }

 private:
  struct Known {
    bool alive = false, fixed = false, valid = true;
    unsigned importance = 0;
    BodyId id;
    BodyFilter filter{};
  };

  bool chance(double share) { return draw_.uniform(0, 1) < share; }

  BodyFilter random_filter() {
    if (!filtered_ || chance(0.3)) return {};
    const auto bits = [&] { return chance(0.1) ? 0 : static_cast<std::uint32_t>(draw_.bits()); };
    return {bits() & 7, chance(0.5) ? bits() : 0xffffffffu, static_cast<std::int32_t>(draw_.bits() % 9) - 4,
            chance(0.2)};
  }

  // Every third pair is none, or every fourth, or all are some.
  void set_pair_filter() {
    excluded_ = chance(0.3) ? 0 : 3 + static_cast<BodyIndex>(draw_.bits() % 2);
    if (excluded_ == 0) return world_.set_pair_filter(nullptr);
    world_.set_pair_filter([this](BodyId a, BodyId b) {
      EXPECT_TRUE(a.index < b.index && world_.contains(a) && world_.contains(b));
      EXPECT_TRUE(may_pair(known_[a.index].filter, known_[b.index].filter));
      return (a.index + b.index) % excluded_ != 0;
    });
  }

  Motion random_motion() {
    Motion m;
    m.position = draw_.in_ball(ball_) + now_ * wind_;
    m.velocity = draw_.uniform(0, 10) * draw_.direction() + wind_;
    m.radius = chance(0.02) ? 2 * ball_ : draw_.uniform(0, 1.2);
    m.acceleration = draw_.uniform(0, 10);
    if (settled_ && chance(0.6)) {  // for good, or so it says
      m.velocity = {};
      m.acceleration = 0;
    } else if (chance(0.5)) {
      m.expiry = now_ + draw_.uniform(0, 0.3);
    }
    return m;
  }

  void spoil(Motion& m) {
    const double bad[] = {kNaN, kInfinity, -kInfinity, 1e300, -1e101};
    const double x = bad[draw_.bits() % 5];
    switch (draw_.bits() % 8) {
      case 0:
        m.position[draw_.bits() % 3] = x;
        break;
      case 1:
        m.velocity[draw_.bits() % 3] = x;
        break;
      case 2:
        m.half_space[draw_.bits() % 3] = x;
        break;
      case 3:
        m.radius = chance(0.5) ? x : -1e-9;
        break;
      case 4:
        m.acceleration = chance(0.5) ? x : -1;
        break;
      case 5:
        m.drift = chance(0.5) ? x : -1;
        break;
      default:
        m.expiry = kNaN;
        break;
    }
  }

  void move() {
    now_ += kStep;
    for (BodyIndex i = 0; i < values_.size(); ++i) {
      Motion& m = values_[i];
      if (!known_[i].alive || known_[i].fixed || !known_[i].valid) continue;
      const Vec3 a = draw_.uniform(0, m.acceleration) * draw_.direction();
      m.position = m.position + kStep * m.velocity + (kStep * kStep / 2) * a;
      m.velocity = m.velocity + kStep * a;
      if (m.expiry < now_ + 2 * kStep) m.expiry = now_ + draw_.uniform(0, 0.3);
    }
  }

  void add() {
    Motion m = random_motion();
    const unsigned importance = static_cast<unsigned>(draw_.bits() % 3) * 100;
    const bool fixed = chance(0.2);
    const std::size_t before = world_.size();
    if (fixed && hostile_ && chance(0.2)) {
      Motion bad = m;
      do spoil(bad);
      while (is_valid(bad));
      ASSERT_EQ(world_.add_static(bad), kNoBody);
      ASSERT_EQ(world_.size(), before);
    }
    const auto rank = static_cast<std::uint8_t>(importance);
    const BodyFilter filter = random_filter();
    const BodyId id = fixed ? world_.add_static(m, rank, filter) : world_.add(rank, filter);
    ASSERT_NE(id, kNoBody);
    if (id.index >= values_.size()) values_.resize(id.index + 1), known_.resize(id.index + 1);
    ASSERT_FALSE(known_[id.index].alive);
    values_[id.index] = m;
    ASSERT_EQ(world_.filter_of(id), filter);
    known_[id.index] = {true, fixed, true, importance, id, filter};
  }

  void remove(BodyIndex i) {
    gone_.push_back(known_[i].id);
    ASSERT_TRUE(world_.remove(known_[i].id));
    known_[i].alive = false;
    ASSERT_FALSE(world_.remove(known_[i].id));
  }

  void change() {
    if (world_.size() < crowd_ && chance(0.1)) {
      for (std::size_t k = draw_.bits() % crowd_ + 1; k > 0; --k) add();
    }
    if (chance(0.01)) {  // all of them
      for (BodyIndex i = 0; i < known_.size(); ++i) {
        if (known_[i].alive) remove(i);
      }
      if (chance(0.5)) add();
    }
    if (filtered_ && chance(0.03)) set_pair_filter();
    if (chance(0.05)) restless_ = chance(0.4);
    for (BodyIndex i = 0; restless_ && i < known_.size(); ++i) {
      if (known_[i].alive) world_.cancel(known_[i].id);
    }
    if (values_.empty()) return;
    for (std::size_t k = draw_.bits() % 4; k > 0; --k) {
      const auto i = static_cast<BodyIndex>(draw_.bits() % values_.size());
      if (known_[i].alive) change(i);
    }
  }

  void change(BodyIndex i) {
    Known& known = known_[i];
    const double dice = draw_.uniform(0, 1);
    if (dice < 0.1) {
      remove(i);
    } else if (dice < 0.3) {  // anywhere: teleported
      values_[i] = random_motion();
      known.valid = true;
      ASSERT_TRUE(known.fixed ? world_.move_static(known.id, values_[i]) : world_.teleport(known.id));
    } else if (dice < 0.4) {
      known.importance = static_cast<unsigned>(draw_.bits() % 3) * 100;
      ASSERT_TRUE(world_.set_importance(known.id, static_cast<std::uint8_t>(known.importance)));
    } else if (dice < 0.5 && filtered_) {
      known.filter = random_filter();
      ASSERT_TRUE(world_.set_filter(known.id, known.filter));
      ASSERT_EQ(world_.filter_of(known.id), known.filter);
    } else if (dice < 0.6 && hostile_) {
      Motion bad = values_[i];
      do spoil(bad);
      while (is_valid(bad));
      if (known.fixed) {
        ASSERT_FALSE(world_.move_static(known.id, bad));
      } else {
        values_[i] = bad;
        known.valid = false;
        ASSERT_TRUE(world_.cancel(known.id));
      }
    }
  }

  // What is refused changes nothing.
  void do_nothing() {
    for (const double t : {kNaN, kInfinity, -kInfinity, 1e300, -1e300, -1.0}) {
      const Advance refused = world_.advance(t);
      ASSERT_EQ(refused.time_refused, !(std::fabs(t) <= kMaxSteps * kStep)) << t;
      ASSERT_TRUE(refused.pairs.empty());
    }
    for (const BodyId id : gone_) {
      ASSERT_FALSE(world_.remove(id) || world_.cancel(id) || world_.set_importance(id, 0) || world_.set_filter(id, {}));
    }
    ASSERT_FALSE(world_.cancel({static_cast<BodyIndex>(draw_.bits()), static_cast<std::uint32_t>(draw_.bits())}));
    ASSERT_FALSE(world_.remove(kNoBody));
  }

  void advance(int step) {
    // Stretches without a budget, with some, with one unit, with no time at all.
    if (step % 20 == 0) mode_ = static_cast<int>(draw_.bits() % 5);
    Budget budget;
    if (mode_ == 1) budget.work = 1 + draw_.bits() % (2 * crowd_);
    if (mode_ == 2) budget.work = 1;
    if (mode_ == 3) budget.time = std::chrono::nanoseconds(0);
    if (mode_ == 4) budget.work = 1'000'000;
    const Advance now = mode_ == 0 ? world_.advance(now_) : world_.advance(now_, budget);
    ASSERT_EQ(world_.motion_bound_violations(), 0u);
    const std::vector<BodyIndex> refused(now.refused.begin(), now.refused.end());
    const bool complete = now.incomplete_from == kNoClass;
    ASSERT_EQ(complete, now.left_over == 0);
    if (mode_ == 0 || mode_ == 4) {
      ASSERT_TRUE(complete);
    }
    std::vector<BodyPair> sure, found(now.pairs.begin(), now.pairs.end());
    for (BodyIndex i = 0; i < values_.size(); ++i) {
      for (BodyIndex j = i + 1; j < values_.size(); ++j) {
        if (!touch(i, j)) continue;
        if (std::max(known_[i].importance, known_[j].importance) < now.incomplete_from) sure.push_back({i, j});
      }
    }
    for (const BodyPair& pair : found)
      ASSERT_TRUE(pair.a < pair.b && touch(pair.a, pair.b)) << pair.a << ", " << pair.b;
    ASSERT_TRUE(std::is_sorted(found.begin(), found.end()));
    ASSERT_EQ(std::adjacent_find(found.begin(), found.end()), found.end()) << "a pair twice";
    ASSERT_TRUE(std::includes(found.begin(), found.end(), sure.begin(), sure.end())) << "mode " << mode_;
    for (const BodyIndex body : refused) ASSERT_TRUE(known_[body].alive && !known_[body].valid);
    for (BodyIndex i = 0; complete && i < known_.size(); ++i) {
      if (!known_[i].alive || known_[i].valid) continue;
      ASSERT_NE(std::find(refused.begin(), refused.end(), i), refused.end()) << i;
    }
  }

  bool touch(BodyIndex i, BodyIndex j) const {
    const auto takes_part = [&](BodyIndex k) { return known_[k].alive && known_[k].valid; };
    const auto ignores = [&](BodyIndex k, BodyIndex l) { return known_[k].filter.ignores_static && known_[l].fixed; };
    return takes_part(i) && takes_part(j) && !(known_[i].fixed && known_[j].fixed) && !ignores(i, j) &&
           !ignores(j, i) && may_pair(known_[i].filter, known_[j].filter) &&
           (excluded_ == 0 || (i + j) % excluded_ != 0) && spheres_touch(values_[i], values_[j]);
  }

  test::Draw draw_;
  std::size_t crowd_;
  bool hostile_ = false, filtered_ = false, restless_ = false,
       settled_ = false;  // restless: no bound lasts for longer than a step
  Vec3 wind_{};           // all fly with it
  BodyIndex excluded_ = 0;
  double ball_ = 1, now_ = -kStep;
  int mode_ = 0;
  std::vector<Motion> values_;
  std::vector<Known> known_;
  std::vector<BodyId> gone_;
  BroadPhase world_;
};

class Sequences : public testing::TestWithParam<test::AnyMethod> {};
INSTANTIATE_TEST_SUITE_P(BroadPhase, Sequences, testing::ValuesIn(test::kMethods));

TEST_P(Sequences, OfAnyCallsAreAnsweredRight) {
  const bool events = GetParam() == test::AnyMethod::events;
  const std::uint64_t first = orchard::test::first_seed() + 1;
  const std::uint64_t seeds = (events ? kSeeds : kSeedsOfOthers) * orchard::test::more();
  for (std::uint64_t seed = first; seed < first + seeds; ++seed) {
    test::AnyOptions options{.method = GetParam(), .common = {.time_step = kStep}};
    if (seed % 3 == 1) options.common.window = static_cast<std::uint32_t>(1 + seed % 30);
    const auto machine = test::on_portable_machine(seed % 4 == 2);
    options.common.validate = seed % 5 == 0;
    if (seed % 2 == 1) options.rebuild = test::Rebuild::everything;
    const std::size_t crowd = !events ? 12 : seed % 10 == 9 ? 260 : seed % 10 == 8 ? 90 : 15;
    Sequence sequence(seed, options, crowd);
    sequence.run(crowd > 100 ? 60 : 150);
    if (testing::Test::HasFatalFailure()) FAIL() << "seed " << seed;
  }
}

}  // namespace
}  // namespace orchard::runtime
