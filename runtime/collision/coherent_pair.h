#pragma once
#include <optional>

#include "collision/pair_query.h"
#include "orchard/runtime/collide.h"

namespace orchard::runtime {

// collide_coherently() in two parts, recall() and search(), for callers that have many pairs and little time. An object
// is for one pair at two poses, which have to outlive it.
class CoherentPair {
 public:
  CoherentPair(Workspace& workspace, TreePair& pair, const Pose& a, const Pose& b) noexcept
      : narrow_(query_of(workspace.narrow)), pair_(pair), a_(a), b_(b) {}

  // Returns whether the pair remembers something that recall() can use.
  static bool remembers(const TreePair& of) noexcept { return of.memory_.clearance > 0 || of.memory_.met; }
  // Sets `verdict` to what is known without a search: "no" if the bodies have moved less than they were apart, or "yes"
  // if the triangles that met last still meet. Returns false, and leaves `verdict` as it is, if neither is so. Costs
  // about 100 ns.
  bool recall(Verdict& verdict) noexcept;
  // Does the rest of collide_coherently(). Call it after recall() has returned false. It searches the leaves of the
  // triangles that met last first. If the budget ends it, which it exceeds by less than the work of one pair of leaves,
  // the answer is "maybe". Verdict::work is that of the whole search.
  Verdict search(const Budget& budget = {}) noexcept;
  // Stores what the workspace's NarrowPhase has found for this pair at these poses, and returns its verdict.
  // Precondition: the NarrowPhase is bound to this pair and has just answered for these poses.
  Verdict remember() noexcept;

 private:
  bool find_rigid() noexcept;  // whether both poses are rigid
  const Pose& find_relative() noexcept;
  bool place_for_triangles() noexcept;
  TreePair::Witness in_order(
      const TreePair::Witness& w) const noexcept;  // from the bodies' order to the trees', or back
  MeetingTriangles::Place last_place() const noexcept;

  PairQuery& narrow_;  // of the workspace
  DirectSearch direct_{narrow_};
  TreePair& pair_;
  const Pose &a_, &b_;
  TreePair::Memory& memory_ = pair_.memory_;

  bool placed_ = false;                // narrow_ is bound and placed for triangles
  bool rigid_ = false;                 // both poses are known to be rigid
  std::optional<Pose> relative_ = {};  // the pose of b in the frame of a, once it has been computed
};

}  // namespace orchard::runtime
