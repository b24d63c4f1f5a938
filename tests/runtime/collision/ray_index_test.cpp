// Rays by the tree and by a ray index: the same bits from both, and what integers say of lattices.
#include "orchard/runtime/shape_query.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "allocation.h"
#include "bodies.h"
#include "every_machine.h"
#include "lattice_scene.h"
#include "runtime/same_hit.h"
#include "support/effort.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

using Int = std::int64_t;  // coordinates are below 16: nothing here reaches 2^40
using IntVec = std::array<Int, 3>;

IntVec wide(const Lattice& v) { return {v[0], v[1], v[2]}; }
IntVec minus(const IntVec& a, const IntVec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
IntVec cross(const IntVec& a, const IntVec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Int dot(const IntVec& a, const IntVec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
bool zero(const IntVec& v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

struct Fraction {  // den > 0; without a value, den is 0
  Int num = 0, den = 0;
  static Fraction of(Int num, Int den) { return den < 0 ? Fraction{-num, -den} : Fraction{num, den}; }
  bool any() const { return den != 0; }
  bool before(const Fraction& other) const { return any() && (!other.any() || num * other.den < other.num * den); }
  bool operator==(const Fraction& other) const { return num * other.den == other.num * den; }
  double value() const { return static_cast<double>(num) / static_cast<double>(den); }
};

// Where the ray p + t d, t >= 0, first meets the segment from a to b.
Fraction meets_segment(const IntVec& p, const IntVec& d, const IntVec& a, const IntVec& b) {
  const IntVec e = minus(b, a), to = minus(a, p), across = cross(d, e);
  if (!zero(across)) {
    if (dot(to, across) != 0) return {};
    const Int square = dot(across, across), t = dot(cross(to, e), across), u = dot(cross(to, d), across);
    return t >= 0 && u >= 0 && u <= square ? Fraction::of(t, square) : Fraction{};
  }
  if (zero(d)) {
    const bool on = zero(cross(to, e)) && dot(minus(p, a), minus(p, b)) <= 0;
    return on ? Fraction{0, 1} : Fraction{};
  }
  if (!zero(cross(to, d))) return {};
  const Int s = dot(to, d), t = dot(minus(b, p), d), square = dot(d, d);
  if (std::max(s, t) < 0) return {};
  return Fraction::of(std::max(Int{0}, std::min(s, t)), square);
}

// Of `at` over `scale` in the triangle's plane: 1 inside, 0 on the boundary, -1 outside.
int place(const std::array<IntVec, 3>& v, const IntVec& normal, const IntVec& at, Int scale) {
  int least = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const IntVec &a = v[k], &b = v[(k + 1) % 3];
    const IntVec from = {at[0] - scale * a[0], at[1] - scale * a[1], at[2] - scale * a[2]};
    const Int side = dot(normal, cross(minus(b, a), from)) * (scale > 0 ? 1 : -1);
    least = std::min(least, side > 0 ? 1 : side < 0 ? -1 : 0);
  }
  return least;
}

struct Met {
  Fraction t;
  bool grazed = false;  // at the boundary, or along the plane
};

Met meets_triangle(const IntVec& p, const IntVec& d, const LatticeTriangle& triangle) {
  const std::array<IntVec, 3> v = {wide(triangle[0]), wide(triangle[1]), wide(triangle[2])};
  const IntVec normal = cross(minus(v[1], v[0]), minus(v[2], v[0]));
  const Int height = dot(normal, minus(v[0], p)), slope = dot(normal, d);
  if (slope != 0) {
    const Fraction t = Fraction::of(height, slope);
    if (t.num < 0) return {};
    const IntVec at = {p[0] * slope + height * d[0], p[1] * slope + height * d[1], p[2] * slope + height * d[2]};
    const int where = place(v, normal, at, slope);
    return where < 0 ? Met{} : Met{t, where == 0};
  }
  if (height != 0) return {};
  if (!zero(normal) && place(v, normal, p, 1) >= 0) return {{0, 1}, true};
  Met first;
  for (std::size_t k = 0; k < 3; ++k) {
    const Fraction t = meets_segment(p, d, v[k], v[(k + 1) % 3]);
    if (t.before(first.t)) first = {t, true};
  }
  return first;
}

struct LatticeRay {
  Ray ray;
  Fraction first;
  std::vector<Fraction> each;  // of the triangles
  int pace = 0;                // of the direction: a power of two
  bool clear = true;           // no rounding of the ray's end can change what it meets
};

// Between points of the lattice, so that many run through corners, along edges and in planes, along axes, or nowhere;
// two in three end at the second point.
LatticeRay lattice_ray(Draw& draw, const LatticeMesh& mesh, const PackedSphereTree& tree, int power, int kind) {
  Lattice p{}, q{};
  for (Lattice* v : {&p, &q}) {
    for (std::int64_t& x : *v) x = static_cast<std::int64_t>(draw.bits() % 16) - 4;
  }
  if (kind % 5 == 0) q = mesh[draw.bits() % mesh.size()][draw.bits() % 3];
  if (kind % 7 == 0) q[draw.bits() % 3] = p[draw.bits() % 3];
  const IntVec d = minus(wide(q), wide(p));
  LatticeRay result;
  const int pace = result.pace = static_cast<int>(draw.bits() % 40) - 20;
  const double unit = std::ldexp(1, power);
  const ObbNodeBlock& root = tree.obb_nodes[0];
  const std::array<float, 3> middle = {root.x[0], root.y[0], root.z[0]};
  double away = 0, size = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    result.ray.origin[i] = static_cast<double>(p[i]) * unit;
    result.ray.direction[i] = std::ldexp(static_cast<double>(d[i]), pace);
    const double from_middle = static_cast<double>(p[i]) - (double{middle[i]} + tree.origin[i]) / unit;
    away += from_middle * from_middle, size += static_cast<double>(d[i] * d[i]);
  }
  const bool ends = kind % 3 != 0;
  if (ends) result.ray.longest = std::ldexp(1, power - pace);
  // Beyond everything rays end where that is, rounded.
  const bool exact = ends && std::sqrt(size) < 0.999 * (std::sqrt(away) + 2 * double{root.radius[0]} / unit);
  for (const LatticeTriangle& t : mesh) {
    Met met = meets_triangle(wide(p), d, t);
    if (ends && met.t.any() && met.t.num > met.t.den) met = {};
    result.each.push_back(met.t);
    result.clear = result.clear && (exact || !met.grazed);
    if (met.t.before(result.first)) result.first = met.t;
  }
  return result;
}

TEST(RayIndex, AndTreeSayWhatIntegersSayAtEverySizeOnEveryMachine) {
  const std::uint64_t begin = orchard::test::first_seed();
  on_every_machine([begin] {
    int hits = 0, misses = 0, ties = 0;
    for (std::uint64_t seed = begin; seed < begin + 60 * orchard::test::more(); ++seed) {
      Draw draw(seed);
      const LatticeMesh mesh = seed % 4 == 0 ? lattice_box({4, 3, 2}) : lattice_soup(draw, 10 + seed % 5 * 40, 9);
      const int power = kMinPower + static_cast<int>(draw.bits() % (kMaxPower - kMinPower + 1));
      const PackedSphereTree tree = tree_of(mesh, power);
      const RayIndex index(tree);
      std::vector<Ray> rays;
      for (int kind = 0; kind < 21; ++kind) {
        const LatticeRay lattice = lattice_ray(draw, mesh, tree, power, kind);
        const Ray& ray = lattice.ray;
        rays.push_back(ray);
        const auto hit = cast_ray(tree, {}, ray.origin, ray.direction, ray.longest);
        ASSERT_TRUE(test::same_hit(hit, cast_ray(index, {}, ray.origin, ray.direction, ray.longest)))
            << seed << " " << kind;
        if (!lattice.clear) continue;
        ASSERT_EQ(hit.has_value(), lattice.first.any()) << seed << " " << kind << " 2^" << power;
        (hit ? hits : misses) += 1;
        if (!hit) continue;
        const auto& found = lattice.each[hit->triangle];
        ASSERT_TRUE(found.any() && found == lattice.first) << seed << " " << kind;
        ASSERT_NEAR(std::ldexp(hit->along, lattice.pace - power), lattice.first.value(), 1e-12) << seed << " " << kind;
        ties += std::count_if(lattice.each.begin(), lattice.each.end(),
                              [&lattice](const Fraction& t) { return t.any() && t == lattice.first; }) > 1;
      }
      std::vector<std::optional<RayHit>> of_tree(rays.size()), of_index(rays.size());
      cast_rays(tree, {}, rays, of_tree);
      cast_rays(index, {}, rays, of_index);
      for (std::size_t r = 0; r < rays.size(); ++r) {
        const auto one = cast_ray(tree, {}, rays[r].origin, rays[r].direction, rays[r].longest);
        ASSERT_TRUE(test::same_hit(one, of_tree[r]) && test::same_hit(one, of_index[r])) << seed << " " << r;
      }
    }
    EXPECT_GT(hits, 200);
    EXPECT_GT(misses, 200);
    EXPECT_GT(ties, 30);
  });
}

// The nearest of the triangles by themselves, in long double.
long double first_along(const std::vector<Triangle>& all, const Ray& ray, bool& clear) {
  long double first = std::numeric_limits<long double>::infinity();
  for (const Triangle& t : all) {
    std::array<std::array<long double, 3>, 3> v{};
    std::array<long double, 3> n{}, d{};
    for (std::size_t k = 0; k < 3; ++k) {
      d[k] = static_cast<long double>(ray.direction[k]);
      for (std::size_t i = 0; i < 3; ++i) v[k][i] = t[k][i] - static_cast<long double>(ray.origin[i]);
    }
    const auto across = [](const auto& a, const auto& b) {
      return std::array<long double, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                        a[0] * b[1] - a[1] * b[0]};
    };
    const auto times = [](const auto& a, const auto& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    const long double p = times(d, across(v[0], v[1])), q = times(d, across(v[1], v[2])),
                      r = times(d, across(v[2], v[0]));
    const long double sum = p + q + r, least = std::min({p, q, r}), most = std::max({p, q, r});
    const long double size = std::fabs(p) + std::fabs(q) + std::fabs(r);
    if (least < 0 && most > 0 && std::min(-least, most) > 1e-9L * size) continue;
    const std::array<long double, 3> e = {v[1][0] - v[0][0], v[1][1] - v[0][1], v[1][2] - v[0][2]},
                                     f = {v[2][0] - v[0][0], v[2][1] - v[0][1], v[2][2] - v[0][2]};
    n = across(e, f);
    const long double along = times(n, v[0]) / times(n, d);
    // Beside an edge, along the plane or at an end: others may see it differently.
    if (std::min({std::fabs(p), std::fabs(q), std::fabs(r)}) <= 1e-9L * size || std::fabs(sum) <= 1e-9L * size ||
        std::fabs(along) < 1e-9L || std::fabs(along - static_cast<long double>(ray.longest)) < 1e-9L) {
      clear = false;
      continue;
    }
    if (along >= 0 && along <= static_cast<long double>(ray.longest)) first = std::min(first, along);
  }
  return first;
}

TEST(RayIndex, FindsWhatEveryTriangleByItselfSaysUnderEveryPoseOnEveryMachine) {
  const auto all = bodies();
  const std::uint64_t begin = orchard::test::first_seed();
  on_every_machine([&] {
    int hits = 0, misses = 0;
    for (std::uint64_t seed = begin; seed < begin + 80 * orchard::test::more(); ++seed) {
      Draw draw(seed);
      const PackedSphereTree tree = seed % 3 == 0   ? build_tree(soup(seed, 400), {.bounds = false})
                                    : seed % 3 == 1 ? build_tree(spikes(seed, 30, 20), {.bounds = false})
                                                    : all[seed % all.size()].tree;
      const RayIndex index(tree);
      Pose pose = centered(tree, draw.pose(draw.uniform(0, 3)));
      if (seed % 2 == 1) pose = {pose.rotation, pose.translation, 1};
      const auto placed = placed_triangles(tree, pose);
      const double radius = tree.bounding_radius * pose.scale;
      std::vector<Ray> rays(37);
      for (std::size_t r = 0; r < rays.size(); ++r) {
        Ray& ray = rays[r];
        const auto from = draw.direction(), way = draw.direction();
        const auto& t = placed[draw.bits() % placed.size()];
        const double away = std::ldexp(radius, static_cast<int>(draw.bits() % 8) - 4);
        for (std::size_t i = 0; i < 3; ++i) {
          const double target = static_cast<double>(t[0][i] + t[1][i] + t[2][i]) / 3;
          ray.origin[i] = target + away * from[i];
          ray.direction[i] = r % 3 == 0 ? way[i] : target - ray.origin[i];
        }
        if (r % 4 == 0) ray.longest = draw.uniform(0, 2);
      }
      std::vector<std::optional<RayHit>> of_tree(rays.size()), of_index(rays.size());
      const std::size_t before = allocations;
      cast_rays(tree, pose, rays, of_tree);
      cast_rays(index, pose, rays, of_index);
      ASSERT_EQ(allocations, before);
      for (std::size_t r = 0; r < rays.size(); ++r) {
        const auto one = cast_ray(index, pose, rays[r].origin, rays[r].direction, rays[r].longest);
        ASSERT_TRUE(test::same_hit(one, of_tree[r]) && test::same_hit(one, of_index[r])) << seed << " " << r;
        bool clear = true;
        const long double truth = first_along(placed, rays[r], clear);
        if (!clear) continue;
        ASSERT_EQ(one.has_value(), std::isfinite(truth)) << seed << " " << r;
        (one ? hits : misses) += 1;
        if (one) {
          ASSERT_NEAR(one->along, static_cast<double>(truth), 1e-7 * (1 + static_cast<double>(truth))) << seed;
        }
      }
    }
    EXPECT_GT(hits, 500);
    EXPECT_GT(misses, 200);
  });
}

// From far away, with numbers that are none, and without triangles.
TEST(RayIndex, AnswersAsTheTreeDoesWhereThereIsLittleToAsk) {
  const auto all = bodies();
  const RayIndex none;
  EXPECT_TRUE(none.empty());
  EXPECT_FALSE(cast_ray(none, {}, {0, 0, -5}, {0, 0, 1}));
  constexpr double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const Body& body : all) {
    const RayIndex index(body.tree);
    EXPECT_FALSE(index.empty());
    EXPECT_GE(index.bytes(), 36 * body.tree.triangles.size());
    const Vec middle = centered(body.tree, {}).translation;
    std::vector<Ray> rays;
    for (const double far : {0.0, 1e3, 1e15, 1e20, 1e35, 1e90, 1e101, inf, nan}) {
      for (const double pace : {1.0, 0.0, 1e-310, 1e300, inf, nan}) {
        for (const double longest : {inf, 1e40, 0.0, -1.0, nan}) {
          for (std::size_t axis = 0; axis < 3; ++axis) {
            Ray ray;
            for (std::size_t i = 0; i < 3; ++i) ray.origin[i] = (i == axis ? far : 0.03) - middle[i];
            ray.direction[axis] = -pace;
            ray.longest = longest;
            rays.push_back(ray);
          }
        }
      }
    }
    Pose mirror;
    mirror.rotation[0] = -1;
    for (const Pose& pose : {Pose{}, mirror}) {
      std::vector<std::optional<RayHit>> of_tree(rays.size()), of_index(rays.size());
      cast_rays(body.tree, pose, rays, of_tree);
      cast_rays(index, pose, rays, of_index);
      for (std::size_t r = 0; r < rays.size(); ++r) {
        const auto one = cast_ray(body.tree, pose, rays[r].origin, rays[r].direction, rays[r].longest);
        const auto alike = [&one](const std::optional<RayHit>& other) {  // the place may be no number
          return one.has_value() == other.has_value() &&
                 (!one || (one->along == other->along && one->triangle == other->triangle));
        };
        ASSERT_TRUE(alike(of_tree[r]) && alike(of_index[r])) << body.name << " " << r;
        ASSERT_TRUE(alike(cast_ray(index, pose, rays[r].origin, rays[r].direction, rays[r].longest)));
      }
    }
  }
}

// Many triangles in one place leave nothing to choose by: the index stays shallow.
TEST(RayIndex, HoldsAnyNumberOfTrianglesInOnePlace) {
  Mesh heap;
  heap.closed = false;
  heap.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  for (int i = 0; i < 5000; ++i) heap.triangles.push_back({0, 1, 2});
  for (int i = 0; i < 40; ++i) {  // and one after the other, each a thousandth of the last one's size
    const auto first = static_cast<std::uint32_t>(heap.vertices.size());
    const double x = std::pow(0.1, i % 6);
    for (const Vec& v : {Vec{x, 0, 1}, Vec{2 * x, 0, 1}, Vec{x, x, 1}}) heap.vertices.push_back(v);
    heap.triangles.push_back({first, first + 1, first + 2});
  }
  const PackedSphereTree tree = build_tree(heap, {.bounds = false});
  const RayIndex index(tree);
  for (const double z : {-1.0, 3.0}) {
    for (const double x : {0.25, 1.5, 0.15}) {
      const auto hit = cast_ray(index, {}, {x, 0.01, z}, {0, 0, z < 0 ? 1.0 : -1.0});
      ASSERT_TRUE(test::same_hit(hit, cast_ray(tree, {}, {x, 0.01, z}, {0, 0, z < 0 ? 1.0 : -1.0}))) << x << " " << z;
      ASSERT_TRUE(hit) << x << " " << z;
    }
  }
  EXPECT_EQ(cast_ray(index, {}, {0.25, 0.25, -1}, {0, 0, 1})->along, 1);
}

}  // namespace
}  // namespace orchard::runtime
