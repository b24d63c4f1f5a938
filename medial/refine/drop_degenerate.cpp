#include "drop_degenerate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "../extend/flat_triangle.h"
#include "../simplify/contractible_mesh.h"

namespace orchard::detail {
namespace {

constexpr int kMaxPasses = 8;  // passes: the parts of a divided triangle may be flat, too

class DegenerateCells {
 public:
  DegenerateCells(BallComplex& complex, double apart) : complex_(complex), apart_(apart), mesh_(complex.mesh()) {}

  Index run() {
    merge();
    for (int pass = 0; pass < kMaxPasses && divide_flat(); ++pass) merge();
    write_back();
    return dropped_;
  }

 private:
  Point center(Index v) const { return mesh_.ball(v).head<3>(); }
  bool is_near(Index a, Index b) const {
    return std::abs(mesh_.ball(a)[0] - mesh_.ball(b)[0]) <= apart_ && apart(a, b) <= apart_;
  }
  double apart(Index a, Index b) const { return (mesh_.ball(a) - mesh_.ball(b)).head<3>().norm(); }

  // Whether a stays if a and b become one. First a vertex on the surface stays, then an exact one, then one with more
  // contacts.
  bool stays(Index a, Index b) const {
    const auto key = [&](Index v) {
      const ExactBall& ball = complex_.balls[v];
      return std::tuple(ball.exact && !(ball.radius > 0), ball.exact, ball.count, b - v);
    };
    return key(a) > key(b);
  }

  void merge() {
    for (Index v = 0; v < complex_.size(); ++v) {
      bool merged = mesh_.alive(v);
      while (merged && mesh_.alive(v)) {
        merged = false;
        for (const Index other : mesh_.neighbors(v)) {
          if (other < v || !is_near(v, other) || !mesh_.may_contract(v, other)) continue;
          const auto [kept, gone] = stays(v, other) ? std::pair(v, other) : std::pair(other, v);
          mesh_.contract(kept, gone, mesh_.ball(kept));
          merged = true;
          ++dropped_;
          break;
        }
      }
    }
  }

  // Divides flat triangles. Returns false if there are none that can be divided.
  bool divide_flat() {
    bool divided = false;
    for (const auto& corners : mesh_.triangles()) {
      auto [a, b, c] = corners;
      if (!is_flat_triangle(center(a), center(b), center(c)) || !is_triangle(a, b, c)) continue;
      // The longest edge is ab.
      if (apart(b, c) > apart(a, b) && apart(b, c) >= apart(a, c)) {
        std::swap(a, c);
      } else if (apart(a, c) > apart(a, b)) {
        std::swap(b, c);
      }
      if (divide_at(a, b, c)) divided = true;
    }
    return divided;
  }

  bool is_triangle(Index a, Index b, Index c) {
    if (!mesh_.alive(a) || !mesh_.alive(b) || !mesh_.alive(c) || !mesh_.adjacent(a, b)) return false;
    mesh_.opposite(a, b, opposite_);
    return std::find(opposite_.begin(), opposite_.end(), c) != opposite_.end();
  }
  bool divide_at(Index a, Index b, Index c) {
    mesh_.opposite(a, b, opposite_);
    const auto joined = [&](Index d) { return d != c && mesh_.adjacent(c, d); };
    if (std::any_of(opposite_.begin(), opposite_.end(), joined)) return false;
    const Index middle = mesh_.divide(a, b, mesh_.ball(c));
    mesh_.contract(c, middle, mesh_.ball(c));
    ++dropped_;
    return true;
  }

  // Writes the mesh back to the complex. The vertices that are left are vertices of the complex.
  void write_back() {
    Index count = 0;
    for (Index v = 0; v < complex_.size(); ++v) {
      if (mesh_.alive(v)) complex_.balls[count++] = complex_.balls[v];
    }
    complex_.balls.resize(count);
    MedialMesh mesh = mesh_.mesh();
    complex_.edges = std::move(mesh.edges);
    complex_.triangles = std::move(mesh.triangles);
  }

  BallComplex& complex_;
  const double apart_;
  ContractibleMesh mesh_;
  std::vector<Index> opposite_;
  Index dropped_ = 0;
};

}  // namespace

Index drop_degenerate(BallComplex& complex, double apart) { return DegenerateCells(complex, apart).run(); }

}  // namespace orchard::detail
