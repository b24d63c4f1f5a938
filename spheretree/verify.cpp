#include "orchard/spheretree/verify.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "orchard/covering/inaccuracy.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/spheretree/certify.h"
#include "packed_nodes.h"

namespace orchard {
namespace {

// The rounding errors of the sum of a centre, of a closest-point query and of a few comparisons, per unit of
// coordinate.
constexpr double kVerifyRounding = 0x1p-49;

void add(const VerifyOptions& options, Verification& result, Violation violation) {
  if (result.violations.size() < options.max_violations) result.violations.push_back(std::move(violation));
}

// A triangle that is not proven, and the balls on the boundary of its uncovered regions.
struct TriangleViolation {
  bool bad = false;
  Violation violation;
  std::vector<Index> nodes;
};

// Checks a triangle against all paths. The point of the violation is the one farthest outside all path regions, among
// the points that the lemma returns.
TriangleViolation check_all_paths(const Surface& surface, Index triangle, const PathForest& forest,
                                  const Point& origin) {
  auto corners = surface.corners(triangle);
  for (Point& corner : corners) corner -= origin;
  NearBalls near;
  forest.gather(corners, near);
  const TriangleCover cover = cover_of_triangle(corners, near.balls);
  TriangleViolation found{true, {Violation::Kind::uncovered, kNone, triangle, cover.witness, 0}, {}};
  if (cover.covered) found.violation.kind = Violation::Kind::unlisted;
  if (!cover.covered) found.violation.amount = std::max(0.0, forest.distance(cover.witness));
  for (const UncoveredArc& arc : cover.arcs) {
    found.nodes.push_back(near.original[arc.ball]);
    for (const Point& point : {arc.begin, arc.middle, arc.end}) {
      const double distance = forest.distance(point);
      if (distance <= found.violation.amount && found.violation.node != kNone) continue;
      found.violation.node = near.original[arc.ball];
      found.violation.point = point;
      found.violation.amount = std::max(distance, found.violation.amount);
    }
  }
  found.violation.point += origin;
  return found;
}

void report_triangles(const Surface& surface, const PathForest& forest, const Point& origin,
                      const std::vector<TriangleViolation>& found, const VerifyOptions& options, Verification& result) {
  std::vector<Index> uncovered;
  for (const TriangleViolation& one : found) {
    if (!one.bad) continue;
    add(options, result, one.violation);
    if (one.violation.kind == Violation::Kind::unlisted) {
      ++result.triangles_unlisted;
      continue;
    }
    uncovered.push_back(one.violation.triangle);
    result.uncovered_nodes.insert(result.uncovered_nodes.end(), one.nodes.begin(), one.nodes.end());
  }
  std::sort(result.uncovered_nodes.begin(), result.uncovered_nodes.end());
  result.uncovered_nodes.erase(std::unique(result.uncovered_nodes.begin(), result.uncovered_nodes.end()),
                               result.uncovered_nodes.end());
  result.triangles_uncovered = uncovered.size();
  if (uncovered.empty()) return;
  UncoveredPartOptions part;
  part.distance_tolerance.of_radius = 0.01 * tolerance::kTangent;
  result.uncovered = uncovered_part(surface, uncovered, forest, origin, part);
  result.uncovered.farthest += origin;
}

class Verifier {
 public:
  Verifier(const Surface& surface, const runtime::PackedSphereTree& tree)
      : surface_(surface), tree_(tree), nodes_(packed_nodes(tree)), balls_(path_balls(tree)) {
    origin_ = Point(tree.origin[0], tree.origin[1], tree.origin[2]);
    rounding_ = kVerifyRounding * (origin_.norm() + surface.bounding_radius());
  }

  Verification run(const VerifyOptions& options, const Progress& progress) {
    result_.triangles = surface_.mesh().triangles.size();
    result_.nodes = nodes_.size();
    check_mesh(options);
    if (result_.same_mesh) check_triangles(options, progress);
    find_max_bounds();
    report_progress(progress, "verifying bounds", 0.5);
    check_bounds(options);
    return std::move(result_);
  }

 private:
  // Checks that the stored triangles, which the exact level tests, are those of the surface, with corners within
  // vertex_error.
  void check_mesh(const VerifyOptions& options) {
    const TriangleMesh& mesh = surface_.mesh();
    const auto fail = [&](Index triangle, const Point& at, double amount) {
      result_.same_mesh = false;
      add(options, result_, {Violation::Kind::other_mesh, kNone, triangle, at, amount});
    };
    if (tree_.triangles.size() != mesh.triangles.size() || tree_.vertices.size() != mesh.vertices.size())
      return fail(kNone, origin_, 0);
    for (Index i = 0; i < mesh.triangles.size(); ++i)
      if (tree_.triangles[i] != mesh.triangles[i]) return fail(i, surface_.corners(i)[0], 0);
    for (Index i = 0; i < mesh.vertices.size(); ++i) {
      const auto& stored = tree_.vertices[i];
      const Vector exact = mesh.vertices[i] - origin_;
      const double moved = (exact - Vector(stored[0], stored[1], stored[2])).norm();
      if (moved > tree_.vertex_error + 0x1p-50 * exact.norm())
        return fail(surface_.triangles_around(i).empty() ? kNone : surface_.triangles_around(i)[0], mesh.vertices[i],
                    moved - tree_.vertex_error);
    }
  }

  // Checks each triangle against the tree of those leaves that list it.
  void check_triangles(const VerifyOptions& options, const Progress& progress) {
    const Rows listed = leaves_listing();
    const PathForest forest(balls_);
    std::vector<TriangleViolation> found(result_.triangles);
    const std::size_t slice = std::max<std::size_t>(1024, result_.triangles / 50 + 1);
    for (std::size_t begin = 0; begin < result_.triangles; begin += slice) {
      report_progress(progress, "verifying cover",
                      0.5 * static_cast<double>(begin) / static_cast<double>(result_.triangles));
      tbb::parallel_for(begin, std::min<std::size_t>(result_.triangles, begin + slice), [&](std::size_t i) {
        const auto triangle = static_cast<Index>(i);
        if (!covered(triangle, listed[triangle])) found[i] = check_all_paths(surface_, triangle, forest, origin_);
      });
    }
    report_triangles(surface_, forest, origin_, found, options, result_);
  }

  Rows leaves_listing() const {
    std::vector<std::vector<Index>> rows(result_.triangles);
    for (Index node = 0; node < nodes_.size(); ++node) {
      if (!balls_[node].leaf) continue;
      const auto [block, lane] = nodes_[node];
      for (const std::uint32_t triangle : runtime::listed_triangles(tree_, tree_.blocks[block].link[lane]))
        rows[triangle & ~runtime::kLeafBit].push_back(node);
    }
    Rows listed;
    for (const auto& row : rows) {
      listed.items.insert(listed.items.end(), row.begin(), row.end());
      listed.close_row();
    }
    return listed;
  }

  bool covered(Index triangle, std::span<const Index> leaves) const {
    std::vector<Index> used;
    for (Index leaf : leaves)
      for (Index node = leaf; node != kNone; node = balls_[node].parent) used.push_back(node);
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    std::vector<PathBall> balls;
    for (Index node : used) {
      PathBall ball = balls_[node];
      if (ball.parent != kNone)
        ball.parent = static_cast<Index>(std::lower_bound(used.begin(), used.end(), ball.parent) - used.begin());
      if (ball.leaf) ball.leaf = std::binary_search(leaves.begin(), leaves.end(), node);
      balls.push_back(ball);
    }
    auto corners = surface_.corners(triangle);
    for (Point& corner : corners) corner -= origin_;
    return triangle_covered(corners, balls);
  }

  void find_max_bounds() {
    std::vector<Index> level(nodes_.size(), 0);
    result_.max_bound.assign(tree_.depth + 1, 0);
    for (Index i = 0; i < nodes_.size(); ++i) {
      if (balls_[i].parent != kNone) level[i] = level[balls_[i].parent] + 1;
      const double bound = tree_.blocks[nodes_[i].block].error[nodes_[i].lane];
      double& max = result_.max_bound[std::min<Index>(level[i], tree_.depth)];
      max = std::max(max, bound);
    }
  }

  struct Missed {
    double center_distance = 0, distance_bound = 0;  // by how much each bound is too low; at most 0 if it is proven
    Point farthest = Point::Zero();
  };

  void check_bounds(const VerifyOptions& options) {
    std::vector<Missed> missed(nodes_.size());
    tbb::parallel_for(std::size_t{0}, nodes_.size(), [&](std::size_t i) { missed[i] = missed_bounds(i); });
    for (Index i = 0; i < nodes_.size(); ++i) {
      if (missed[i].center_distance > 0) {
        ++result_.bounds_violated;
        const Point at = origin_ + balls_[i].center;
        add(options, result_, {Violation::Kind::center_distance, i, kNone, at, missed[i].center_distance});
      }
      if (missed[i].distance_bound > 0) {
        ++result_.bounds_violated;
        add(options, result_,
            {Violation::Kind::distance_bound, i, kNone, missed[i].farthest, missed[i].distance_bound});
      }
    }
  }

  // Tries the bound from the distance of the centre first, and the search over the ball only if that does not decide.
  Missed missed_bounds(std::size_t i) const {
    const auto [block_index, lane] = nodes_[i];
    const runtime::SiblingBlock& block = tree_.blocks[block_index];
    const Sphere ball{origin_ + balls_[i].center, balls_[i].radius};
    const double distance = surface_.solid() ? surface_.signed_distance(ball.center) : surface_.distance(ball.center);
    Missed missed;
    missed.center_distance = distance + rounding_ - block.depth[lane];
    missed.farthest = ball.center;
    const double stored = block.error[lane];
    double proven = distance_bound(distance + rounding_, ball.radius);
    if (proven > stored && surface_.solid()) {
      const Bounds bounds = farthest_against(surface_, ball, stored - rounding_, missed.farthest);
      proven = bounds.upper + rounding_;
    }
    missed.distance_bound = proven - stored;
    return missed;
  }

  const Surface& surface_;
  const runtime::PackedSphereTree& tree_;
  std::vector<PackedNode> nodes_;
  std::vector<PathBall> balls_;
  Point origin_;
  double rounding_ = 0;
  Verification result_;
};

}  // namespace

bool Verification::only_tangent(double bounding_radius) const {
  return same_mesh && triangles_unlisted == 0 && bounds_violated == 0 && triangles_uncovered > 0 &&
         uncovered.distance.upper <= tolerance::kTangent * bounding_radius;
}

Verification verify(const Surface& surface, const runtime::PackedSphereTree& tree, const VerifyOptions& options,
                    const Progress& progress) {
  return Verifier(surface, tree).run(options, progress);
}

Verification verify_path_rule(const Surface& surface, std::span<const PathBall> balls, const VerifyOptions& options,
                              const Progress& progress) {
  Verification result;
  result.triangles = surface.mesh().triangles.size();
  result.nodes = balls.size();
  const PathForest forest(balls);
  std::vector<TriangleViolation> found(result.triangles);
  for (const UncoveredTriangle& one : surface_coverage(surface, balls, Point::Zero(), progress).uncovered)
    found[one.triangle] = check_all_paths(surface, one.triangle, forest, Point::Zero());
  report_triangles(surface, forest, Point::Zero(), found, options, result);
  return result;
}

}  // namespace orchard
