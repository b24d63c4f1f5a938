#pragma once
#include "orchard/runtime/collide.h"

namespace orchard::runtime {

// collide_coherently() in two parts, for callers that have many pairs and not enough time.
struct CoherentPair {
  // What is known without a search: that a clearance has lasted, or that the triangles that met last still do. False,
  // and `verdict` as it was, if that does not tell. Some 100 ns.
  static bool recall(Workspace& workspace, TreePair& pair, const Pose& a, const Pose& b, Verdict& verdict) noexcept;
  // Whether there is anything that recall() could tell by.
  static bool remembers(const TreePair& pair) noexcept;
  // The rest of collide_coherently(), to be asked after recall() has told nothing. "Maybe" where the budget ends it,
  // which it exceeds by less than one pair of leaves; Verdict::work is all of the search's.
  static Verdict search(Workspace& workspace, TreePair& pair, const Pose& a, const Pose& b,
                        const Budget& budget = {}) noexcept;
  // That the workspace's NarrowPhase, bound to this very pair, has just answered for these poses.
  static void remember(Workspace& workspace, TreePair& pair, const Pose& a, const Pose& b) noexcept;
};

}  // namespace orchard::runtime
