#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>

#include "collision/node_pairs.h"
#include "collision/pair_budget.h"
#include "collision/placed_trees.h"

namespace orchard::runtime {

namespace detail {
struct BlockHits;
}

// The search of a pair by levels of spheres (dissertation Fig. 5.4). At each level, it finds the pairs of nodes that
// meet, and bounds on the distance of the solids from them. Bounds are in the first tree's units. Precondition: the
// trees are placed.
class SphereLevels {
 public:
  struct Best {  // the pair with the smallest upper bound on the distance of the solids
    double bound = std::numeric_limits<double>::infinity();
    NodePair pair{0, 0};
  };
  enum class End : std::uint8_t { level, budget, room };  // what ended a call of refine(); room: there is too little

  bool reserve(std::size_t pairs) noexcept;  // makes room for so many pairs per level; false if there is no memory
  void clear() noexcept;
  void reset_tests() noexcept { tests_ = 0; }
  std::uint64_t tests() const noexcept { return tests_; }              // the number since reset_tests()
  void forget(double root_bound) noexcept;                             // drops what was found at other poses
  bool begin(const PlacedTrees& trees) noexcept;                       // with the roots; false if there is no room
  End refine(const PlacedTrees& trees, PairBudget& tracker) noexcept;  // goes on to the end of a level
  void give_up() noexcept;  // drops all pairs, for lack of room; the bounds so far stay valid
  bool have_inner() const noexcept { return inner_.size() > 0; }  // whether there is another level
  std::size_t pairs() const noexcept { return inner_.size() + settled_leaves_; }
  const Best& best() const noexcept { return best_; }
  double least_bound() const noexcept { return least_bound_; }  // the smallest bound of all pairs that met
  double pruned_gap() const noexcept { return pruned_gap_; }    // a lower bound on the distance of all other pairs
  static bool roots_are_leaves(const PlacedTrees& trees) noexcept;

 private:
  class PairList {  // a vector that does not grow by itself
   public:
    bool room_for(std::size_t more) const noexcept { return capacity_ - size_ >= more; }
    bool reserve(std::size_t capacity) noexcept;
    void push(NodePair pair) noexcept { pairs_[size_++] = pair; }
    void clear() noexcept { size_ = 0; }
    std::size_t size() const noexcept { return size_; }
    NodePair operator[](std::size_t i) const noexcept { return pairs_[i]; }

   private:
    std::unique_ptr<NodePair[]> pairs_;
    std::size_t size_ = 0, capacity_ = 0;
  };
  struct Cursor {  // where the level under way continues
    std::size_t pair = 0;
    std::uint32_t outer = 0, inner = 0;  // in the groups of the pair: the first lane, and the first row
  };
  struct Groups;
  void collect(const PlacedTrees& trees, const Groups& groups, const detail::BlockHits& hits) noexcept;
  void improve(const PlacedTrees& trees, NodePair pair, double square, bool leaves) noexcept;
  void start_level(const PlacedTrees& trees) noexcept;
  void finish_level(const PlacedTrees& trees) noexcept;

  PairList inner_, leaves_, next_;  // meeting pairs: with an inner node, of two leaves, and of the level under way
  std::size_t settled_leaves_ = 0;
  Cursor cursor_;
  detail::LevelState seen_{};
  Best level_best_, leaf_best_, best_;
  double least_bound_ = std::numeric_limits<double>::infinity();
  double pruned_gap_ = std::numeric_limits<double>::infinity();
  std::uint64_t tests_ = 0;
};

}  // namespace orchard::runtime
