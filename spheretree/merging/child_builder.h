#pragma once
#include <tbb/enumerable_thread_specific.h>

#include <span>
#include <vector>

#include "ball_fit.h"
#include "medial_parts.h"
#include "merger.h"
#include "orchard/spheretree/merging.h"

namespace orchard::detail {

// The surface points that a node must hold.
struct Portion {
  std::vector<Point> held;
  std::vector<Index> points;    // the axis's number of each point, or kNone for one that a closing added
  std::vector<Index> vertices;  // medial vertices, ascending; empty: all that touch one of the points

  std::vector<Index> axis_points() const;  // ascending
};

struct Child {
  Sphere sphere;
  Portion portion;
};

// Makes the children of a node of a merged tree from the node's portion. Many threads may use it at once.
class ChildBuilder {
 public:
  // Keeps references to its arguments.
  ChildBuilder(const Surface& surface, const MedialAxis& axis, const MergeOptions& options);

  void start_level(Index level);
  double power() const { return power_; }  // of the looseness, in a level's sum that is to be minimized

  Portion whole() const;  // the portion of the root
  std::vector<Child> children_of(const Portion& portion, Index max) const;
  std::vector<Child> resized(const Portion& portion, const std::vector<Child>& family, Index wanted) const;
  std::vector<Child> halves(const Child& child) const;  // two, or fewer where it cannot be split

  double looseness(const Sphere& ball) const { return ball.radius + surface_.signed_distance(ball.center); }
  bool tight(const Sphere& ball) const;  // whether a ball is so tight that it need not be divided
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
  std::vector<std::vector<Index>> vertices_of_;  // for each point, the medial vertices that touch it
  double power_ = 1;
  bool patient_ = true;  // see fit_siblings()
};

}  // namespace orchard::detail
