#include <algorithm>
#include <numeric>
#include <utility>

#include "orchard/medial/quality.h"

namespace orchard {
namespace {

// Sets that grow together.
class Sets {
 public:
  explicit Sets(Index count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), Index{0}); }
  Index root(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(Index a, Index b) {
    a = root(a), b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<Index> parent_;
};

struct Side {
  std::array<Index, 2> edge;
  Index triangle;
  bool operator<(const Side& other) const { return edge != other.edge ? edge < other.edge : triangle < other.triangle; }
};

// Of all triangles, by edge.
std::vector<Side> sides_of(const MedialMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    for (const auto& edge : {std::array{a, b}, std::array{a, c}, std::array{b, c}}) sides.push_back({edge, t});
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

struct Extent {
  Box box;
  double radius = 0;
  void add(const MedialMesh& mesh, Index vertex) {
    box.extend(mesh.centers[vertex]);
    radius = std::max(radius, mesh.radii[vertex]);
  }
};

Index small_ones(const std::vector<Extent>& extents) {
  return static_cast<Index>(std::count_if(extents.begin(), extents.end(), [](const Extent& extent) {
    return !extent.box.isEmpty() && extent.box.diagonal().norm() < extent.radius;
  }));
}

// Those that hold anything.
Index count_of(const std::vector<Extent>& extents) {
  return static_cast<Index>(
      std::count_if(extents.begin(), extents.end(), [](const Extent& extent) { return !extent.box.isEmpty(); }));
}

}  // namespace

MedialPieces medial_pieces(const MedialMesh& mesh) {
  const std::vector<Side> sides = sides_of(mesh);
  Sets sheets(static_cast<Index>(mesh.triangles.size()));
  for (std::size_t i = 1; i < sides.size(); ++i) {
    if (sides[i].edge == sides[i - 1].edge) sheets.join(sides[i].triangle, sides[i - 1].triangle);
  }
  std::vector<Extent> of_sheet(mesh.triangles.size()), of_wire(mesh.size());
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    for (const Index vertex : mesh.triangles[t]) of_sheet[sheets.root(t)].add(mesh, vertex);
  }
  Sets wires(mesh.size());
  std::vector<std::array<Index, 2>> bare;
  std::vector<std::uint8_t> used(mesh.size(), 0);
  for (const auto& edge : mesh.edges) {
    for (const Index vertex : edge) used[vertex] = 1;
    const auto side = std::lower_bound(sides.begin(), sides.end(), Side{edge, 0});
    if (side != sides.end() && side->edge == edge) continue;
    bare.push_back(edge);
    wires.join(edge[0], edge[1]);
  }
  for (const auto& edge : bare) {
    for (const Index vertex : edge) of_wire[wires.root(edge[0])].add(mesh, vertex);
  }
  for (Index v = 0; v < mesh.size(); ++v) {
    if (used[v] == 0) of_wire[v].add(mesh, v);
  }
  MedialPieces pieces{.sheets = count_of(of_sheet), .wires = count_of(of_wire)};
  if (pieces.sheets + pieces.wires > 1) pieces.small = small_ones(of_sheet) + small_ones(of_wire);
  return pieces;
}

double border_length(const MedialMesh& mesh) {
  const std::vector<Side> sides = sides_of(mesh);
  double sum = 0;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const bool alone =
        (i == 0 || sides[i - 1].edge != sides[i].edge) && (i + 1 == sides.size() || sides[i + 1].edge != sides[i].edge);
    const auto& [a, b] = sides[i].edge;
    if (alone) sum += (mesh.centers[a] - mesh.centers[b]).norm();
  }
  return sum;
}

}  // namespace orchard
