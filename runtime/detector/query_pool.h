#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "collision/pair_query.h"
#include "detector/shapes.h"
#include "orchard/runtime/collide.h"

namespace orchard::runtime::detail {

// What a thread needs while it answers; and the queries that a budget has left unfinished within a step.
class QueryPool {
 public:
  // Room for `jobs` jobs at once and pairs of these shapes, so that no query, and if there are sweeps, none of these,
  // allocates.
  void prepare(const ShapeTable& shapes, std::size_t shape_count, std::size_t jobs, bool sweeps);
  std::size_t jobs() const noexcept { return scratches_.size(); }

  struct Scratch {
    Workspace workspace{0};
    std::uint64_t work = 0;
  };
  Scratch& scratch(std::size_t job) noexcept { return *scratches_[job]; }

  // Null once `most` are in use, or there is no memory.
  PairQuery* take(std::size_t most);
  void give_back_all() noexcept { used_ = 0; }
  std::size_t memory_bytes() const noexcept;

 private:
  static constexpr std::size_t kRoom = 128;  // meeting pairs of spheres a level: for bounds, not for answers
  std::vector<std::unique_ptr<Scratch>> scratches_;
  std::vector<std::unique_ptr<PairQuery>> pool_;
  std::size_t used_ = 0, seen_shapes_ = 0;
  bool sweeps_ = false;
  PreparedTree deepest_;  // of all shapes: a query that has been bound to it allocates for no other
};

}  // namespace orchard::runtime::detail
