#pragma once
#include <optional>

#include "collision/pair_query.h"
#include "orchard/runtime/collide.h"

namespace orchard::runtime {

// collide_coherently() in two parts, for callers that have many pairs and not enough time: of one pair at two poses,
// which outlive it.
class CoherentPair {
 public:
  CoherentPair(Workspace& workspace, TreePair& pair, const Pose& a, const Pose& b) noexcept
      : narrow_(query_of(workspace.narrow)), pair_(pair), a_(a), b_(b) {}

  // Whether there is anything that recall() could tell by.
  static bool remembers(const TreePair& of) noexcept { return of.memory_.clearance > 0 || of.memory_.met; }
  // What is known without a search: that a clearance has lasted, or that the triangles that met last still do. False,
  // and `verdict` as it was, if that does not tell. Some 100 ns.
  bool recall(Verdict& verdict) noexcept;
  // The rest of collide_coherently(), to be asked after recall() has told nothing: first in the leaves of the triangles
  // that met last. "Maybe" where the budget ends it, which it exceeds by less than one pair of leaves; Verdict::work is
  // all of the search's.
  Verdict search(const Budget& budget = {}) noexcept;
  // That the workspace's NarrowPhase, bound to this very pair, has just answered for these poses: its verdict.
  Verdict remember() noexcept;

 private:
  bool find_rigid() noexcept;  // both, side by side
  const Pose& find_relative() noexcept;
  bool place_for_triangles() noexcept;
  TreePair::Witness in_order(const TreePair::Witness& w) const noexcept;  // of the bodies as of the trees, and back
  MeetingTriangles::Place last_place() const noexcept;

  PairQuery& narrow_;  // the workspace's
  DirectSearch direct_{narrow_};
  TreePair& pair_;
  const Pose &a_, &b_;
  TreePair::Memory& memory_ = pair_.memory_;

  bool placed_ = false;                // the workspace's NarrowPhase is bound and placed for triangles
  bool rigid_ = false;                 // both poses are, once that has been looked at
  std::optional<Pose> relative_ = {};  // of b in a's frame, likewise
};

}  // namespace orchard::runtime
