#pragma once
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "orchard/voronoi/diagram.h"
#include "predicates/four_vectors.h"
#include "predicates/frame.h"
#include "predicates/placed_sphere.h"
#include "predicates/predicates.h"
#include "predicates/vectors.h"

namespace orchard::detail {

// The result of placing a vertex.
enum class Placing : std::uint8_t {
  good,
  shared,  // its own centre would be inaccurate, but up to the noise it is on a neighbour's sphere, which it gets
  thin,    // the forming points are so nearly coplanar that an uncertain sign elsewhere could move the centre far
  failed,  // the centre would be useless, or the orientation is wrong
};

// What an insertion knows about a vertex so far.
enum class Mark : std::uint8_t { unseen, deleted, kept, wanted };

// Returns the index of the one of four items that satisfies a condition, given the conditions of the last three. It has
// no branches, because no processor could predict them.
inline std::size_t index_of_four(bool is_second, bool is_third, bool is_fourth) {
  return static_cast<std::size_t>(is_second | is_fourth) + 2 * static_cast<std::size_t>(is_third | is_fourth);
}
// Returns the index of `number` among four numbers, one of which it is.
inline std::size_t index_of(const std::array<Index, 4>& numbers, Index number) {
  return index_of_four(numbers[1] == number, numbers[2] == number, numbers[3] == number);
}

// A diagram under construction. Its vertices differ from the finished ones: `radius` is the square of the radius. For
// vertices at infinity it is NaN, and the infinite point always comes last. Freed vertices have no neighbours.
//
// Each vertex has a bound on the error of  squared radius - squared distance  if its stored centre is used. The bound
// is rounded up to a power of four, whose exponent (the error class) is stored in six bits. So a test costs a distance,
// a look-up and a comparison.
class Workspace {
 public:
  std::vector<Point> points;
  std::vector<VoronoiVertex> vertices;
  std::vector<Index> free_vertices;

  // Sets the lengths from which the bounds are computed: the box of the points, and how far rounding may have moved a
  // coordinate (`rounding`). The points are assumed to be exact only to kInputNoise times this (the noise). So points
  // that rounding has moved off a plane or a sphere still count as on it; otherwise, half of the signs there would be
  // certain and half uncertain.
  void set_scale(const Box& box, double rounding);
  static constexpr double kInputNoise = 4;
  // Sets the same lengths as those of another workspace.
  void take_scale(const Workspace& other);
  // Returns whether the noise is so large, compared with harmless_intrusion(), that it cannot be decided whether
  // uncertain signs are harmless.
  bool too_noisy() const { return noise_ > kMaxNoise * scale(); }
  // Makes all further signs exact, as if the input had no noise. It is slower, and slivers appear where rounding has
  // moved points off a plane, but the diagram is consistent whatever the input is. It is for input with errors that are
  // larger than rounding, but too small for signs to be certain.
  void set_exact(bool exact) { exact_ = exact; }
  bool exact() const { return exact_; }
  // Sets the noise to 0. Precondition: all signs of the diagram are exact.
  void forget_noise() { noise_ = 0; }

  void prefetch(Index v) const {
    __builtin_prefetch(vertices.data() + v);
    __builtin_prefetch(state_.data() + v);
  }
  // Returns the neighbours of a vertex that other threads may be changing at the same time (see Region).
  std::array<Index, 4> neighbors_now(Index v) const {
    return {neighbor_now(v, 0), neighbor_now(v, 1), neighbor_now(v, 2), neighbor_now(v, 3)};
  }
  Index neighbor_now(Index v, unsigned slot) const {
    return std::atomic_ref(const_cast<Index&>(vertices[v].neighbors[slot])).load(std::memory_order_relaxed);
  }
  // Returns index_of(neighbors_now(v), neighbor), without writing the neighbours to memory.
  std::size_t slot_now(Index v, Index neighbor) const {
    return index_of_four(neighbor_now(v, 1) == neighbor, neighbor_now(v, 2) == neighbor,
                         neighbor_now(v, 3) == neighbor);
  }
  void set_neighbor(Index v, unsigned slot, Index neighbor) {
    std::atomic_ref(vertices[v].neighbors[slot]).store(neighbor, std::memory_order_relaxed);
  }
  bool at_infinity(Index v) const { return vertices[v].forming_points[3] == kInfinitePoint; }
  bool is_free(Index v) const { return vertices[v].neighbors[0] == kNone; }
  Mark mark(Index v) const { return static_cast<Mark>(state_[v] & 3u); }
  void add_mark(Index v, bool condition, Mark mark) {  // precondition: v is unseen
    state_[v] = static_cast<std::uint16_t>(state_[v] | (condition ? unsigned(mark) : 0u));
  }
  // Marks those of four vertices as deleted, or as kept, that have a bit set. Precondition: they are unseen.
  void add_marks(const std::array<Index, 4>& v, unsigned deleted, unsigned kept) {
    static_assert(unsigned(Mark::deleted) == 1 && unsigned(Mark::kept) == 2);
    for (unsigned i = 0; i < 4; ++i)
      state_[v[i]] = static_cast<std::uint16_t>(state_[v[i]] | ((deleted >> i) & 1u) | (((kept >> i) & 1u) << 1));
  }
  void set_mark(Index v, Mark mark) { state_[v] = static_cast<std::uint16_t>((state_[v] & ~3u) | unsigned(mark)); }

  // Returns the squared radius minus the squared distance of q from the stored centre; NaN at infinity.
  double power(Index v, const Point& q) const { return vertices[v].radius - (vertices[v].center - q).squaredNorm(); }
  double power_bound(Index v) const { return bounds_[error_class_of(v)]; }
  // Returns the limit of the error bound, in squared radii, below which the noise of the input is what makes a sign
  // uncertain. A vertex with such a bound has uncertain signs wherever the bound does not decide. The limit is 0 with
  // exact signs.
  double doubtful_input() const { return exact_ ? 0 : good_center_; }
#ifdef ORCHARD_FOUR_LANES
  // What the marks, power() and power_bound() say about four vertices, with a bit for each. If the bound decides, `far`
  // or `near` is set. If not, `input` is set if the bound is below `doubtful_input` squared radii.
  struct FourTests {
    struct Marks {
      unsigned unseen, kept;
    } marks;
    unsigned far, near, input;
  };
  ORCHARD_AVX2 FourTests test_four(const std::array<Index, 4>& v, const FourVectors& q, double doubtful_input) const;
  // Returns a bit for each of four pairs of vertices that agree: their spheres are their own, and that of the first one
  // certainly does not contain q; or both have the same sphere.
  ORCHARD_AVX2 unsigned agree_four(const std::array<Index, 4>& v, const std::array<Index, 4>& u,
                                   const FourVectors& q) const;
  // The spheres of four finite vertices. `shared` is a mask of those whose sphere is, or may be, that of a neighbour.
  struct FourSpheres {
    __m256d radius, power_bound, shared;
  };
  ORCHARD_AVX2 FourSpheres spheres(const std::array<Index, 4>& v) const;
  // Does the same as own_power_bound() for four vertices, given the radii and their squares, with the operations in the
  // same order.
  ORCHARD_AVX2 static __m256d own_power_bounds(const FourVectors& center, __m256d squared_radius, __m256d radius,
                                               __m256d off);
#endif
  // Returns whether the sphere of v is, or may be, that of a neighbour.
  bool shares_sphere(Index v) const { return (state_[v] & kShared) != 0; }

  // Returns whether the vertex is nearer to q than to its forming points; at infinity, whether q lies beyond the facet
  // of the hull.
  Sign sign(Index v, const Point& q) {
    const double p = power(v, q), bound = power_bound(v);
    if (p > bound) return Sign::positive;
    if (p < -bound) return Sign::negative;
    return doubtful_sign(v, q, bound);
  }

  // Does the same for a vertex whose stored centre does not decide.
  Sign doubtful_sign(Index v, const Point& q, double bound);

  // Returns doubtful_sign() for those of four vertices that have a bit set, as far as their points decide it quickly. A
  // sign may be `uncertain` although doubtful_sign() would find it.
  std::array<Sign, 4> doubtful_signs(const std::array<Index, 4>& v, unsigned which, const Point& q) const;

  // Returns the depth up to which a point inside a sphere is harmless, unless a line meets many such spheres (see
  // certificate.h).
  double harmless_intrusion() const { return kIntrusion * scale(); }
  // Returns whether the error bound alone shows that a new vertex is wrong by less than the harmless intrusion. It is
  // wrong by `power` divided by twice the height of the new point above the facet, and the bound includes the noise
  // divided by that height (see place()).
  bool harmless(double power, const VoronoiVertex& placed, std::uint8_t error_class) const {
    return power * bounds_[error_class] < 16 * harmless_intrusion() * placed.radius * noise_;
  }
  // Returns the dissertation's value of a deletion: the distance to the forming points minus the distance to q. At
  // infinity, it is the limit of that along the unbounded edge, which is the distance of q beyond the facet.
  double value(Index v, const Point& q) const;

  // Computes the position of the vertex of the new point and three others, a, b and c, which are given relative to it.
  // Fails if rounding would make the centre useless, or if the volume a . (b x c) is not positive.
  Placing place(VoronoiVertex& vertex, std::uint8_t& error_class, const Point& new_point, const LengthedVector& a,
                const LengthedVector& b, const LengthedVector& c) const;
  // Returns the result of place() for a sphere that placed_sphere() or place_four() has placed with this noise. Sets
  // `error_class` if the centre is of any use.
  Placing judge(const PlacedQuality& placed, std::uint8_t& error_class) const;
  // Returns limits for place_four(). A sphere within them is one that judge() calls good and that is not poor(); with
  // `may_be_poor`, it may be poor.
  PlacingLimits placing_limits(bool may_be_poor) const {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    return {noise_, exact_ ? kShaken : kThin, exact_ ? kSharpCondition : kNone,
            exact_ || may_be_poor ? kNone : good_center_, bounds_[0]};
  }
  // Does the same as place() for a vertex at infinity, beyond the facet of the new point, a and b.
  Placing place_at_infinity(VoronoiVertex& vertex, std::uint8_t& error_class, const LengthedVector& a,
                            const LengthedVector& b) const;
  // Returns whether the error of a placed vertex may be larger than what the noise of the input explains.
  bool poor(const VoronoiVertex& vertex, std::uint8_t error_class) const {
    return !(bounds_[error_class] < good_center_ * vertex.radius);
  }
  bool poor(Index v) const { return poor(vertices[v], error_class_of(v)); }
  // Gives a new vertex, which has a common facet with v, exactly the sphere and the error bound of v if the new point
  // is on that sphere up to the noise. So all vertices of many points on one sphere have the same sign for the next
  // point. Otherwise, returns false and changes nothing.
  bool share_sphere(VoronoiVertex& vertex, std::uint8_t& error_class, Index v, const Point& new_point) const;
  // Returns false if share_sphere() certainly returns false.
  bool may_share_sphere(Index v, const Point& new_point) const {
    const double sphere = kSphereNoise * noise_ * std::sqrt(vertices[v].radius);
    return std::abs(power(v, new_point)) <= std::min(sphere, power_bound(v));  // not at infinity
  }
  // Returns a length far beyond the points, for vertices that are practically at infinity.
  double far() const { return 1024 * scale(); }
  double scale() const { return std::sqrt(squared_scale_); }  // the size of the points' box, to a factor of two
  // Copies the vertices of a finished diagram of `points`, with room for `more` further ones. Their error bounds are
  // infinite until settle() computes them, because most vertices are never looked at again.
  void adopt(std::span<const VoronoiVertex> finished, const Frame& frame, std::size_t more);
  // Computes the error bound of an adopted vertex. Call it before power() and power_bound() are relied on; sign() calls
  // it itself.
  void settle(Index v) {
    if (!settled(v)) [[unlikely]]
      find_error_class(v);
  }
  // Gives a finite vertex the sphere of its forming points, up to a few roundings. Returns false if they have none.
  bool place_sharply(Index v);
  void place_sharply(Index v, const Vector& center);  // with a centre that is given relative to its first point
  // Does the same for all vertices that were made with exact signs and whose centres need more accurate arithmetic than
  // they were computed with. Returns the number of those that keep an approximate position.
  std::size_t place_thin_vertices();
  // Gives a vertex this sphere, with `bound` as the bound on the error of a power.
  void place_by_bound(Index v, const Point& center, double squared_radius, double bound) {
    vertices[v].center = center;
    vertices[v].radius = squared_radius;
    set_error_class(v, error_class(bound), false, state_[v] & 3u);
  }
  // Leaves a vertex where it is, and lowers its bound to the one that follows if its centre is off by at most `off`.
  void note_own_center(Index v, double off) {
    note_bound(v, own_power_bound(vertices[v].center, vertices[v].radius, off));
  }
  static double own_power_bound(const Point& center, double squared_radius, double off);
  void note_bound(Index v, double bound) {
    if (bound < power_bound(v)) set_error_class(v, error_class(bound), false, state_[v] & 3u);
  }
  bool settled(Index v) const { return error_class_of(v) != kNotSettled; }

  static constexpr std::uint8_t kUnknownError = 63, kNotSettled = 62;
  void store(Index v, const VoronoiVertex& vertex, std::uint8_t error_class, bool shared = false) {
    vertices[v] = vertex;
    set_error_class(v, error_class, shared, 0);
  }
  void store_but_neighbors(Index v, const VoronoiVertex& vertex, std::uint8_t error_class, bool shared) {
    vertices[v].center = vertex.center;
    vertices[v].radius = vertex.radius;
    vertices[v].forming_points = vertex.forming_points;
    set_error_class(v, error_class, shared, 0);
  }
  void resize(std::size_t count) {
    vertices.resize(count);
    state_.resize(count);
  }
  void append() {
    vertices.emplace_back();
    state_.emplace_back();
  }
  // Makes the system map the memory for `count` vertices, by several threads, because mapping takes longer than filling
  // it.
  void bring_in(std::size_t count);
  void clear() {
    vertices.clear();
    state_.clear();
    free_vertices.clear();
  }
  // Reserves memory for `count` vertices, of which about `used` will be used.
  void reserve(std::size_t count, std::size_t used);

 private:
#ifdef ORCHARD_FOUR_LANES
  ORCHARD_AVX2 __m256i states(const std::array<Index, 4>& v) const;
  ORCHARD_AVX2 __m256d bounds(__m256i states) const;
#endif
  Sign side_of_plane(Index v, const Point& q) const;
  double infinity_bound(Index v, const Vector& from_corner) const;
  Sign sign_at_infinity(Index v, const Point& q);
  Sign sign_from_points(Index v, const Point& q) const;
  std::uint8_t error_class(double bound) const;
  std::uint8_t error_class_of(Index v) const { return (state_[v] >> 2) & 63u; }
  void set_error_class(Index v, std::uint8_t error, bool shared, unsigned mark) {
    state_[v] = static_cast<std::uint16_t>((unsigned{error} << 2) | (shared ? kShared : 0u) | mark);
  }
  void find_error_class(Index v);
  bool has_own_center(Index v) const;
  Placing place_again(Index v, VoronoiVertex& placed, std::uint8_t& error) const;
  double residual(const VoronoiVertex& vertex) const;
  static double rounding_of_power(const Point& center, double squared_radius);

  static constexpr unsigned kShared = 1u << 8;
  std::vector<std::uint16_t> state_;                 // by vertex: the mark, the error class and kShared
  std::array<double, 64> bounds_{};                  // by error class
  double squared_scale_ = 1, per_min_bound_ = 1;     // powers of two, so that scaled input is treated exactly alike
  static constexpr double kThin = 0x1p-24;           // how far the noise may turn a facet of a good vertex, in radians
  static constexpr double kShaken = 0.125;           // the same for a vertex whose centre is of any use
  static constexpr double kSharpCondition = 0x1p12;  // with exact signs: above it, place_sharply() is needed
  // How far a point may be off a sphere that it is taken to be on, in multiples of the noise. It is more than 1 because
  // the centre of the sphere magnifies the noise of its own points. Larger values, up to the error bound, would give
  // points to a sphere by chance where many spheres nearly agree, as in a torus.
  static constexpr double kSphereNoise = 0x1p12;
  static constexpr double kFourPoints = 4;       // the noise of a tetrahedron's volume, over noise times largest face
  static constexpr double kWide = 0x1p8;         // a bound on a height is wide above this many times the noise
  static constexpr double kIntrusion = 0x1p-36;  // harmless_intrusion(), as a fraction of scale()
  static constexpr double kMaxNoise = 0x1p-40;   // see too_noisy()
  // Centres nearer to each other than this fraction of the sphere's size are the same, up to the rounding of moving
  // them into the frame and out of it.
  static constexpr double kSameCenter = 0x1p-45;
  bool exact_ = false;
  double noise_ = 0;        // a bound on the error of an input point
  double good_center_ = 0;  // centres with an error bound below this many squared radii are good
};

// Returns the smallest error class whose bound is at least the given one.
inline std::uint8_t Workspace::error_class(double bound) const {
  const double ratio = bound * per_min_bound_;
  if (!(ratio < 0x1p120)) return kUnknownError;
  if (ratio <= 1) return 0;
  const auto exponent = static_cast<unsigned>((std::bit_cast<std::uint64_t>(ratio) >> 52) - 1023);
  return static_cast<std::uint8_t>(exponent / 2 + 1);
}

inline Placing Workspace::place(VoronoiVertex& vertex, std::uint8_t& error, const Point& new_point,
                                const LengthedVector& a, const LengthedVector& b, const LengthedVector& c) const {
  const PlacedSphere placed = placed_sphere(new_point, noise_, a, b, c);
  vertex.center = placed.center;
  vertex.radius = placed.squared_radius;
  return judge(placed.quality, error);
}

inline Placing Workspace::judge(const PlacedQuality& placed, std::uint8_t& error) const {
  if (!placed.reliable() || !(placed.shake < kShaken)) return Placing::failed;
  error = error_class(placed.error);
  if (!(placed.volume6 > 0)) return Placing::failed;
  const bool thin = exact_ ? !(placed.condition < kSharpCondition) : !(placed.shake < kThin);
  return thin ? Placing::thin : Placing::good;
}

inline Placing Workspace::place_at_infinity(VoronoiVertex& vertex, std::uint8_t& error, const LengthedVector& a,
                                            const LengthedVector& b) const {
  const Vector normal = a.vector.cross(b.vector);
  const double length = normal.norm();
  const double condition = a.length * b.length / length;
  const double shake = noise_ * std::max(a.length, b.length) / length;
  if (!(condition * RelativeCenter::kCenterError < 0.125) || !(shake < kShaken)) return Placing::failed;
  vertex.center = normal / length;
  vertex.radius = std::numeric_limits<double>::quiet_NaN();
  // Here the class holds the error of a height above the facet, relative to the distance from one of its points.
  error = error_class(((16 * condition + 16) * kRounding + 4 * shake) * squared_scale_);
  return shake < kThin ? Placing::good : Placing::thin;
}

}  // namespace orchard::detail
