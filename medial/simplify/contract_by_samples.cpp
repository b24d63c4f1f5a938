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

#include "protrusions.h"

namespace orchard::detail {
namespace {

constexpr double kToMiddle = 1e-3;  // of the trace: towards the middle of the edge

// An edge, and the ball that its ends may become.
struct Candidate {
  double cost = 0;
  Ball4 ball = Ball4::Zero();
};

double fourth(double value) {
  const double square = value * value;
  return square * square;
}

// What protrudes around edges.
class ProtrusionCost {
 public:
  ProtrusionCost(const Surface& surface, const ContractibleMesh& mesh, const LookOptions& look)
      : surface_(surface), mesh_(mesh), look_(look), inside_(mesh.size()) {}

  // The sum of the fourth powers, how much larger it gets by contracting an edge to this ball.
  double added(Index a, Index b, const Ball4& ball) {
    double before = 0, after = 0;
    for (const Protrusion& place : places_around(mesh_, a, b, look_)) {
      before += fourth(value(place, place.ball(mesh_)));
      Ball4 moved = Ball4::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        const Index corner = place.corners[k];
        moved += place.weights[k] * (corner == a || corner == b ? ball : mesh_.ball(corner));
      }
      after += fourth(value(place, moved));
    }
    return after - before;
  }

 private:
  double value(const Protrusion& place, const Ball4& ball) {
    Vector outward;
    return protrusion_of(surface_, ball, known_at(place, ball.head<3>()), outward);
  }
  // Of a corner of the place's cell, one that holds it if there is any.
  InsideBall& known_at(const Protrusion& place, const Point& center) {
    for (const Index corner : place.corners) {
      if (inside_[corner].holds(center)) return inside_[corner];
    }
    const auto heaviest = std::max_element(place.weights.begin(), place.weights.end()) - place.weights.begin();
    return inside_[place.corners[static_cast<std::size_t>(heaviest)]];
  }

  const Surface& surface_;
  const ContractibleMesh& mesh_;
  const LookOptions look_;
  std::vector<InsideBall> inside_;  // for each vertex
};

// The foot's cell after b became a.
void follow(Foot& foot, Index a, Index b) {
  std::size_t of_a = 3, of_b = 3;
  for (std::size_t k = 0; k < 3; ++k) {
    if (foot.corners[k] == a && of_a == 3) of_a = k;
    if (foot.corners[k] == b && of_b == 3) of_b = k;
  }
  if (of_b == 3) return;
  for (Index& corner : foot.corners) {
    if (corner == b) corner = a;
  }
  if (of_a == 3) return;
  // Smaller cells repeat their first corner.
  Index other = kNone;
  double share = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (foot.corners[k] == a) continue;
    other = foot.corners[k];
    share = foot.weights[k];
  }
  foot.corners = {a, other == kNone ? a : other, a};
  foot.weights = {1 - share, share, 0};
}

class SampledContraction {
 public:
  SampledContraction(const Surface& surface, ContractibleMesh& mesh, std::span<const FitSample> samples,
                     Assignment& feet)
      : mesh_(mesh),
        samples_(samples),
        feet_(feet),
        protrusion_(surface, mesh, LookOptions(surface, samples[0].weight)),
        at_(mesh.size()),
        blocked_(mesh.size()) {
    stamp_.assign(mesh.size(), 0);
    for (Index i = 0; i < samples.size(); ++i) enter(i);
  }

  void run(Index target) {
    offer_all();
    while (mesh_.living() > target && !turns_.empty()) {
      const Turn turn = turns_.top();
      turns_.pop();
      const auto& [cost, a, b, stamp, whole] = turn;
      if (!mesh_.alive(a) || !mesh_.alive(b) || !mesh_.adjacent(a, b)) continue;
      if (stamp != stamp_[a] + stamp_[b]) {
        offer(a, b);
      } else if (!mesh_.may_contract(a, b)) {
        offered_.erase(std::uint64_t{a} << 32 | b);
        blocked_[a].push_back(b);
        blocked_[b].push_back(a);
      } else if (!whole) {
        const double added = protrusion_.added(a, b, candidate(a, b).ball);
        turns_.emplace(cost + kProtrusionWeight * samples_[0].weight * added, a, b, stamp, true);
      } else {
        contract(a, b);
      }
    }
  }

 private:
  // Cost, edge, the sum of its ends' stamps when that was found, and whether what protrudes is in it, which is looked
  // at only of those whose turn comes, since it takes longest.
  using Turn = std::tuple<double, Index, Index, Index, bool>;

  // A foot as a function of the common ball: what it has of others, and its share.
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
    for (std::size_t i = 0; i < edges.size(); ++i) turns_.emplace(costs[i], edges[i][0], edges[i][1], 0, false);
  }
  // Not again what is offered as it is now.
  void offer(Index a, Index b) {
    const auto [p, q] = std::minmax(a, b);
    const Index stamp = stamp_[p] + stamp_[q];
    const auto [offered, first] = offered_.try_emplace(std::uint64_t{p} << 32 | q, stamp);
    if (!first && offered->second == stamp) return;
    offered->second = stamp;
    turns_.emplace(candidate(p, q).cost, p, q, stamp, false);
  }

  Candidate candidate(Index a, Index b) const {
    std::vector<Index> seen;
    std::set_union(at_[a].begin(), at_[a].end(), at_[b].begin(), at_[b].end(), std::back_inserter(seen));
    const Ball4 middle = 0.5 * (mesh_.ball(a) + mesh_.ball(b));
    std::vector<Part> parts;
    parts.reserve(seen.size());
    double before = 0;
    for (const Index i : seen) {
      parts.push_back(part(i, a, b));
      before += samples_[i].weight * fourth(feet_.feet[i].value);
    }
    Candidate best{.cost = std::numeric_limits<double>::infinity()};
    for (const Ball4& ball : {optimum(parts, middle), middle, mesh_.ball(a), mesh_.ball(b)}) {
      double cost = -before;
      for (const Part& p : parts) cost += p.sample->weight * fourth(p.value(ball));
      if (cost < best.cost) best = {cost, ball};
    }
    return best;
  }

  void contract(Index a, Index b) {
    std::vector<Index> seen;
    std::set_union(at_[a].begin(), at_[a].end(), at_[b].begin(), at_[b].end(), std::back_inserter(seen));
    const Ball4 ball = candidate(a, b).ball;
    for (const Index i : seen) leave(i);
    mesh_.contract(a, b, ball);
    for (const Index i : seen) {
      Foot& foot = feet_.feet[i];
      follow(foot, a, b);
      foot = walk_to_foot(mesh_, samples_[i].position, foot).below(samples_[i].depth);
      enter(i);
    }
    // What the neighbours cost may have changed; it is found anew when their turn comes.
    stamp_[a] += stamp_[b] + 1;
    std::vector<Index> around(mesh_.neighbors(a).begin(), mesh_.neighbors(a).end());
    for (const Index other : around) ++stamp_[other];
    for (const Index other : around) offer(a, other);
    around.push_back(a);
    around.push_back(b);
    for (const Index v : around) {
      const std::vector<Index> ends = std::exchange(blocked_[v], {});
      for (const Index end : ends) {
        if (mesh_.alive(v) && mesh_.alive(end) && mesh_.adjacent(v, end)) offer(v, end);
      }
    }
  }

  void enter(Index sample) {
    visit_corners(
        sample, [&](std::vector<Index>& own) { own.insert(std::lower_bound(own.begin(), own.end(), sample), sample); });
  }
  void leave(Index sample) {
    visit_corners(sample,
                  [&](std::vector<Index>& own) { own.erase(std::lower_bound(own.begin(), own.end(), sample)); });
  }
  template <class Change>
  void visit_corners(Index sample, const Change& change) {
    const Foot& foot = feet_.feet[sample];
    const auto& [a, b, c] = foot.corners;  // those of no weight, too: they may become others
    change(at_[a]);
    if (b != a) change(at_[b]);
    if (c != a && c != b) change(at_[c]);
  }

  Part part(Index sample, Index a, Index b) const {
    const Foot& foot = feet_.feet[sample];
    Part part{&samples_[sample], Ball4::Zero(), 0};
    for (std::size_t k = 0; k < 3; ++k) {
      if (foot.corners[k] == a || foot.corners[k] == b) {
        part.share += foot.weights[k];
      } else {
        part.rest += foot.weights[k] * mesh_.ball(foot.corners[k]);
      }
    }
    return part;
  }

  // Least squares of what is linear about the middle.
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

  ContractibleMesh& mesh_;
  const std::span<const FitSample> samples_;
  Assignment& feet_;
  ProtrusionCost protrusion_;
  std::vector<std::vector<Index>> at_;                // samples of each vertex, ascending
  std::vector<std::vector<Index>> blocked_;           // other ends of edges that the link condition stood against
  std::unordered_map<std::uint64_t, Index> offered_;  // edges, by their ends, with the stamps they were offered with
  std::vector<Index> stamp_;                          // grows with each change around a vertex
  std::priority_queue<Turn, std::vector<Turn>, std::greater<>> turns_;
};

}  // namespace

void contract_by_samples(const Surface& surface, ContractibleMesh& mesh, std::span<const FitSample> samples,
                         Assignment& feet, Index target) {
  SampledContraction(surface, mesh, samples, feet).run(target);
}

}  // namespace orchard::detail
