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

inline constexpr double kImpactRounding = 1e-12;  // the relative rounding error of lengths in double

// The rotation of one body at one time, in the first tree's frame. The members mean the same as those of Turning
// (kernels/box_time.h).
struct Turn {
  Vec3 center{}, axis{};
  double spin = 0, turning = 0;
  // Returns a bound on the speed along u of a point whose distance from the centre is at most `reach`.
  double rate(const Vec3& u, double reach) const noexcept {
    return (spin * (length(cross(axis, u)) + kImpactRounding) + turning) * reach;
  }
  // Returns the same rotation in the axes and with the origin of another frame.
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

// Two triangles that could be the first to meet, or nearly so. Times count from the time under way.
struct Critical {
  double time;        // a lower bound on the time at which these triangles can meet
  double cut = time;  // triangles that certainly do not meet before this are left out
  double distance = std::numeric_limits<double>::infinity();
  double rate = 0;  // a bound on how fast they come closer
  Vec3 on_first{}, on_second{};
  std::uint32_t triangle_first = kNoTriangle, triangle_second = kNoTriangle;
  double left_out = std::numeric_limits<double>::infinity();  // a lower bound for everything that was left out
  // Returns whether something that meets at `earliest` or later can be left out, and notes that time if so.
  bool leaves(double earliest) noexcept {
    if (earliest < cut) return false;
    left_out = std::min(left_out, earliest);
    return true;
  }
};

// The search of time_of_impact(), by conservative advancement: at each time, it finds the triangles that could meet
// next, and goes on to the time before which nothing can meet.
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
  struct Speeds {  // of two leaves: a bound on all speeds of approach, and their reach from their centres of rotation
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
  PlacedTrees& trees_;  // of the query of the workspace
  const TreePair& pair_;
  const Travel &a_, &b_;
  const ImpactOptions& options_;
  Impact result_;

  struct Motion {      // of both bodies at the time under way, in the first tree's units
    Vec3 velocity{};   // the velocity of the second one's centre relative to that of the first one
    double speed = 0;  // a bound on the error of that
    Turn first, second;
    // The same in float, for box_times() with eight nodes of the first tree, and with eight of the second one.
    Closing of_first, of_second;
  };
  Motion motion_;
  struct Limits {  // lengths
    double margin = 0, tolerance = 0, finest = 0, error = 0;
  };
  Limits limits_;
  int near_ = 0;     // the number of steps within the tolerance
  double soon_ = 0;  // the time by which a contact may be expected, from the last step
  std::array<float, 3> direction_{};
};

}  // namespace orchard::runtime::detail
