#include "slab_quadrics.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <queue>
#include <tuple>
#include <unordered_set>
#include <utility>
#include <vector>

#include "feet_by_vertex.h"
#include "protrusions.h"
#include "slab_planes.h"

namespace orchard::detail {
namespace {

constexpr double kPull = 1e-4;  // of the trace: weight of the middle of the edge, for directions without a plane
constexpr double kLengthWeight = 1e-6;  // weight of the length of an edge, so that shorter ones come first among equals
constexpr double kBorder = 1.0;         // weight of the square over a border edge
constexpr double kAsWhole = 2.0;        // a result within this many errors of the whole mesh is as good as the whole
constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr std::size_t kGuards = 4;  // one of so many samples is a guard, which suffices for slabs
constexpr double kFarthest = 2.0;   // the largest distance of a new ball from the middle of its edge, in edge lengths

class Contraction {
 public:
  Contraction(const Surface& surface, ContractibleMesh& mesh, std::span<const FitSample> samples, Assignment& feet,
              double free_distance, double limit)
      : surface_(surface),
        mesh_(mesh),
        origin_(mesh.size() > 0 ? mesh.ball(0) : Ball4::Zero()),
        feet_(mesh, samples, feet),
        free_distance_(free_distance),
        limit_(limit),
        min_length_(kLookSpacing * surface.bounding_radius()) {
    origin_[3] = 0;
  }

  void run(Index target, Index free_target) {
    quadrics_.resize(mesh_.size());
    stamp_.assign(mesh_.size(), 0);
    for (const auto& cell : mesh_.maximal_cells()) add_cell(cell);
    offer_all();
    while (mesh_.living() > free_target) {
      if (queue_.empty() && !offer_again(target)) break;
      if (queue_.empty()) break;
      const auto [cost, a, b, stamp] = queue_.top();
      queue_.pop();
      if (!mesh_.alive(a) || !mesh_.alive(b) || stamp != stamp_[a] + stamp_[b]) continue;
      if (!mesh_.adjacent(a, b) || waiting_.contains(key(a, b)) || !mesh_.may_contract(a, b)) continue;
      if (mesh_.living() <= target && distance_of(a, b) > free_distance_) continue;
      contract(a, b);
    }
  }

 private:
  using Entry = std::tuple<double, Index, Index, Index>;

  static std::uint64_t key(Index a, Index b) { return std::uint64_t{a} << 32 | b; }

  Ball4 local(Index vertex) const { return mesh_.ball(vertex) - origin_; }

  void add_cell(const std::array<Index, 3>& cell) {
    const auto& [a, b, c] = cell;
    if (b == a) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const double sign : {-1.0, 1.0}) quadrics_[a].add_plane(sign * Vector::Unit(axis), local(a), 1);
      }
    } else if (c == a) {
      add_cone(a, b);
    } else {
      add_slab(cell);
      for (const auto& [p, q, r] : {std::tuple{a, b, c}, std::tuple{b, c, a}, std::tuple{a, c, b}}) {
        if (mesh_.count_triangles_at(p, q) == 1) add_border(p, q, r);
      }
    }
  }

  // Adds both planes that touch all three balls.
  void add_slab(const std::array<Index, 3>& cell) {
    const Ball4 a = local(cell[0]), b = local(cell[1]), c = local(cell[2]);
    const Vector u = (b - a).head<3>(), v = (c - a).head<3>(), normal = u.cross(v);
    const double squared = normal.squaredNorm();
    if (!(squared > 0)) return;
    const Vector gradient = (b[3] - a[3]) / squared * v.cross(normal) + (c[3] - a[3]) / squared * normal.cross(u);
    const double steep = gradient.squaredNorm();
    if (steep >= 1) return;
    const Vector up = std::sqrt((1 - steep) / squared) * normal;
    const double area = 0.5 * std::sqrt(squared);
    for (const Index corner : cell) {
      quadrics_[corner].add_plane(up - gradient, a, area / 3);
      quadrics_[corner].add_plane(-up - gradient, a, area / 3);
    }
  }

  // Adds the plane that touches both balls and is perpendicular to the sheet on one side of them.
  void add_border(Index p, Index q, Index inner) {
    const Cone cone(local(p), local(q));
    if (!(cone.length > 0)) return;
    Vector out = (cone.a - local(inner)).head<3>();
    out -= cone.unit.dot(out) * cone.unit;
    if (!(out.norm() > 0) || std::abs(cone.slope) >= 1) return;
    const Vector normal = cone.normal(out.normalized());
    for (const Index v : {p, q}) quadrics_[v].add_plane(normal, cone.a, kBorder * cone.length * cone.length / 2);
  }

  // Adds four planes around a cone, and one at each free end.
  void add_cone(Index p, Index q) {
    const Cone cone(local(p), local(q));
    if (!(cone.length > 0)) return;
    const double square = cone.length * cone.length;
    if (std::abs(cone.slope) < 1) {
      const Vector side = across(cone.unit), other = cone.unit.cross(side);
      for (const Vector& out : {side, other, Vector(-side), Vector(-other)}) {
        for (const Index v : {p, q})
          quadrics_[v].add_plane(cone.normal(out), cone.a, cone.length * (cone.a[3] + cone.b[3]) / 8);
      }
    }
    if (mesh_.neighbors(p).size() == 1) quadrics_[p].add_plane(-cone.unit, cone.a, square);
    if (mesh_.neighbors(q).size() == 1) quadrics_[q].add_plane(cone.unit, cone.b, square);
  }

  // Returns the mean distance of the contracted ball of an edge from the planes of both ends.
  double distance_of(Index p, Index q) const {
    Quadric sum = quadrics_[p];
    sum += quadrics_[q];
    return sum.weight() > 0 ? std::sqrt(sum.at(best(p, q).first) / sum.weight()) : 0;
  }

  // Returns the best ball for both ends of an edge, and its cost.
  std::pair<Ball4, double> best(Index p, Index q) const {
    Quadric sum = quadrics_[p];
    sum += quadrics_[q];
    const Ball4 a = local(p), b = local(q), middle = 0.5 * (a + b);
    const double length = (b - a).norm();
    Ball4 found = middle;
    const double pull = kPull * sum.a.trace();
    if (pull > 0) {
      const Eigen::Matrix4d matrix = sum.a + pull * Eigen::Matrix4d::Identity();
      found = matrix.inverse() * (sum.b + pull * middle);
      if (found[3] < 0) {
        const Eigen::Matrix3d block = matrix.topLeftCorner<3, 3>();
        found.head<3>() = block.inverse() * (sum.b + pull * middle).head<3>();
        found[3] = 0;
      }
    }
    double cost = sum.at(found);
    if (!found.allFinite() || (found - middle).norm() > kFarthest * length)
      cost = std::numeric_limits<double>::infinity();
    for (const Ball4& other : {middle, a, b}) {
      const double value = sum.at(other);
      if (value < cost) {
        cost = value;
        found = other;
      }
    }
    return {found, cost + kLengthWeight * length * length * length * length};
  }

  // Offers the waiting edges again, with a higher limit. Returns false if there are none.
  bool offer_again(Index target) {
    if (waiting_.empty() || mesh_.living() <= target) return false;
    waiting_.clear();
    limit_ *= 2;
    offer_all();
    return true;
  }
  void offer_all() {
    for (Index v = 0; v < mesh_.size(); ++v) {
      for (const Index other : mesh_.neighbors(v)) {
        if (v < other) offer(v, other);
      }
    }
  }
  void offer(Index a, Index b) {
    const auto [p, q] = std::minmax(a, b);
    queue_.emplace(best(p, q).second, p, q, stamp_[p] + stamp_[q]);
  }

  void contract(Index a, Index b) {
    const std::vector<Index> seen = feet_.at_either(a, b);
    const std::optional<Ball4> found = ball_within_limit(a, b, seen);
    if (!found) {
      waiting_.insert(key(a, b));
      return;
    }
    const Ball4& ball = *found;
    quadrics_[a] += quadrics_[b];
    mesh_.contract(a, b, ball);
    feet_.contract(a, b, seen);
    stamp_[a] += stamp_[b] + 1;  // more than the stamp of any offer of an edge at a
    for (const Index other : mesh_.neighbors(a)) offer(a, other);
    // Edges that the link condition prevented may be free now.
    for (const Index other : mesh_.neighbors(a)) {
      for (const Index next : mesh_.neighbors(other)) {
        if (next > other && mesh_.adjacent(a, next)) offer(other, next);
      }
    }
  }

  // Returns the best ball if it is within the limit, otherwise an end of the edge if it costs as little. Along a
  // straight border or seam both ends cost nothing, but with one of them the sheet may fold over.
  std::optional<Ball4> ball_within_limit(Index a, Index b, std::span<const Index> samples) {
    const Ball4 ball = best(a, b).first + origin_;
    if (!too_far(a, b, ball, samples)) return ball;
    Quadric sum = quadrics_[a];
    sum += quadrics_[b];
    for (const Index end : {a, b}) {
      const Ball4& other = mesh_.ball(end);
      if (other == ball || sum.at(local(end)) > free_distance_ * free_distance_ * sum.weight()) continue;
      if (!too_far(a, b, other, samples)) return other;
    }
    return std::nullopt;
  }

  // Returns whether the ball would protrude beyond the limit, or whether one of these samples would be beyond the limit
  // and farther off than now.
  bool too_far(Index a, Index b, const Ball4& ball, std::span<const Index> samples) {
    if (limit_ == kNoLimit) return false;
    if (protrudes(ball)) return true;
    for (const Index v : {a, b}) {
      for (const Index other : mesh_.neighbors(v)) {
        if (other == a || other == b) continue;
        const Ball4& end = mesh_.ball(other);
        if ((end - ball).head<3>().norm() > min_length_ && protrudes(0.5 * (ball + end))) return true;
      }
    }
    const Ball4 of_a = mesh_.ball(a), of_b = mesh_.ball(b);
    mesh_.set_ball(a, ball);
    mesh_.set_ball(b, ball);
    const bool result = std::any_of(samples.begin(), samples.end(), [&](Index i) {
      const FitSample& sample = feet_.sample(i);
      const Foot& foot = feet_.foot(i);
      double value = foot_on(mesh_, foot.corners, sample.position).value + sample.depth;
      if (value > limit_) value = walk_to_foot(mesh_, sample.position, foot).value + sample.depth;
      return std::abs(value) > std::max(limit_, std::abs(foot.value));
    });
    mesh_.set_ball(a, of_a);
    mesh_.set_ball(b, of_b);
    return result;
  }

  bool protrudes(const Ball4& ball) const {
    return ball[3] > limit_ && surface_.closest_within(ball.head<3>(), ball[3] - limit_).triangle != kNone;
  }

  const Surface& surface_;
  ContractibleMesh& mesh_;
  Ball4 origin_;  // quadrics lose digits far from 0
  FeetByVertex feet_;
  const double free_distance_;
  double limit_;
  const double min_length_;                    // shorter edges are not tested in the middle
  std::unordered_set<std::uint64_t> waiting_;  // edges, by their ends, that wait for a higher limit
  std::vector<Quadric> quadrics_;
  std::vector<Index> stamp_;  // grows with each change of a vertex
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

// Returns the samples that are guards.
std::vector<FitSample> thinned(std::span<const FitSample> samples) {
  std::vector<FitSample> result;
  for (std::size_t i = 0; i < samples.size(); i += kGuards) result.push_back(samples[i]);
  return result;
}

}  // namespace

void contract_by_slabs(const Surface& surface, ContractibleMesh& mesh, std::span<const FitSample> samples, Index target,
                       Index free_target, double free_distance, double min_limit) {
  const std::vector<FitSample> guards = thinned(samples);
  Assignment feet;
  feet.find(mesh, guards);
  const double enough = std::max(kAsWhole * feet.max, free_distance);
  Contraction(surface, mesh, guards, feet, free_distance, min_limit).run(target, target);
  if (mesh.living() <= free_target) return;
  // Without guards, sheets may fold over and unfold again when only their corners are left, or may remain folded.
  ContractibleMesh free_mesh = mesh;
  Assignment free_feet = feet;
  Contraction(surface, free_mesh, guards, free_feet, free_distance, kNoLimit).run(mesh.living(), free_target);
  free_feet.find(free_mesh, guards);
  if (free_feet.max <= enough) {
    mesh = std::move(free_mesh);
    return;
  }
  Contraction(surface, mesh, guards, feet, free_distance, min_limit).run(mesh.living(), free_target);
}

}  // namespace orchard::detail
