#include "orchard/spheretree/verify.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "orchard/covering/inaccuracy.h"
#include "orchard/spheretree/certify.h"
#include "packed_nodes.h"

namespace orchard {
namespace {

// Roundings of a centre's sum, of a closest-point query and of a few comparisons, per unit of coordinate.
constexpr double kRounding = 0x1p-49;

class Verifier {
 public:
  Verifier(const Surface& surface, const runtime::PackedSphereTree& tree)
      : surface_(surface), tree_(tree), nodes_(packed_nodes(tree)), balls_(path_balls(tree)) {
    origin_ = Point(tree.origin[0], tree.origin[1], tree.origin[2]);
    rounding_ = kRounding * (origin_.norm() + surface.bounding_radius());
  }

  Verification run(const VerifyOptions& options, const Progress& progress) {
    result_.triangles = surface_.mesh().triangles.size();
    result_.nodes = nodes_.size();
    check_mesh(options);
    if (result_.same_mesh) check_triangles(options, progress);
    report_progress(progress, "verifying bounds", 0.5);
    check_bounds(options);
    return std::move(result_);
  }

 private:
  void add(const VerifyOptions& options, Violation violation) {
    if (result_.violations.size() < options.most_violations) result_.violations.push_back(std::move(violation));
  }

  // The exact level tests the stored triangles: they must be the surface's, and their corners as near as promised.
  void check_mesh(const VerifyOptions& options) {
    const TriangleMesh& mesh = surface_.mesh();
    const auto fail = [&](Index triangle, const Point& at, double amount) {
      result_.same_mesh = false;
      add(options, {Violation::Kind::other_mesh, kNone, triangle, at, amount});
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

  // For each triangle, the tree of those leaves alone that list it.
  void check_triangles(const VerifyOptions& options, const Progress& progress) {
    const Rows listed = leaves_listing();
    std::vector<Violation> found(result_.triangles);
    std::vector<char> bad(result_.triangles, 0);
    const std::size_t slice = std::max<std::size_t>(1024, result_.triangles / 50 + 1);
    for (std::size_t begin = 0; begin < result_.triangles; begin += slice) {
      report_progress(progress, "verifying cover",
                      0.5 * static_cast<double>(begin) / static_cast<double>(result_.triangles));
      tbb::parallel_for(begin, std::min<std::size_t>(result_.triangles, begin + slice), [&](std::size_t i) {
        bad[i] = !covered(static_cast<Index>(i), listed[static_cast<Index>(i)], found[i]);
      });
    }
    for (std::size_t i = 0; i < result_.triangles; ++i) {
      if (!bad[i]) continue;
      ++result_.triangles_uncovered;
      result_.worst_depth = std::max(result_.worst_depth, found[i].amount);
      add(options, found[i]);
    }
  }

  Rows leaves_listing() const {
    std::vector<std::vector<Index>> rows(result_.triangles);
    for (Index node = 0; node < nodes_.size(); ++node) {
      if (!balls_[node].leaf) continue;
      const auto [block, lane] = nodes_[node];
      const std::uint32_t first = tree_.blocks[block].first[lane];
      const std::uint32_t count = tree_.blocks[block].count[lane] & ~runtime::kLeafBit;
      for (std::uint32_t k = 0; k < count; ++k) rows[tree_.leaf_triangles[first + k]].push_back(node);
    }
    Rows listed;
    for (const auto& row : rows) {
      listed.items.insert(listed.items.end(), row.begin(), row.end());
      listed.close_row();
    }
    return listed;
  }

  bool covered(Index triangle, std::span<const Index> leaves, Violation& violation) const {
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
      balls.push_back(ball);
    }
    auto corners = surface_.corners(triangle);
    for (Point& corner : corners) corner -= origin_;
    const TriangleCover cover = cover_of_triangle(corners, balls);
    if (cover.covered) return true;
    violation = deepest(cover, balls);
    violation.triangle = triangle;
    violation.point += origin_;
    if (violation.node != kNone) violation.node = used[violation.node];
    return false;
  }

  // Of the points that the lemma names, the one farthest outside all path regions.
  static Violation deepest(const TriangleCover& cover, std::span<const PathBall> balls) {
    Violation worst{Violation::Kind::uncovered, kNone, kNone, cover.witness,
                    std::max(0.0, path_depth(cover.witness, balls))};
    for (const UncoveredArc& arc : cover.arcs)
      for (const Point& point : {arc.begin, arc.middle, arc.end}) {
        const double d = path_depth(point, balls);
        if (d > worst.amount || worst.node == kNone)
          worst = {worst.kind, arc.ball, kNone, point, std::max(d, worst.amount)};
      }
    return worst;
  }

  struct Missed {
    double center_distance = 0, distance_bound = 0;  // by how much; <= 0: proven
    Point farthest = Point::Zero();
  };

  void check_bounds(const VerifyOptions& options) {
    std::vector<Missed> missed(nodes_.size());
    tbb::parallel_for(std::size_t{0}, nodes_.size(), [&](std::size_t i) { missed[i] = missed_bounds(i); });
    for (Index i = 0; i < nodes_.size(); ++i) {
      if (missed[i].center_distance > 0) {
        ++result_.bounds_violated;
        const Point at = origin_ + balls_[i].center;
        add(options, {Violation::Kind::center_distance, i, kNone, at, missed[i].center_distance});
      }
      if (missed[i].distance_bound > 0) {
        ++result_.bounds_violated;
        add(options, {Violation::Kind::distance_bound, i, kNone, missed[i].farthest, missed[i].distance_bound});
      }
    }
  }

  // The cheap bound by the centre's distance first; only where it does not settle the matter, the search over the ball.
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

Verification verify(const Surface& surface, const runtime::PackedSphereTree& tree, const VerifyOptions& options,
                    const Progress& progress) {
  return Verifier(surface, tree).run(options, progress);
}

}  // namespace orchard
