#pragma once
#include <memory>
#include <utility>

#include "broad_phase/clock.h"
#include "broad_phase/vectors.h"

namespace orchard::runtime::detail {

// The class of importance of each body; 0 is the highest. Here and in the classes below, all that may throw is in
// functions of its own (make_room()), so that the changes themselves cannot fail.
class ImportanceClasses {
 public:
  void make_room(std::size_t slots, std::uint8_t importance) {
    detail::make_room(of_body_, slots);
    make_room(importance);
  }
  void enter(BodyIndex body, std::uint8_t importance) noexcept {
    if (of_body_.size() <= body) of_body_.resize(std::size_t{body} + 1);
    of_body_[body] = importance;
    ++count_[importance];
  }
  void leave(BodyIndex body) noexcept { --count_[of_body_[body]]; }
  void change(BodyIndex body, std::uint8_t importance) {
    make_room(importance);
    leave(body);
    enter(body, importance);
  }
  std::uint8_t of(BodyIndex body) const noexcept { return of_body_[body]; }
  // A pair is as important as the less important of its bodies.
  std::uint8_t of(const BodyPair& pair) const noexcept { return std::max(of_body_[pair.a], of_body_[pair.b]); }
  // Returns the first class, from `from` on, that has bodies; kNoClass if there is none.
  unsigned next(unsigned from) const noexcept {
    while (from < count_.size() && count_[from] == 0) ++from;
    return from < count_.size() ? from : kNoClass;
  }
  std::size_t memory_bytes() const noexcept { return bytes_of(of_body_, count_); }

 private:
  void make_room(std::uint8_t importance) {
    if (count_.size() <= importance) count_.resize(std::size_t{importance} + 1);
  }
  std::vector<std::uint8_t> of_body_;
  std::vector<std::uint32_t> count_;  // by class: the number of its bodies
};

// The static bodies, and where they are.
class StaticBodies {
 public:
  bool any() const noexcept { return !slots_.empty(); }  // whether there has ever been one
  bool has(BodyIndex body) const noexcept { return any() && slots_[body] != kNoSlot; }
  const Motion* motion(BodyIndex body) const noexcept {  // null if it is not static; precondition: any()
    return slots_[body] == kNoSlot ? nullptr : &motions_[slots_[body]];
  }
  std::size_t count() const noexcept { return motions_.size() - free_.size(); }

  void make_room(std::size_t bodies, bool is_static) {
    if (is_static && free_.empty()) detail::make_room(motions_, motions_.size() + 1);
    if (is_static) detail::make_room(free_, free_.size() + 1);
    if (is_static || any()) detail::make_room(slots_, bodies);
  }
  void make_room_to_remove(BodyIndex body) {
    if (has(body)) detail::make_room(free_, free_.size() + 1);
  }
  // Adds a body to a pool that then has `bodies` slots. `place` is null if it is not static.
  void add(BodyIndex body, std::size_t bodies, const Motion* place) noexcept;
  void move(BodyIndex body, const Motion& place) noexcept;
  void remove(BodyIndex body) noexcept;
  std::size_t memory_bytes() const noexcept { return bytes_of(slots_, motions_, free_); }

 private:
  static constexpr std::uint32_t kNoSlot = 0xffffffffu;
  std::vector<std::uint32_t> slots_;  // by body: its index in motions_; empty until there is a static body
  std::vector<Motion> motions_;
  std::vector<std::uint32_t> free_;  // indices in motions_ that are not in use
};

// The filters of bodies and the filter function of the application. They exclude pairs; pairs of two static bodies are
// excluded elsewhere.
class PairFilters {
 public:
  void make_room(std::size_t bodies) { grow(of_body_, bodies); }
  void set(BodyIndex body, const BodyFilter& filter) noexcept { of_body_[body] = filter; }  // after make_room()
  void set_function(PairFilter function) noexcept { function_ = std::move(function); }
  BodyFilter of(BodyIndex body) const noexcept { return of_body_.empty() ? BodyFilter{} : of_body_[body]; }
  bool any_of_bodies() const noexcept { return !of_body_.empty(); }
  bool has_function() const noexcept { return static_cast<bool>(function_); }
  bool function_allows(BodyId a, BodyId b) const { return !function_ || function_(a, b); }
  std::size_t memory_bytes() const noexcept { return bytes_of(of_body_); }

 private:
  std::vector<BodyFilter> of_body_;  // by body; empty until a body has another filter than the default
  PairFilter function_;
};

class BodyPool;

// Asks the application for motions, and checks their bounds if that is wanted.
class MotionQueries {
 public:
  MotionQueries(const BodyPool& pool, MotionSource source) : pool_(pool), source_(std::move(source)) {}

  bool has_source() const noexcept { return static_cast<bool>(source_); }
  // Sets motions[i] to the motion of bodies[i] at the step.
  void ask(Step step, std::span<const BodyIndex> bodies, std::span<Motion> motions);
  // Does the same for one of several threads that ask at the same time, each with `answers` of its own. It does not
  // count the motions. If bounds are checked, only one thread may ask at a time.
  struct Answers {
    std::vector<BodyIndex> moving;
    std::vector<Motion> motions;
    std::size_t memory_bytes() const noexcept { return bytes_of(moving, motions); }
  };
  void ask(Step step, std::span<const BodyIndex> bodies, std::span<Motion> motions, Answers& answers);
  void ask_all(Step step);  // asks for all moving bodies, to check their motion bounds
  void count_asked(std::uint64_t motions) noexcept { asked_ += motions; }
  std::uint64_t asked() const noexcept { return asked_; }
  void check_bounds(MotionBoundViolationListener listener, double position_slack) {
    check_ = std::make_unique<MotionBoundCheck>(std::move(listener), position_slack);
  }
  const MotionBoundCheck* check() const noexcept { return check_.get(); }  // null: bounds are not checked
  void forget_bound(BodyIndex body) noexcept {
    if (check_) check_->forget(body);
  }
  // The bodies whose motions were not valid when they were asked for, in this call of advance().
  void refuse(BodyIndex body) { refused_.push_back(body); }
  std::vector<BodyIndex>& refused() noexcept { return refused_; }
  std::size_t memory_bytes() const noexcept;

 private:
  void ask_some(Step step, std::span<const BodyIndex> bodies, std::span<Motion> motions, Answers& answers) const;

  const BodyPool& pool_;
  MotionSource source_;
  std::unique_ptr<MotionBoundCheck> check_;
  Answers answers_;
  std::vector<BodyIndex> refused_;
  std::uint64_t asked_ = 0;
};

// The bodies of a broad phase, and what is known of them between steps.
class BodyPool {
 public:
  BodyPool(MotionSource source, const Clock& steps) : clock(steps), motions(*this, std::move(source)) {}
  BodyPool(const BodyPool&) = delete;
  BodyPool& operator=(const BodyPool&) = delete;

  const Clock clock;
  ImportanceClasses classes;
  StaticBodies statics;
  PairFilters filters;
  MotionQueries motions;

  // A change that throws, for lack of memory, changes nothing.
  // Adds a body, which is static if `place` is not null. Returns kNoIndex if the pool is full.
  BodyIndex add(std::uint8_t importance, const BodyFilter& filter, const Motion* place);
  void make_room_to_remove(BodyIndex body);
  void remove(BodyIndex body) noexcept;  // after make_room_to_remove(), or just after add()

  std::size_t slots() const noexcept { return generations_.size(); }  // all indices are below this
  std::size_t size() const noexcept { return size_; }
  bool alive(BodyIndex body) const noexcept { return generations_[body] % 2 != 0; }
  BodyId id_of(BodyIndex body) const noexcept { return {body, generations_[body]}; }
  // Returns whether some pairs may be excluded.
  bool filters_pairs() const noexcept { return statics.any() || filters.any_of_bodies() || filters.has_function(); }
  bool may_pair(const BodyPair& pair) const {
    if (statics.any() && statics.has(pair.a) && statics.has(pair.b)) return false;
    if (filters.any_of_bodies()) {
      const BodyFilter a = filters.of(pair.a), b = filters.of(pair.b);
      if (!runtime::may_pair(a, b)) return false;
      if ((a.ignores_static && statics.has(pair.b)) || (b.ignores_static && statics.has(pair.a))) return false;
    }
    return filters.function_allows(id_of(pair.a), id_of(pair.b));
  }
  std::size_t memory_bytes() const noexcept;

 private:
  std::vector<std::uint32_t> generations_;  // by index; odd while a body has the index, and different for each body
  std::vector<BodyIndex> free_;
  std::size_t size_ = 0;
};

}  // namespace orchard::runtime::detail
