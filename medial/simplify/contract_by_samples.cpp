// The search, its moves and their costs share one state, hence a little more than 300 lines in one file.
#include "contract_by_samples.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "feet_by_vertex.h"
#include "opened_link.h"
#include "protrusion_cost.h"
#include "shape_cost.h"

namespace orchard::detail {
namespace {

constexpr double kExpected = 0.5;   // of an edge's earlier cost: it is evaluated again when its turn comes with this
constexpr double kToMiddle = 1e-3;  // of the trace: weight of the term that draws the ball to the middle of the edge
// A part of the largest distance at the beginning. A triangle without area counts as if a part of the surface, which is
// as large as one triangle's share of all, were off by this.
constexpr double kDegenerateCost = 0.5;

// The ball to which an edge may be contracted, and what that costs.
struct ContractionCandidate {
  double cost = 0;
  Ball4 ball = Ball4::Zero();
};

class SampledContraction {
 public:
  SampledContraction(const Surface& surface, ContractibleMesh& mesh, std::span<const FitSample> samples,
                     Assignment& feet, const ContractionOptions& options)
      : surface_(surface),
        mesh_(mesh),
        medial_(options.balls == SimplifiedBalls::medial),
        error_(feet.max),
        feet_(mesh, samples, feet),
        shape_(mesh),
        shape_weight_(options.keeps_shape ? fourth(kDegenerateCost * feet.max) : 0),
        protrusion_(surface, mesh, LookOptions(surface, samples[0].weight), kNegligible * feet.max),
        blocked_(mesh.size()) {
    stamp_.assign(mesh.size(), 0);
  }

  void run(Index target) {
    offer_all();
    while (mesh_.living() > target && !turns_.empty()) {
      const Turn turn = turns_.top();
      turns_.pop();
      const auto& [cost, a, b, stamp, kind] = turn;
      if (!mesh_.alive(a) || !mesh_.alive(b) || !mesh_.adjacent(a, b)) continue;
      if (stamp != stamp_[a] + stamp_[b]) {
        offer(a, b);
      } else if (kind == Kind::expected) {
        look_opened(a, b);
      } else if (kind == Kind::opened) {
        contract_opened(a, b);
      } else if (!mesh_.may_contract(a, b)) {
        offered_[key(a, b)].stamp = kNone;
        blocked_[a].push_back(b);
        blocked_[b].push_back(a);
        offer_opened(a, b, cost);
      } else if (kind == Kind::of_samples) {
        const ContractionCandidate found = candidate(a, b);
        double& added = offered_[key(a, b)].cost;
        added = added_cost(a, b, found.ball);
        turns_.emplace(found.cost + added, a, b, stamp, Kind::whole);
      } else {
        contract(a, b);
      }
    }
  }

 private:
  // What the cost of a queued edge contains. of_samples: only the samples' part. whole: also what protrudes, which is
  // computed only when the edge's turn comes, since it takes longest. For edges that the link condition forbids:
  // expected: an estimate from the last time; opened: the cost of removing triangles first.
  enum class Kind : std::uint8_t { of_samples, whole, expected, opened };
  // The cost, the edge, and the sum of its ends' stamps when the cost was computed.
  using Turn = std::tuple<double, Index, Index, Index, Kind>;

  // The sum of an edge's stamps when it was evaluated, and the cost found then, which may have changed since.
  struct Known {
    Index stamp = kNone;
    double cost = 0;
  };
  static std::uint64_t key(Index a, Index b) { return std::uint64_t{a} << 32 | b; }

  // A sample's foot as a function of the common ball: the contribution of other balls, and the weight of this one.
  struct Part {
    const FitSample* sample;
    Ball4 rest;
    double share;

    double value(const Ball4& ball) const {
      const Ball4 foot = rest + share * ball;
      return (sample->position - foot.head<3>()).norm() - foot[3] + sample->depth;
    }
  };

  void offer_all() {
    std::vector<std::array<Index, 2>> edges;
    for (Index v = 0; v < mesh_.size(); ++v) {
      for (const Index other : mesh_.neighbors(v)) {
        if (v < other) edges.push_back({v, other});
      }
    }
    std::vector<double> costs(edges.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, edges.size(), 32), [&](const auto& range) {
      for (std::size_t i = range.begin(); i != range.end(); ++i) costs[i] = candidate(edges[i][0], edges[i][1]).cost;
    });
    for (std::size_t i = 0; i < edges.size(); ++i)
      turns_.emplace(costs[i], edges[i][0], edges[i][1], 0, Kind::of_samples);
  }
  // Queues an edge with its cost, unless it is queued since its last change.
  void offer(Index a, Index b) {
    const auto [p, q] = std::minmax(a, b);
    const Index stamp = stamp_[p] + stamp_[q];
    Known& offered = offered_[key(p, q)];
    if (offered.stamp == stamp) return;
    offered.stamp = stamp;
    turns_.emplace(candidate(p, q).cost + kExpected * std::max(0.0, offered.cost), p, q, stamp, Kind::of_samples);
  }

  ContractionCandidate candidate(Index a, Index b) const {
    const std::vector<Index> seen = feet_.at_either(a, b);
    const Ball4 middle = 0.5 * (mesh_.ball(a) + mesh_.ball(b));
    std::vector<Part> parts;
    parts.reserve(seen.size());
    double before = 0;
    for (const Index i : seen) {
      parts.push_back(part(i, a, b));
      before += feet_.sample(i).weight * fourth(feet_.foot(i).value);
    }
    ContractionCandidate best{.cost = std::numeric_limits<double>::infinity()};
    const auto allowed = [&](const Ball4& ball) { return medial_ ? medial_ball(surface_, ball, error_) : ball; };
    for (const Ball4& ball : {allowed(optimum(parts, middle)), allowed(middle), mesh_.ball(a), mesh_.ball(b)}) {
      double cost = -before;
      for (const Part& p : parts) cost += p.sample->weight * fourth(p.value(ball));
      if (cost < best.cost) best = {cost, ball};
    }
    return best;
  }

  // The part of the cost that samples do not show: protrusion, and worse triangles.
  double added_cost(Index a, Index b, const Ball4& ball) {
    const double protruding = kProtrusionWeight * feet_.sample(0).weight * protrusion_.added(a, b, ball);
    return shape_weight_ > 0 ? protruding + shape_weight_ * shape_.added(a, b, ball) : protruding;
  }

  // Queues an edge that the link condition forbids. `min_cost` is the least that it costs.
  void offer_opened(Index a, Index b, double min_cost) {
    const Index stamp = stamp_[a] + stamp_[b];
    Known& opened = opened_[key(a, b)];
    if (opened.stamp == stamp) return;
    opened.stamp = stamp;
    const double expected = kExpected * opened.cost;
    if (expected > min_cost) {
      turns_.emplace(expected, a, b, stamp, Kind::expected);
    } else {
      look_opened(a, b);
    }
  }
  // Finds what it costs to remove triangles and then contract the edge, and queues the edge with that. The mesh is the
  // same afterwards.
  void look_opened(Index a, Index b) {
    const auto collapses = open_link(mesh_, a, b);
    if (!collapses) return;
    const auto moved = samples_on(*collapses);
    double cost = 0;
    for (const auto& [i, foot] : moved) cost -= feet_.sample(i).weight * fourth(foot.value);
    move_feet(moved);
    for (const auto& [i, foot] : moved) cost += feet_.sample(i).weight * fourth(feet_.foot(i).value);
    const ContractionCandidate found = candidate(a, b);
    cost += found.cost + added_cost(a, b, found.ball);
    undo(mesh_, *collapses);
    for (const auto& [i, foot] : moved) feet_.set_foot(i, foot);
    opened_[key(a, b)].cost = cost;
    turns_.emplace(cost, a, b, stamp_[a] + stamp_[b], Kind::opened);
  }
  void contract_opened(Index a, Index b) {
    const auto collapses = open_link(mesh_, a, b);
    if (!collapses) return;
    move_feet(samples_on(*collapses));
    for (const auto& [p, q, r] : *collapses) {
      for (const Index v : {p, q, r}) ++stamp_[v];
    }
    contract(a, b);
    for (const auto& [p, q, r] : *collapses) {
      for (const Index v : {p, q, r}) {
        if (mesh_.alive(v)) offer_around(v);
      }
    }
  }
  // The samples whose feet are on removed cells, and these feet.
  std::vector<std::pair<Index, Foot>> samples_on(std::span<const Collapse> collapses) const {
    std::vector<std::pair<Index, Foot>> result;
    for (const auto& [a, b, c] : collapses) {
      for (const Index i : feet_.at(a)) {
        const Foot& foot = feet_.foot(i);
        const auto has = [&](Index v) {
          return std::find(foot.corners.begin(), foot.corners.end(), v) != foot.corners.end();
        };
        const bool gone = has(b) && (has(c) || foot.corners[2] == foot.corners[0] ||
                                     foot.corners[2] == foot.corners[1] || foot.corners[1] == foot.corners[0]);
        if (gone) result.emplace_back(i, foot);
      }
    }
    std::sort(result.begin(), result.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
    result.erase(
        std::unique(result.begin(), result.end(), [](const auto& x, const auto& y) { return x.first == y.first; }),
        result.end());
    return result;
  }
  void move_feet(const std::vector<std::pair<Index, Foot>>& moved) {
    for (const auto& [i, foot] : moved) {
      const auto heaviest = std::max_element(foot.weights.begin(), foot.weights.end()) - foot.weights.begin();
      const Index corner = foot.corners[static_cast<std::size_t>(heaviest)];
      const Foot at{.corners = {corner, corner, corner}, .weights = {1, 0, 0}};
      feet_.set_foot(i, walk_to_foot(mesh_, feet_.sample(i).position, at).below(feet_.sample(i).depth));
    }
  }
  void contract(Index a, Index b) {
    const std::vector<Index> seen = feet_.at_either(a, b);
    const Ball4 ball = candidate(a, b).ball;
    mesh_.contract(a, b, ball);
    feet_.contract(a, b, seen);
    // The costs of neighbouring edges may have changed. They are computed again when their turn comes.
    stamp_[a] += stamp_[b] + 1;
    std::vector<Index> around(mesh_.neighbors(a).begin(), mesh_.neighbors(a).end());
    for (const Index other : around) ++stamp_[other];
    for (const Index other : around) offer(a, other);
    around.push_back(a);
    around.push_back(b);
    for (const Index v : around) offer_blocked(v);
  }
  // Queues edges again that the link condition forbade: they may be allowed now.
  void offer_blocked(Index v) {
    const std::vector<Index> ends = std::exchange(blocked_[v], {});
    for (const Index end : ends) {
      if (mesh_.alive(v) && mesh_.alive(end) && mesh_.adjacent(v, end)) offer(v, end);
    }
  }
  void offer_around(Index v) {
    for (const Index other : mesh_.neighbors(v)) offer(v, other);
    offer_blocked(v);
  }

  Part part(Index sample, Index a, Index b) const {
    const Foot& foot = feet_.foot(sample);
    Part part{&feet_.sample(sample), Ball4::Zero(), 0};
    for (std::size_t k = 0; k < 3; ++k) {
      if (foot.corners[k] == a || foot.corners[k] == b) {
        part.share += foot.weights[k];
      } else {
        part.rest += foot.weights[k] * mesh_.ball(foot.corners[k]);
      }
    }
    return part;
  }

  // The ball with the least sum of squares of the samples' values, linearized at the middle.
  Ball4 optimum(const std::vector<Part>& parts, const Ball4& middle) const {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
    Ball4 side = Ball4::Zero();
    for (const Part& p : parts) {
      const Ball4 foot = p.rest + p.share * middle;
      const Vector way = p.sample->position - foot.head<3>();
      const double length = way.norm();
      Ball4 row;
      row << (length > 0 ? Vector(way / length) : p.sample->normal), 1;
      const double weight = p.sample->weight * p.share;
      matrix += weight * p.share * row * row.transpose();
      side += weight * (length - foot[3] + p.sample->depth) * row;
    }
    const double pull = kToMiddle * matrix.trace();
    if (!(pull > 0)) return middle;
    matrix += pull * Eigen::Matrix4d::Identity();
    Ball4 ball = middle + matrix.inverse() * side;
    if (ball[3] < 0) {
      const Eigen::Matrix3d block = matrix.topLeftCorner<3, 3>();
      const Vector rest = (side + matrix.col(3) * middle[3]).head<3>();
      ball.head<3>() = middle.head<3>() + block.inverse() * rest;
      ball[3] = 0;
    }
    return ball.allFinite() ? ball : middle;
  }

  const Surface& surface_;
  ContractibleMesh& mesh_;
  const bool medial_;
  const double error_;  // mesh units: the most that the radius of a medial ball may be off
  FeetByVertex feet_;
  const ShapeCost shape_;
  const double shape_weight_;  // 0: worse triangles cost nothing
  ProtrusionCost protrusion_;
  std::vector<std::vector<Index>> blocked_;  // for each vertex, the other ends of edges that the link condition forbade
  // By edge. offered_: the stamp when it was queued, and the cost that protrusion added. opened_: the stamp when
  // removing triangles was tried, and the cost found.
  std::unordered_map<std::uint64_t, Known> offered_, opened_;
  std::vector<Index> stamp_;  // grows with each change around a vertex
  std::priority_queue<Turn, std::vector<Turn>, std::greater<>> turns_;
};

}  // namespace

void contract_by_samples(const Surface& surface, ContractibleMesh& mesh, std::span<const FitSample> samples,
                         Assignment& feet, const ContractionOptions& options, Index target) {
  SampledContraction(surface, mesh, samples, feet, options).run(target);
}

}  // namespace orchard::detail
