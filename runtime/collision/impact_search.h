#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "collision/kernels/box_time.h"
#include "collision/pair_query.h"
#include "collision/workspace_scratch.h"
#include "math/vector_functions.h"
#include "orchard/runtime/time_of_impact.h"

namespace orchard::runtime::detail {

inline constexpr double kImpactRounding = 1e-12;  // of lengths in double

// One body's motion in the first tree's frame as it is at one time.
struct Turn {
  Vec3 center{}, axis{};
  double spin = 0, turning = 0;
  // How fast a point so far from the centre comes closer along u at most.
  double rate(const Vec3& u, double reach) const noexcept {
    return (spin * (length(cross(axis, u)) + kImpactRounding) + turning) * reach;
  }
  // The same seen from another frame's axes and origin.
  Turn from(const Pose& frame) const noexcept {
    return {turned_back(frame, minus(center, frame.translation)), turned_back(frame, axis), spin, turning};
  }
  Turning in_float() const noexcept {
    Turning result;
    for (std::size_t i = 0; i < 3; ++i) {
      result.center[i] = static_cast<float>(center[i]), result.axis[i] = static_cast<float>(axis[i]);
    }
    result.spin = static_cast<float>(spin * (1 + 1e-6)), result.turning = static_cast<float>(turning * (1 + 1e-6));
    return result;
  }
};

// Triangles that could meet nearly first.
struct Critical {
  double time;        // nothing meets before
  double cut = time;  // what surely does not meet before is left out, and counts for `time` with what is known of it
  double distance = std::numeric_limits<double>::infinity();
  double rate = 0;
  Vec3 on_first{}, on_second{};
  std::uint32_t triangle_first = kNoTriangle, triangle_second = kNoTriangle;
  double left_out = std::numeric_limits<double>::infinity();
  // Whether what meets at that time at the earliest need not be looked at.
  bool leaves(double earliest) noexcept {
    if (earliest < cut) return false;
    left_out = std::min(left_out, earliest);
    return true;
  }
};

// The search of time_of_impact(): a time after the other, each with the triangles that could meet next.
class ImpactSearch {
 public:
  ImpactSearch(Workspace& workspace, const TreePair& pair, const Travel& a, const Travel& b,
               const ImpactOptions& options) noexcept
      : workspace_(workspace),
        trees_(query_of(workspace.narrow).trees()),
        pair_(pair),
        a_(a),
        b_(b),
        options_(options) {}

  Impact run() noexcept;

 private:
  using Scratch = Workspace::Scratch;

  bool prepare() noexcept;
  bool place(double time) noexcept;
  bool find_critical(PairBudget& tracker, Critical& critical) noexcept;
  void expand(const PlacedViews& trees, const Scratch::TimedPair& top, Critical& critical) noexcept;
  void find_closing() noexcept;
  void compare_leaves(const PlacedViews& trees, const Scratch::TimedPair& top, Critical& critical) noexcept;
  struct Speeds {  // of two leaves: how fast anything comes closer, and how far they reach from where they turn about
    double fastest, first_reach, second_reach;
  };
  void compare_triangles(const TriangleBlock& lanes, std::uint32_t lane, const TriangleBlock& rows, std::uint32_t row,
                         const Speeds& speeds, Critical& critical) noexcept;
  double without_turning() const noexcept;
  void report(const Critical& critical) noexcept;
  void find_contact(PairBudget& tracker) noexcept;
  bool advance(PairBudget& tracker) noexcept;
  bool touching(PairBudget& tracker, double time) noexcept;
  const TreeView& first() const noexcept { return trees_.first().tree; }
  const TreeView& second() const noexcept { return trees_.second().tree; }

  Workspace& workspace_;
  PlacedTrees& trees_;  // of the workspace's query
  const TreePair& pair_;
  const Travel &a_, &b_;
  const ImpactOptions& options_;
  Impact result_;

  struct Motion {      // of both bodies at the time under way, in the first tree's units
    Vec3 velocity{};   // of the second one's centre less the first one's
    double speed = 0;  // and what is not known of it, at most
    Turn first, second;
    // The same in float, of the first tree's nodes against one of the second's, and the other way round.
    Closing of_first, of_second;
  };
  Motion motion_;
  struct Limits {  // lengths
    double margin = 0, tolerance = 0, finest = 0, error = 0;
  };
  Limits limits_;
  int near_ = 0;     // steps within the tolerance
  double soon_ = 0;  // a contact may be expected by then, from the last one
  std::array<float, 3> direction_{};
};

}  // namespace orchard::runtime::detail
