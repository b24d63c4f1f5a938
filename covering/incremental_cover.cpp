#include "orchard/covering/incremental_cover.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

#include "lemma_check.h"

namespace orchard {
using detail::CircleInPlane;
using detail::LemmaCheck;
using detail::TrianglePlane;

struct IncrementalCover::Data {
  // The circle of a ball in a triangle, as it was when the ball had this version.
  struct Cached {
    Index ball;
    std::uint64_t version;
    CircleInPlane circle;
  };

  struct TriangleState {
    TrianglePlane plane;
    std::vector<Cached> cache;  // ascending by ball
    // The leaves that the certificate rests on, ascending; empty if the triangle is not covered.
    std::vector<Index> coverers;
    bool covered() const { return !coverers.empty(); }
  };

  // The result of a check, which is kept apart until it is accepted.
  struct Outcome {
    Index slot;
    std::vector<Index> coverers;
    std::vector<Cached> fresh;  // circles that were not in the cache
  };

  const Surface& surface;
  PathForest forest;
  std::vector<Index> triangles;  // ascending; the other arrays of triangles use the positions in this one
  std::vector<TriangleState> states;
  std::vector<std::uint64_t> versions;  // of each ball
  std::uint64_t next_version = 1;
  // Of each leaf: the slots whose coverers contain it, and possibly some that no longer do.
  std::vector<std::vector<Index>> resting_on;
  std::vector<Index> open;  // uncovered slots, ascending
  std::uint64_t checked = 0;
  NearBalls near;

  Data(const Surface& s, std::vector<Index> which, std::span<const PathBall> balls)
      : surface(s), forest(balls), triangles(std::move(which)), versions(balls.size(), 0), resting_on(balls.size()) {
    states.reserve(triangles.size());
    for (Index triangle : triangles) states.push_back({TrianglePlane(surface.corners(triangle)), {}, {}});
    std::vector<Outcome> outcomes(triangles.size());
    tbb::parallel_for(std::size_t{0}, triangles.size(), [&](std::size_t slot) {
      NearBalls scratch;
      outcomes[slot] = check(static_cast<Index>(slot), scratch);
    });
    checked = triangles.size();
    for (Outcome& outcome : outcomes) accept(std::move(outcome));
    for (Index slot = 0; slot < states.size(); ++slot)
      if (!states[slot].covered()) open.push_back(slot);
  }

  Outcome check(Index slot, NearBalls& scratch) {
    TriangleState& state = states[slot];
    Outcome outcome{slot, {}, {}};
    forest.gather(surface.corners(triangles[slot]), scratch);
    std::vector<CircleInPlane*> circles(scratch.balls.size());
    outcome.fresh.reserve(circles.size());
    for (std::size_t i = 0; i < circles.size(); ++i) {
      const Index ball = scratch.original[i];
      Cached* cached = find(state.cache, ball);
      if (cached == nullptr || cached->version != versions[ball]) {
        const auto disk = state.plane.project(scratch.balls[i].center, scratch.balls[i].radius);
        outcome.fresh.push_back({ball, versions[ball], {disk, {}, false}});
        cached = &outcome.fresh.back();
      }
      circles[i] = &cached->circle;
    }
    const auto want = LemmaCheck::Want::answer;
    for (Index i : LemmaCheck(state.plane, scratch.balls, circles, want).run().coverers)
      outcome.coverers.push_back(scratch.original[i]);
    std::sort(outcome.coverers.begin(), outcome.coverers.end());
    return outcome;
  }

  static Cached* find(std::vector<Cached>& cache, Index ball) {
    const auto at = std::lower_bound(cache.begin(), cache.end(), ball,
                                     [](const Cached& entry, Index wanted) { return entry.ball < wanted; });
    return at != cache.end() && at->ball == ball ? &*at : nullptr;
  }

  void accept(Outcome outcome) {
    TriangleState& state = states[outcome.slot];
    for (Index leaf : outcome.coverers)
      if (!std::binary_search(state.coverers.begin(), state.coverers.end(), leaf))
        resting_on[leaf].push_back(outcome.slot);
    state.coverers = std::move(outcome.coverers);
    for (Cached& fresh : outcome.fresh) {
      if (Cached* old = find(state.cache, fresh.ball)) {
        *old = std::move(fresh);
        continue;
      }
      const auto at = std::lower_bound(state.cache.begin(), state.cache.end(), fresh.ball,
                                       [](const Cached& entry, Index wanted) { return entry.ball < wanted; });
      state.cache.insert(at, std::move(fresh));
    }
  }

  // Returns the slots whose certificate rests on a leaf below the ball, ascending.
  std::vector<Index> slots_resting_on(Index ball) {
    std::vector<Index> slots, below{ball};
    for (std::size_t i = 0; i < below.size(); ++i) {
      const Index node = below[i];
      const auto children = forest.children(node);
      below.insert(below.end(), children.begin(), children.end());
      auto& list = resting_on[node];
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
      std::erase_if(list, [&](Index slot) {
        return !std::binary_search(states[slot].coverers.begin(), states[slot].coverers.end(), node);
      });
      slots.insert(slots.end(), list.begin(), list.end());
    }
    std::sort(slots.begin(), slots.end());
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
    return slots;
  }

  bool touches(Index slot, const Sphere& sphere) const {
    const auto [a, b, c] = surface.corners(triangles[slot]);
    return closest_point_of_triangle(sphere.center, a, b, c).distance <= sphere.radius * (1 + 1e-9);
  }

  bool change(Index index, const Sphere& sphere, bool only_if_covered) {
    PathBall& ball = forest.ball(index);
    const Sphere old{ball.center, ball.radius};
    const std::uint64_t old_version = versions[index];
    std::vector<Index> slots = slots_resting_on(index);
    const auto set = [&](const Sphere& value, std::uint64_t version) {
      ball.center = value.center;
      ball.radius = value.radius;
      versions[index] = version;
    };
    set(sphere, next_version++);
    std::vector<Outcome> outcomes;
    for (Index slot : slots) {
      ++checked;
      outcomes.push_back(check(slot, near));
      if (!only_if_covered || !outcomes.back().coverers.empty()) continue;
      set(old, old_version);
      return false;
    }
    for (Index slot : open) {
      if (!touches(slot, sphere) && !touches(slot, old)) continue;
      ++checked;
      outcomes.push_back(check(slot, near));
    }
    for (Outcome& outcome : outcomes) slots.push_back(outcome.slot), accept(std::move(outcome));
    slots.insert(slots.end(), open.begin(), open.end());
    std::sort(slots.begin(), slots.end());
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
    open.clear();
    for (Index slot : slots)
      if (!states[slot].covered()) open.push_back(slot);
    return true;
  }
};

IncrementalCover::IncrementalCover(const Surface& surface, std::span<const PathBall> balls)
    : IncrementalCover(
          surface,
          [&] {
            std::vector<Index> all(surface.mesh().triangles.size());
            std::iota(all.begin(), all.end(), Index{0});
            return all;
          }(),
          balls) {}

IncrementalCover::IncrementalCover(const Surface& surface, std::vector<Index> triangles,
                                   std::span<const PathBall> balls) {
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  data_ = std::make_unique<Data>(surface, std::move(triangles), balls);
}

IncrementalCover::~IncrementalCover() = default;
IncrementalCover::IncrementalCover(IncrementalCover&&) noexcept = default;
IncrementalCover& IncrementalCover::operator=(IncrementalCover&&) noexcept = default;

std::span<const PathBall> IncrementalCover::balls() const { return data_->forest.balls(); }
Index IncrementalCover::uncovered_count() const { return static_cast<Index>(data_->open.size()); }
std::uint64_t IncrementalCover::triangles_checked() const { return data_->checked; }

std::vector<Index> IncrementalCover::uncovered() const {
  std::vector<Index> triangles;
  for (Index slot : data_->open) triangles.push_back(data_->triangles[slot]);
  return triangles;
}

void IncrementalCover::change(Index ball, const Sphere& sphere) { data_->change(ball, sphere, false); }
bool IncrementalCover::try_change(Index ball, const Sphere& sphere) { return data_->change(ball, sphere, true); }

}  // namespace orchard
