#include "hanging_pieces.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <vector>

namespace orchard::test {
namespace {

using Edge = std::array<Index, 2>;

Edge edge(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

struct Piece {
  std::set<Index> vertices;
  std::set<Edge> edges;
  std::size_t triangles = 0;
};

class Pieces {
 public:
  explicit Pieces(const MedialMesh& mesh) : mesh_(mesh) {
    for (const auto& [a, b] : mesh.edges) at_[edge(a, b)];
    for (Index t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      for (const Edge& e : {edge(a, b), edge(b, c), edge(a, c)}) at_[e].push_back(t);
    }
    for (const auto& [e, triangles] : at_) {
      for (const Index v : e) edges_of_[v].push_back(e);
    }
  }

  std::vector<Piece> all() {
    std::vector<Piece> pieces;
    std::set<Edge> seen;
    for (const auto& [start, triangles] : at_) {
      if (!seen.insert(start).second) continue;
      Piece piece;
      std::set<Index> of_piece;
      for (std::vector<Edge> open{start}; !open.empty();) {
        const Edge e = open.back();
        open.pop_back();
        piece.edges.insert(e);
        piece.vertices.insert(e.begin(), e.end());
        of_piece.insert(at_[e].begin(), at_[e].end());
        for (const Edge& next : next_to(e)) {
          if (seen.insert(next).second) open.push_back(next);
        }
      }
      piece.triangles = of_piece.size();
      pieces.push_back(std::move(piece));
    }
    return pieces;
  }

 private:
  std::vector<Edge> next_to(const Edge& e) {
    std::vector<Edge> next;
    for (const Index t : at_[e]) {
      const auto& [a, b, c] = mesh_.triangles[t];
      for (const Edge& side : {edge(a, b), edge(b, c), edge(a, c)}) next.push_back(side);
    }
    if (!next.empty()) return next;
    for (const Index v : e) {
      const std::vector<Edge>& around = edges_of_[v];
      const auto is_bare = [&](const Edge& other) { return at_[other].empty(); };
      if (around.size() == 2 && std::all_of(around.begin(), around.end(), is_bare))
        next.insert(next.end(), around.begin(), around.end());
    }
    return next;
  }

  const MedialMesh& mesh_;
  std::map<Edge, std::vector<Index>> at_;
  std::map<Index, std::vector<Edge>> edges_of_;
};

}  // namespace

Index hanging_pieces(const MedialMesh& mesh, double reach) {
  const std::vector<Piece> pieces = Pieces(mesh).all();
  std::map<Index, int> pieces_at;
  for (const Piece& piece : pieces) {
    for (const Index v : piece.vertices) ++pieces_at[v];
  }
  Index found = 0;
  for (const Piece& piece : pieces) {
    std::vector<Index> joints;
    for (const Index v : piece.vertices) {
      if (pieces_at[v] > 1) joints.push_back(v);
    }
    // Connected, so that one is all of it if nothing is closed: no loop, no cavity.
    if (joints.size() != 1 || piece.vertices.size() + piece.triangles != piece.edges.size() + 1) continue;
    double farthest = 0;
    for (const Index v : piece.vertices)
      farthest = std::max(farthest, (mesh.centers[v] - mesh.centers[joints[0]]).norm());
    found += farthest <= reach * mesh.radii[joints[0]] ? 1 : 0;
  }
  return found;
}

}  // namespace orchard::test
