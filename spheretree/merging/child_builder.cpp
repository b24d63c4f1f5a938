#include "child_builder.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "orchard/geometry/tolerance.h"
#include "sibling_fit.h"

namespace orchard::detail {
namespace {

// If there are fewer vertices than this for each child, their points are merged instead of the vertices. Many points on
// one sphere, as around the axis of a cylinder, form a single vertex, which could not be divided.
constexpr std::size_t kVerticesPerChild = 2;
constexpr std::size_t kPointsPerChild = 2;  // at least this many for each child; otherwise there are fewer children
// As a fraction of R: tighter spheres are not changed.
constexpr double kTight = 1e-3;
// By level: the power of the looseness in the sum over siblings that is minimised. A loose ball at the top makes all
// levels below it loose.
constexpr double kPowers[] = {3.5, 3, 3};
// By level: the number of merged spheres with which a fit of siblings starts, over the number wanted.
constexpr double kStarts[] = {1.5, 1};

}  // namespace

std::vector<Index> Portion::axis_points() const {
  std::vector<Index> list;
  std::copy_if(points.begin(), points.end(), std::back_inserter(list), [](Index p) { return p != kNone; });
  std::sort(list.begin(), list.end());
  return list;
}

ChildBuilder::ChildBuilder(const Surface& surface, const MedialAxis& axis, const MergeOptions& options)
    : surface_(surface),
      axis_(axis),
      options_(options),
      margin_(tolerance::kCoverMargin * surface.bounding_radius()),
      scratch_([&axis] {
        return PartScratch{std::vector<Index>(axis.size(), kNone), std::vector<char>(axis.points.size(), 0)};
      }) {
  vertices_of_.resize(axis.points.size());
  for (Index v = 0; v < axis.size(); ++v)
    for (Index p : axis.forming_points[v]) vertices_of_[p].push_back(v);
}

void ChildBuilder::start_level(Index level) {
  power_ = kPowers[std::min<std::size_t>(level, std::size(kPowers)) - 1];
  patient_ = level == 1;
}

Portion ChildBuilder::whole() const {
  Portion portion;
  for (Index i = 0; i < axis_.size(); ++i) portion.vertices.push_back(i);
  for (Index p = 0; p < axis_.points.size(); ++p)
    if (!vertices_of_[p].empty()) add_point(p, portion);
  return portion;
}

bool ChildBuilder::tight(const Sphere& ball) const { return looseness(ball) <= kTight * surface_.bounding_radius(); }

void ChildBuilder::add_point(Index point, Portion& portion) const {
  portion.points.push_back(point);
  portion.held.push_back(axis_.points[point]);
}

double ChildBuilder::cost_of(const std::vector<Child>& family) const {
  double sum = 0;
  for (const Child& child : family)
    sum += std::pow(std::max(0.0, looseness(child.sphere)) / surface_.bounding_radius(), power_);
  return sum;
}

std::vector<Child> ChildBuilder::children_of(const Portion& portion, Index max) const {
  const std::vector<Index> points = portion.axis_points();
  if (points.size() < 2) return {};
  const std::vector<Index> vertices = portion.vertices.empty() ? touching(points) : portion.vertices;
  const std::size_t target = std::clamp<std::size_t>(points.size() / kPointsPerChild, 2, max);
  Parts parts = vertex_parts(axis_, vertices, points, scratch_.local());
  const bool by_points = parts.spheres.size() < kVerticesPerChild * target;
  if (by_points) parts = point_parts(axis_, points);
  if (options_.closing == MergeClosing::refit) return fitted(portion, parts, target);
  const auto groups = merge_parts(axis_, parts, {&target, 1})[0];
  return as_merged(parts, groups, by_points ? std::vector<Index>{} : vertices);
}

// Returns the vertices that touch any of the points.
std::vector<Index> ChildBuilder::touching(const std::vector<Index>& points) const {
  std::vector<Index> vertices;
  for (Index p : points) vertices.insert(vertices.end(), vertices_of_[p].begin(), vertices_of_[p].end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

// Returns a sphere around all points of each group of parts. Groups may have points in common.
std::vector<Child> ChildBuilder::as_merged(const Parts& parts, const std::vector<MergedParts>& groups,
                                           const std::vector<Index>& vertices) const {
  std::vector<Child> children;
  for (const MergedParts& group : groups) {
    Child child{group.sphere, {}};
    std::vector<Index> points;
    for (Index part : group.parts) {
      points.insert(points.end(), parts.points[part].begin(), parts.points[part].end());
      if (!vertices.empty()) child.portion.vertices.push_back(vertices[part]);
    }
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    for (Index p : points) add_point(p, child.portion);
    shrink_around(child.portion.held, child.sphere);
    child.sphere.radius += margin_;
    children.push_back(std::move(child));
  }
  return children;
}

// Fits siblings, also starting from more spheres than wanted: the fit decides better than the merging which of them to
// leave out.
std::vector<Child> ChildBuilder::fitted(const Portion& portion, const Parts& parts, std::size_t wanted) const {
  std::vector<std::size_t> targets;
  for (const double more : kStarts) targets.push_back(static_cast<std::size_t>(more * static_cast<double>(wanted)));
  std::vector<std::vector<FittedBall>> starts;
  for (const auto& groups : merge_parts(axis_, parts, targets)) {
    starts.emplace_back();
    for (const MergedParts& group : groups) starts.back().push_back(start_at(group.sphere.center));
  }
  return shared_out(portion, starts, wanted);
}

// Returns as many children as wanted, starting from a family of another size.
std::vector<Child> ChildBuilder::resized(const Portion& portion, const std::vector<Child>& family, Index wanted) const {
  std::vector<FittedBall> start;
  start.reserve(family.size());
  for (const Child& child : family) start.push_back(start_at(child.sphere.center));
  return shared_out(portion, {&start, 1}, wanted);
}

std::vector<Child> ChildBuilder::shared_out(const Portion& portion, std::span<const std::vector<FittedBall>> starts,
                                            std::size_t wanted) const {
  const Siblings siblings = fit_siblings(surface_, portion.held, starts, wanted, power_, patient_);
  std::vector<Child> children;
  for (const FittedBall& ball : siblings.balls) children.push_back({{ball.center, ball.radius + margin_}, {}});
  for (std::size_t i = 0; i < siblings.owner.size(); ++i) {
    Portion& own = children[siblings.owner[i]].portion;
    own.held.push_back(portion.held[i]);
    own.points.push_back(portion.points[i]);
  }
  return children;
}

std::vector<Child> ChildBuilder::halves(const Child& child) const {
  const std::vector<Point>& held = child.portion.held;
  if (held.size() < 2 * kPointsPerChild) return {};
  const Point& center = child.sphere.center;
  const Point& far = *std::max_element(held.begin(), held.end(), [&](const Point& p, const Point& q) {
    return (p - center).squaredNorm() < (q - center).squaredNorm();
  });
  const std::vector<FittedBall> two{start_at(center), start_at(far + 0.3 * (center - far))};
  return shared_out(child.portion, {&two, 1}, 2);
}

}  // namespace orchard::detail
