#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "detector/shapes.h"
#include "orchard/runtime/collide.h"

namespace orchard::runtime::detail {

// What a job needs while it answers pairs.
struct AnswerScratch {
  Workspace workspace{0};
  std::uint64_t work = 0;
};

// One scratch for each job, with room for pairs of all shapes, so that no query allocates.
class AnswerScratches {
 public:
  // Makes room for `jobs` jobs at once and pairs of these shapes; for sweeps, too, if there are any.
  void prepare(const ShapeTable& shapes, std::size_t jobs, bool sweeps);
  std::size_t size() const noexcept { return scratches_.size(); }
  AnswerScratch& operator[](std::size_t job) noexcept { return *scratches_[job]; }
  std::size_t memory_bytes() const noexcept;

 private:
  std::vector<std::unique_ptr<AnswerScratch>> scratches_;
  std::size_t seen_shapes_ = 0;
  bool sweeps_ = false;
  PreparedTree deepest_;  // of all shapes: a query that has been bound to it allocates for no other
};

}  // namespace orchard::runtime::detail
