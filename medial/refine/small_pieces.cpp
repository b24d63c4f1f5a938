#include "small_pieces.h"

#include <algorithm>
#include <vector>

#include "../axis/incidence.h"
#include "orchard/geometry/disjoint_sets.h"

namespace orchard::detail {
namespace {

class PieceDropper {
 public:
  explicit PieceDropper(BallComplex& complex)
      : complex_(complex),
        at_(complex.edges, complex.triangles, complex.size()),
        piece_of_edge_(complex.edges.size()) {}

  Index run(const CoverGuard* guard, std::vector<Sphere>* around) {
    find_pieces();
    find_joints();
    measure();
    choose(guard);
    if (around) add_spheres(*around);
    const std::size_t before = complex_.edges.size() + complex_.triangles.size();
    collapse(complex_, doomed(), std::vector<double>(complex_.size(), 0));
    return static_cast<Index>(before - complex_.edges.size() - complex_.triangles.size());
  }

 private:
  bool is_bare(Index e) const { return at_.triangles_at[e].empty(); }

  // Joins triangles that share edges to pieces; and edges without triangles that meet where nothing else does.
  void find_pieces() {
    for (const auto& [ab, ac, bc] : at_.sides) {
      piece_of_edge_.unite(ab, ac);
      piece_of_edge_.unite(ab, bc);
    }
    for (Index v = 0; v < complex_.size(); ++v) {
      const auto edges = at_.edges_at[v];
      if (edges.size() == 2 && is_bare(edges[0]) && is_bare(edges[1])) piece_of_edge_.unite(edges[0], edges[1]);
    }
  }

  // Finds the joints (vertices at which several pieces meet), and how many of them each piece has.
  void find_joints() {
    joint_.assign(complex_.edges.size(), kNone);
    joints_.assign(complex_.edges.size(), 0);
    std::vector<Index> pieces;
    for (Index v = 0; v < complex_.size(); ++v) {
      pieces.clear();
      for (const Index e : at_.edges_at[v]) pieces.push_back(piece(e));
      std::sort(pieces.begin(), pieces.end());
      pieces.erase(std::unique(pieces.begin(), pieces.end()), pieces.end());
      if (pieces.size() < 2) continue;
      for (const Index p : pieces) {
        joint_[p] = v;
        ++joints_[p];
      }
    }
  }

  // Measures how far each piece with a single joint reaches from it, and its largest radius.
  void measure() {
    reach_.assign(complex_.edges.size(), 0);
    radius_.assign(complex_.edges.size(), 0);
    for (Index e = 0; e < complex_.edges.size(); ++e) {
      const Index p = piece(e);
      if (joints_[p] != 1) continue;
      for (const Index v : complex_.edges[e]) {
        reach_[p] = std::max(reach_[p], (complex_.balls[v].center - complex_.balls[joint_[p]].center).norm());
        radius_[p] = std::max(radius_[p], complex_.balls[v].radius);
      }
    }
  }

  bool is_small(Index p) const {
    return joints_[p] == 1 && (reach_[p] <= kPieceReach * complex_.balls[joint_[p]].radius || radius_[p] == 0);
  }

  // Chooses the small pieces to remove: not those that alone cover something that `guard` needs.
  void choose(const CoverGuard* guard) {
    goes_.assign(complex_.edges.size(), kNone);
    for (Index e = 0; e < complex_.edges.size(); ++e) {
      if (is_small(piece(e))) goes_[e] = piece(e);
    }
    if (!guard) return;
    const std::vector<std::uint8_t> needed = guard->needed(complex_, goes_);
    for (Index& p : goes_) {
      if (p != kNone && needed[p] != 0) p = kNone;
    }
  }

  void add_spheres(std::vector<Sphere>& around) {
    for (Index e = 0; e < complex_.edges.size(); ++e) {
      if (piece(e) != e || goes_[e] == kNone) continue;
      const ExactBall& ball = complex_.balls[joint_[e]];
      around.push_back({.center = ball.center, .radius = reach_[e] + std::max(radius_[e], ball.radius)});
    }
  }

  Doomed doomed() {
    Doomed doomed(complex_);
    for (Index e = 0; e < complex_.edges.size(); ++e) {
      const Index p = goes_[e];
      if (p == kNone) continue;
      doomed.edges[e] = 1;
      for (const Index v : complex_.edges[e]) {
        if (v != joint_[p]) doomed.vertices[v] = 1;
      }
    }
    return doomed;
  }

  Index piece(Index e) { return static_cast<Index>(piece_of_edge_.root(e)); }

  BallComplex& complex_;
  const CellIncidence at_;
  DisjointSets piece_of_edge_;
  std::vector<Index> goes_;             // for each edge, its piece if that is to be removed
  std::vector<Index> joint_, joints_;   // for each piece, its last joint and its number of joints
  std::vector<double> reach_, radius_;  // of each piece, mesh units
};

}  // namespace

Index drop_small_pieces(BallComplex& complex, const CoverGuard* guard, std::vector<Sphere>* around) {
  Index dropped = 0;
  while (const Index now = PieceDropper(complex).run(guard, around)) dropped += now;
  return dropped;
}

}  // namespace orchard::detail
