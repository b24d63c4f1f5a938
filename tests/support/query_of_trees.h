#pragma once
#include "orchard/runtime/distance.h"
#include "orchard/runtime/narrow_phase.h"

// Queries that keep what they prepare of their trees.
namespace orchard::runtime::test {

struct TwoPreparedTrees {
  TwoPreparedTrees(const TreeView& a, const TreeView& b) : prepared_a(a), prepared_b(b) {}
  TwoPreparedTrees(const TwoPreparedTrees&) = delete;  // the query refers to them
  TwoPreparedTrees& operator=(const TwoPreparedTrees&) = delete;
  PreparedTree prepared_a, prepared_b;
};

struct OwnNarrowPhase : private TwoPreparedTrees, public NarrowPhase {
  OwnNarrowPhase(const TreeView& a, const TreeView& b, std::size_t room = kDefaultRoom)
      : TwoPreparedTrees(a, b), NarrowPhase(prepared_a, prepared_b, room) {}
};

struct OwnDistanceQuery : private TwoPreparedTrees, public DistanceQuery {
  OwnDistanceQuery(const TreeView& a, const TreeView& b)
      : TwoPreparedTrees(a, b), DistanceQuery(prepared_a, prepared_b) {}
};

}  // namespace orchard::runtime::test
