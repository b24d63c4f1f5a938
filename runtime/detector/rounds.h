#pragma once
#include <chrono>

#include "orchard/runtime/body_pair.h"
#include "pair_records.h"
#include "sweep.h"

namespace orchard::runtime::detail {

// What is left of a step's budget.
class Purse {
 public:
  using Clock = std::chrono::steady_clock;
  explicit Purse(const FrameBudget& budget) noexcept : left_(budget.work), limited_(budget.work != FrameBudget{}.work) {
    if (budget.time < std::chrono::hours(24 * 365)) {  // more is no limit, and would overflow the clock
      timed_ = true;
      deadline_ = Clock::now() + budget.time;
    }
  }
  bool limited() const noexcept { return limited_ || timed_; }
  bool limited_in_work() const noexcept { return limited_; }
  std::uint64_t left() const noexcept { return left_; }
  void spend(std::uint64_t work) noexcept {
    spent_ += work;
    if (limited_) left_ -= std::min(work, left_);
  }
  std::uint64_t spent() const noexcept { return spent_; }
  bool late() const noexcept { return timed_ && Clock::now() >= deadline_; }
  std::chrono::nanoseconds time_left() const noexcept {
    return timed_ ? std::max(std::chrono::nanoseconds(0), std::chrono::nanoseconds(deadline_ - Clock::now()))
                  : FrameBudget{}.time;
  }
  bool empty() const noexcept { return left_ == 0 || late(); }
  // One of `among` equal shares of what is left, this one first.
  FrameBudget share(std::uint64_t among) const noexcept {
    FrameBudget part;
    if (limited_) part.work = left_ / among + (left_ % among != 0 ? 1 : 0);
    if (timed_) part.time = time_left() / static_cast<std::int64_t>(among);
    return part;
  }

 private:
  std::uint64_t left_, spent_ = 0;
  bool limited_, timed_ = false;
  Clock::time_point deadline_{};
};

// What a thread needs while it answers; and the queries that a budget has left unfinished within a step.
class Queries {
 public:
  // Room for `jobs` jobs at once and pairs of these shapes, so that no query allocates.
  void prepare(const ShapeTable& shapes, std::size_t shape_count, std::size_t jobs);
  std::size_t jobs() const noexcept { return scratches_.size(); }

  struct Scratch {
    Workspace workspace{0};
    std::uint64_t work = 0;
  };
  Scratch& scratch(std::size_t job) noexcept { return *scratches_[job]; }

  // Null once `most` are in use, or there is no memory.
  NarrowPhase* take(std::size_t most);
  void give_back_all() noexcept { used_ = 0; }
  std::size_t memory_bytes() const noexcept;

 private:
  static constexpr std::size_t kRoom = 128;  // meeting pairs of spheres a level: for bounds, not for answers
  std::vector<std::unique_ptr<Scratch>> scratches_;
  std::vector<std::unique_ptr<NarrowPhase>> pool_;
  std::size_t used_ = 0, seen_shapes_ = 0;
  PreparedTree deepest_;  // of all shapes: a query that has been bound to it allocates for no other
};

// Answers records at one step.
class Rounds {
 public:
  Rounds(const Places& places, Queries& queries, const Executor& executor, std::size_t most_unfinished) noexcept
      : places_(&places), queries_(&queries), executor_(&executor), most_unfinished_(most_unfinished) {}

  // Every record's part pairs to their end. Returns the work.
  std::uint64_t answer_all(RecordTable& records, std::span<const std::uint32_t> open, Step now);
  // As far as the purse goes. What is not answered has the answer maybe and is not Record::answered.
  void answer_within(RecordTable& records, std::span<const std::uint32_t> open, Step now, Purse& purse);
  // What happened between the step before and this one, for the records that can be swept.
  void sweep_all(RecordTable& records, std::span<const std::uint32_t> open, Purse& purse);
  std::size_t memory_bytes() const noexcept { return bytes_of(tasks_) + bytes_of(order_) + bytes_of(sweeps_); }

  void use(const Executor& executor) noexcept { executor_ = &executor; }

 private:
  struct Task {
    std::uint32_t sequence = 0;  // in the order of pairs, then of parts
    std::uint32_t record = 0, part_a = 0, part_b = 0;
    std::uint8_t importance = 0;
    std::uint32_t waited = 0;
    bool done = false, simple = false;
    bool started = false;  // `query` has been
    NarrowPhase* query = nullptr;
    std::uint64_t work = 0;  // of the last piece
    Verdict verdict;
  };
  void place(const Record& record, std::uint32_t part_a, std::uint32_t part_b, PlacedPair& pair) const noexcept;
  void answer_coherently(Record& record, Step now, Queries::Scratch& scratch) const noexcept;
  void answer(Record& record, Step now, Queries::Scratch& scratch) const noexcept;
  void sweep_one(Record& record, Queries::Scratch& scratch, std::uint64_t most) const noexcept;
  void make_tasks(const RecordTable& records, std::span<const std::uint32_t> open);
  void begin_tasks(Purse& purse, RecordTable& records);
  void order_open(std::size_t begin, std::size_t end, std::uint32_t least_waited, const RecordTable& records);
  void refine_once(std::uint64_t slice, bool by_level, std::uint64_t most, Purse& purse, RecordTable& records);
  void refine_class(std::size_t begin, std::size_t end, Purse& purse, RecordTable& records);
  void refine_one(Task& task, const Record& record, std::uint64_t slice, bool by_level,
                  std::chrono::nanoseconds time) const noexcept;
  void fold(RecordTable& records, std::span<const std::uint32_t> open, Step now);
  template <typename Work>
  void in_parallel(std::size_t count, Work&& work) const;

  const Places* places_;
  Queries* queries_;
  const Executor* executor_;
  std::size_t most_unfinished_;
  std::vector<Task> tasks_;
  std::vector<std::uint32_t> order_, sweeps_;
};

}  // namespace orchard::runtime::detail
