#include "divided_mesh.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace orchard::detail {
namespace {

using Barycentric = Eigen::Vector3d;  // halves of halves of 0 and 1: exact

// A corner of a part of a triangle.
struct Corner {
  Index vertex = 0;
  Barycentric at = Barycentric::Zero();
};
using TrianglePart = std::array<Corner, 3>;

Feature feature_of(const Barycentric& at) {
  const bool on[3] = {at[0] > 0, at[1] > 0, at[2] > 0};
  const int count = on[0] + on[1] + on[2];
  if (count == 3) return Feature::face;
  for (int i = 0; i < 3; ++i) {
    if (count == 1 && on[i]) return static_cast<Feature>(static_cast<int>(Feature::vertex0) + i);
    if (count == 2 && !on[i]) return static_cast<Feature>(static_cast<int>(Feature::edge0) + (i + 1) % 3);
  }
  return Feature::face;
}

class Divider {
 public:
  Divider(const Surface& surface, double max_edge) : surface_(surface), squared_(max_edge * max_edge) {}

  DividedMesh run() {
    const TriangleMesh& mesh = surface_.mesh();
    result_.mesh.vertices = mesh.vertices;
    result_.places.resize(mesh.vertices.size());
    for (Index triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
      triangle_ = triangle;
      TrianglePart part;
      for (std::size_t i = 0; i < 3; ++i) {
        const Index vertex = mesh.triangles[triangle][i];
        part[i] = {vertex, Barycentric::Unit(static_cast<Eigen::Index>(i))};
        result_.places[vertex] = {mesh.vertices[vertex], triangle, feature_of(part[i].at)};
      }
      divide(part);
    }
    return std::move(result_);
  }

 private:
  const Point& position(const Corner& corner) const { return result_.mesh.vertices[corner.vertex]; }
  double squared_length(const Corner& a, const Corner& b) const { return (position(a) - position(b)).squaredNorm(); }

  Corner middle(const Corner& a, const Corner& b) {
    const Index low = std::min(a.vertex, b.vertex), high = std::max(a.vertex, b.vertex);
    const auto next = static_cast<Index>(result_.mesh.vertices.size());
    const auto [entry, fresh] = middles_.try_emplace(std::uint64_t{low} << 32 | high, next);
    Corner corner{entry->second, 0.5 * (a.at + b.at)};
    if (fresh) {
      const Point at = 0.5 * (result_.mesh.vertices[low] + result_.mesh.vertices[high]);
      result_.mesh.vertices.push_back(at);
      result_.places.push_back({at, triangle_, feature_of(corner.at)});
    }
    return corner;
  }

  // Halves the part's long edges, which divides it into four, three or two; if it has none, adds it to the result.
  void divide(const TrianglePart& part) {
    std::array<bool, 3> is_long{};
    int count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      is_long[i] = squared_length(part[i], part[(i + 1) % 3]) > squared_;
      count += is_long[i] ? 1 : 0;
    }
    if (count == 0) return add(part);
    // A part with one long edge is turned to begin with it; one with two begins after its short edge.
    std::size_t first = 0;
    while (count < 3 && !(count == 1 ? is_long[first] : !is_long[(first + 2) % 3])) ++first;
    const Corner &a = part[first], &b = part[(first + 1) % 3], &c = part[(first + 2) % 3];
    const Corner ab = middle(a, b);
    if (count == 1) {
      divide({a, ab, c});
      return divide({ab, b, c});
    }
    const Corner bc = middle(b, c);
    divide({ab, b, bc});
    if (count == 3) {
      const Corner ca = middle(c, a);
      divide({a, ab, ca});
      divide({ab, bc, ca});
      return divide({ca, bc, c});
    }
    if (squared_length(a, bc) <= squared_length(ab, c)) {
      divide({a, ab, bc});
      return divide({a, bc, c});
    }
    divide({a, ab, c});
    divide({ab, bc, c});
  }

  void add(const TrianglePart& part) {
    result_.mesh.triangles.push_back({part[0].vertex, part[1].vertex, part[2].vertex});
    result_.of_triangle.push_back(triangle_);
  }

  const Surface& surface_;
  const double squared_;
  Index triangle_ = 0;
  std::unordered_map<std::uint64_t, Index> middles_;  // by a number for the two vertices
  DividedMesh result_;
};

}  // namespace

DividedMesh divided_mesh(const Surface& surface, double max_edge) { return Divider(surface, max_edge).run(); }

}  // namespace orchard::detail
