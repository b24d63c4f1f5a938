#pragma once
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

#include "broad_phase/motion_bound_check.h"
#include "simd/vector_support.h"

namespace orchard::runtime::detail {

using Step = std::int64_t;
inline constexpr Step kNeverStep = std::numeric_limits<Step>::max();

// Times of steps. Comparing a time with a step's allows for kStepSlack steps, and for rounding, in the safe direction:
// far from zero rounding is the larger one, up to 1e-3 steps at kMaxSteps.
inline constexpr double kStepSlack = 1e-6;
inline constexpr double kTimeRounding = 0x1p-50;  // relative: of a few operations on times

struct Clock {
  double start, time_step;
  double per_second = 1 / time_step;  // steps

  double time(Step step) const noexcept { return start + static_cast<double>(step) * time_step; }
  // In seconds: what the times of two steps up to this one, and their difference, are off by at most.
  double rounding(Step step) const noexcept {
    return kTimeRounding * (std::fabs(start) + static_cast<double>(step) * time_step);
  }
  // From when on a time is taken for the step's.
  double earliest(Step step) const noexcept { return time(step) - (kStepSlack * time_step + rounding(step)); }
  // The last step that is not after a time, below 0 before the first one. With room for rounding here: of what is taken
  // for a step's time that step is the last one.
  Step step_at(double time) const noexcept {
    const double passed = time - start, slack = 2 * kTimeRounding * (std::fabs(start) + std::fabs(passed));
    return static_cast<Step>(std::floor((passed + slack) / time_step + kStepSlack));
  }
  // At least as long as what lies between the times of two steps.
  double seconds_between(Step from, Step to) const noexcept {
    return from == to ? 0 : static_cast<double>(to - from) * time_step + rounding(to);
  }
  // The number of steps after `now` whose time lies before `seconds` after it; at least 0.
  Step steps_before(double seconds, Step now) const noexcept {
    const double steps = std::ceil((seconds * (1 - kTimeRounding) - rounding(now)) * per_second - kStepSlack);
    return steps < 1e15 ? static_cast<Step>(std::max(0.0, steps)) : kNeverStep;
  }
  // The number of steps after `now` that are surely not later than `seconds` after it.
  Step steps_within(double seconds, Step now) const noexcept {
    return static_cast<Step>(std::max(0.0, (seconds * (1 - kTimeRounding) - rounding(now)) * per_second - kStepSlack));
  }
  // The last step at which a bound that expires at `expiry` holds. An application that means a step's time gets this
  // step, although it may have computed the time in another way.
  Step last_before_expiry(double expiry) const noexcept {
    const double steps = (expiry - start) / time_step;
    const double rounding = kTimeRounding * ((std::fabs(expiry) + std::fabs(start)) / time_step + std::fabs(steps));
    return steps < 1e15 ? static_cast<Step>(std::floor(std::max(-1.0, steps + std::min(rounding, kStepSlack))))
                        : kNeverStep;
  }
};

// Counts work against a budget. Without one it never stops.
class BudgetTracker {
 public:
  BudgetTracker() = default;
  explicit BudgetTracker(const Budget& budget, std::uint64_t replay)
      : budget_(budget), replay_(replay), begin_(std::chrono::steady_clock::now()) {}

  bool limited() const noexcept { return budget_.limited() || replay_ != 0; }
  std::uint64_t done() const noexcept { return done_; }
  void count(std::uint64_t work) noexcept {
    done_ += work;
    since_clock_ += work;
  }
  // The first unit is always granted.
  bool spent() noexcept {
    if (done_ == 0) return false;
    if (done_ >= budget_.work) return true;
    if (replay_ != 0) return done_ >= replay_;
    if (since_clock_ < kWorkPerClock || budget_.time == Budget{}.time) return late_;
    since_clock_ = 0;
    late_ = late_ || std::chrono::steady_clock::now() - begin_ >= budget_.time;
    return late_;
  }
  // Units that may still be done; at least 1.
  std::uint64_t left() const noexcept { return budget_.work > done_ ? budget_.work - done_ : 1; }
  // How many of `wanted` units may be done before asking again.
  std::size_t grant(std::size_t wanted) const noexcept {
    if (!limited()) return wanted;
    return std::min({wanted, std::size_t{kWorkPerClock}, static_cast<std::size_t>(left())});
  }

 private:
  Budget budget_;
  std::uint64_t replay_ = 0;
  std::chrono::steady_clock::time_point begin_{};
  std::uint64_t done_ = 0, since_clock_ = kWorkPerClock;
  bool late_ = false;
};

// Leaves what a vector grows by as it is in memory: for what is written before it is read, by jobs. So it is one pass,
// and pages that have never been used are shared between the jobs' threads.
template <typename T>
struct UnsetAllocator : std::allocator<T> {
  template <typename U>
  struct rebind {
    using other = UnsetAllocator<U>;
  };
  UnsetAllocator() noexcept = default;
  template <typename U>
  UnsetAllocator(const UnsetAllocator<U>&) noexcept {}
  template <typename U, typename... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    if constexpr (sizeof...(Arguments) == 0) {
      static_assert(std::is_trivially_default_constructible_v<U>);
      ::new (static_cast<void*>(place)) U;
    } else {
      ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
    }
  }
};
template <typename T>
using UnsetVector = std::vector<T, UnsetAllocator<T>>;

// Of a vector that grows one by one, by an eighth at a time: twice the room would be half the memory. What comes all at
// once gets the room that it takes.
template <typename T, typename Allocator>
void make_room(std::vector<T, Allocator>& v, std::size_t size) {
  constexpr std::size_t kMinRoom = 32;
  if (v.capacity() < size) v.reserve(std::max({kMinRoom, size, v.capacity() + v.capacity() / 8}));
}
template <typename T>
void append(std::vector<T>& v, const T& value) {
  if (v.size() == v.capacity()) v.reserve(std::max<std::size_t>(64, v.size() + v.size() / 16));
  v.push_back(value);
}
template <typename T, typename Allocator>
void grow(std::vector<T, Allocator>& v, std::size_t size) {
  if (v.size() >= size) return;
  make_room(v, size);
  v.resize(size);
}

// Whether each index is one above that before it.
inline bool successive(std::span<const BodyIndex> bodies) noexcept {
  BodyIndex off = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) off |= bodies[i] ^ (bodies[0] + static_cast<BodyIndex>(i));
  return off == 0;
}

// Which bodies there are, and where to ask for their motions.
class BodyPool {
 public:
  BodyPool(MotionSource source, const Clock& steps) : clock(steps), source_(std::move(source)) {}

  const Clock clock;

  // Where there is no memory for it, a change changes nothing.
  // With a place: a static one. kNoIndex: full.
  BodyIndex add(std::uint8_t importance, const BodyFilter& filter, const Motion* place);
  void undo_add(BodyIndex body) noexcept;  // the one added last, which never was
  void make_room_to_remove(BodyIndex body);
  void remove(BodyIndex body) noexcept;  // after make_room_to_remove()
  BodyId id_of(BodyIndex body) const noexcept { return {body, generations_[body]}; }
  void move_static(BodyIndex body, const Motion& place) noexcept;
  void set_importance(BodyIndex body, std::uint8_t importance);
  void make_room_for_filters() { grow(filters_, slots()); }
  void set_filter(BodyIndex body, const BodyFilter& filter) noexcept { filters_[body] = filter; }  // after that
  void set_pair_filter(PairFilter filter) noexcept { pair_filter_ = std::move(filter); }

  std::size_t slots() const noexcept { return generations_.size(); }  // indices are below
  std::size_t size() const noexcept { return size_; }
  bool alive(BodyIndex body) const noexcept { return generations_[body] % 2 != 0; }
  bool is_static(BodyIndex body) const noexcept { return !static_slot_.empty() && static_slot_[body] != kNoSlot; }
  bool any_static() const noexcept { return !static_slot_.empty(); }
  std::size_t statics() const noexcept { return static_motions_.size() - free_slots_.size(); }
  BodyFilter filter(BodyIndex body) const noexcept { return filters_.empty() ? BodyFilter{} : filters_[body]; }
  // Whether some pairs are none.
  bool filters_pairs() const noexcept { return any_static() || !filters_.empty() || pair_filter_; }
  bool may_pair(const BodyPair& pair) const {
    if (any_static() && is_static(pair.a) && is_static(pair.b)) return false;
    if (!filters_.empty()) {
      const BodyFilter &a = filters_[pair.a], &b = filters_[pair.b];
      if (!runtime::may_pair(a, b)) return false;
      if ((a.ignores_static && is_static(pair.b)) || (b.ignores_static && is_static(pair.a))) return false;
    }
    return !pair_filter_ || pair_filter_(id_of(pair.a), id_of(pair.b));
  }
  std::uint8_t importance(BodyIndex body) const noexcept { return importance_[body]; }
  unsigned next_class(unsigned from) const noexcept;  // the first class, from `from` on, that has bodies; or kNoClass
  // A pair is as important as the less important of its bodies.
  std::uint8_t importance(const BodyPair& pair) const noexcept {
    return std::max(importance_[pair.a], importance_[pair.b]);
  }

  // motions[i] is that of bodies[i] at the step.
  void ask(Step step, std::span<const BodyIndex> bodies, std::span<Motion> motions);
  // The same, as one of some threads that ask at once, each with memory of its own, and not counted. One thread at a
  // time if motion bounds are checked.
  struct Answers {
    std::vector<BodyIndex> moving;
    std::vector<Motion> motions;
    std::size_t memory_bytes() const noexcept;
  };
  void ask(Step step, std::span<const BodyIndex> bodies, std::span<Motion> motions, Answers& answers);
  void count_asked(std::uint64_t motions) noexcept { asked_ += motions; }
  bool asks_user_filter() const noexcept { return static_cast<bool>(pair_filter_); }
  void check_motion_bounds(MotionBoundViolationListener listener, double position_slack) {
    check_ = std::make_unique<MotionBoundCheck>(std::move(listener), position_slack);
  }
  const MotionBoundCheck* motion_bound_check() const noexcept { return check_.get(); }  // null: they are not checked
  void forget_motion_bound(BodyIndex body) noexcept {
    if (check_) check_->forget(body);
  }
  void ask_all(Step step);  // for their promises
  // Bodies whose motions were not valid when they were asked for, in the course of a call of advance().
  void refuse(BodyIndex body) { refused_.push_back(body); }
  std::vector<BodyIndex>& refused() noexcept { return refused_; }
  bool has_source() const noexcept { return static_cast<bool>(source_); }
  std::uint64_t asked() const noexcept { return asked_; }
  std::size_t memory_bytes() const noexcept;

 private:
  static constexpr std::uint32_t kNoSlot = 0xffffffffu;

  void ask_some(Step step, std::span<const BodyIndex> bodies, std::span<Motion> motions, Answers& answers) const;

  MotionSource source_;
  std::unique_ptr<MotionBoundCheck> check_;
  std::vector<std::uint32_t> generations_;  // by body; odd while there is one: each body has an odd number of its own
  std::vector<std::uint8_t> importance_;
  std::vector<BodyFilter> filters_;  // empty until a body has another than all
  PairFilter pair_filter_;
  std::vector<std::uint32_t> static_slot_;  // empty until there is a static body
  std::vector<Motion> static_motions_;
  std::vector<std::uint32_t> free_slots_;
  std::vector<BodyIndex> free_, refused_;
  Answers answers_;
  std::size_t size_ = 0;
  std::uint64_t asked_ = 0;
  void make_class(std::uint8_t importance) {
    if (in_class_.size() <= importance) in_class_.resize(std::size_t{importance} + 1);
  }
  void enter_class(std::uint8_t importance) noexcept { ++in_class_[importance]; }
  void leave_class(std::uint8_t importance) noexcept { --in_class_[importance]; }
  std::vector<std::uint32_t> in_class_;  // bodies, by class
};

// Undoes what has been done so far, unless all of it has been: what is between throws. (No `catch`: the run-time is
// built without exceptions as well.)
template <typename Undo>
class UndoUnlessDone {
 public:
  explicit UndoUnlessDone(const Undo& undo) : undo_(undo) {}
  UndoUnlessDone(const UndoUnlessDone&) = delete;
  UndoUnlessDone& operator=(const UndoUnlessDone&) = delete;
  ~UndoUnlessDone() {
    if (!done_) undo_();
  }
  void done() noexcept { done_ = true; }

 private:
  Undo undo_;
  bool done_ = false;
};

// Empties a vector and gives its memory back, which assigning {} does not.
template <typename T, typename Allocator>
void give_back(std::vector<T, Allocator>& v) noexcept {
  std::vector<T, Allocator>().swap(v);
}

// Starts loading what will be written soon. Part of its caller at once: GCC takes it for a function without effects,
// and leaves out what calls are left when it has found that.
ORCHARD_INLINE void prefetch(const void* where) noexcept {
#ifdef __GNUC__
  __builtin_prefetch(where, 1);
#else
  (void)where;
#endif
}

// All lines of an object.
template <typename T>
ORCHARD_INLINE void prefetch_all(const T& object) noexcept {
  constexpr std::size_t kLine = 64;
  const char* const begin = reinterpret_cast<const char*>(&object);
  for (std::size_t at = 0; at < sizeof(T); at += kLine) prefetch(begin + at);
}

template <typename... Vectors>
std::size_t bytes_of(const Vectors&... vectors) noexcept {
  return ((vectors.capacity() * sizeof(typename Vectors::value_type)) + ...);
}

inline std::size_t BodyPool::Answers::memory_bytes() const noexcept { return bytes_of(moving, motions); }

}  // namespace orchard::runtime::detail
