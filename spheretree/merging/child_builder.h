#pragma once
#include <tbb/enumerable_thread_specific.h>

#include <span>
#include <vector>

#include "ball_fit.h"
#include "medial_parts.h"
#include "merger.h"
#include "orchard/spheretree/merging.h"

namespace orchard::detail {

// What a node answers for: surface points that it must hold.
struct Portion {
  std::vector<Point> held;
  std::vector<Index> points;    // of each: of the axis, or kNone for one that a closing added
  std::vector<Index> vertices;  // of the axis, ascending, where they are not simply those that touch a point

  std::vector<Index> axis_points() const;  // ascending
};

struct Child {
  Sphere sphere;
  Portion portion;
};

// Makes the children of a node of a merged tree from the portion that the node answers for. For many threads at once.
class ChildBuilder {
 public:
  // Keeps references.
  ChildBuilder(const Surface& surface, const MedialAxis& axis, const MergeOptions& options);

  void start_level(Index level);
  double power() const { return power_; }  // of the looseness, in the sum over a level that is to be low

  Portion whole() const;  // the root's
  std::vector<Child> children_of(const Portion& portion, Index max) const;
  std::vector<Child> resized(const Portion& portion, const std::vector<Child>& family, Index wanted) const;
  std::vector<Child> halves(const Child& child) const;  // two, or fewer where it cannot be split

  double looseness(const Sphere& ball) const { return ball.radius + surface_.signed_distance(ball.center); }
  bool tight(const Sphere& ball) const;  // enough to be left as it is
  double cost_of(const std::vector<Child>& family) const;

 private:
  void add_point(Index point, Portion& portion) const;
  std::vector<Index> touching(const std::vector<Index>& points) const;
  std::vector<Child> as_merged(const Parts& parts, const std::vector<MergedParts>& groups,
                               const std::vector<Index>& vertices) const;
  std::vector<Child> fitted(const Portion& portion, const Parts& parts, std::size_t wanted) const;
  std::vector<Child> shared_out(const Portion& portion, std::span<const std::vector<FittedBall>> starts,
                                std::size_t wanted) const;
  FittedBall start_at(const Point& center) const { return {center, 0, surface_.signed_distance(center)}; }

  const Surface& surface_;
  const MedialAxis& axis_;
  const MergeOptions& options_;
  const double margin_;
  mutable tbb::enumerable_thread_specific<PartScratch> scratch_;
  std::vector<std::vector<Index>> vertices_of_;  // each point
  double power_ = 1;
  bool patient_ = true;  // see fit_siblings()
};

}  // namespace orchard::detail
