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

// What placing a vertex came to.
enum class Placing : std::uint8_t {
  good,
  shared,  // its own centre would be poor, but it is on a neighbour's sphere as far as the input goes: that is taken
  thin,    // the forming points are so near to coplanar that a doubt elsewhere could move the centre far
  failed,  // no centre worth having, or wrongly oriented
};

// What an insertion knows of a vertex so far.
enum class Mark : std::uint8_t { unseen, deleted, kept, wanted };

// Which of four it is that is told by the second, the third and the fourth, without branches: it is as good as random.
inline std::size_t index_of_four(bool is_second, bool is_third, bool is_fourth) {
  return static_cast<std::size_t>(is_second | is_fourth) + 2 * static_cast<std::size_t>(is_third | is_fourth);
}
// Where one of four numbers is.
inline std::size_t index_of(const std::array<Index, 4>& numbers, Index number) {
  return index_of_four(numbers[1] == number, numbers[2] == number, numbers[3] == number);
}

// A diagram under construction. Its vertices differ from the finished ones: `radius` holds the square of the radius,
// and no number at infinity, where the infinite point always comes last. Freed vertices have no neighbours.
//
// Each vertex has a bound on the error of  squared radius - squared distance  when its stored centre is used: rounded
// up to a power of four and kept in six bits, so that a test costs a distance, a look-up and a comparison.
class Workspace {
 public:
  std::vector<Point> points;
  std::vector<VoronoiVertex> vertices;
  std::vector<Index> free_vertices;

  // The lengths that the bounds are made of: the box of the points, and how far rounding may have moved a coordinate.
  // Input points count as exact to kInputNoise times that only: what rounding has put off a plane or a sphere still is
  // on it, or else half of the signs there would be certain and half in doubt.
  void set_scale(const Box& box, double rounding);
  static constexpr double kInputNoise = 4;
  // The same as those of another one.
  void take_scale(const Workspace& other);
  // Whether the input's noise is too near to what counts as harm for doubts to be settled by it.
  bool too_noisy() const { return noise_ > kMaxNoise * scale(); }
  // From now on signs are exact, as if the input had no noise: slower, and slivers appear where rounding has put points
  // off a plane, but consistent whatever the input. For input that is off by more than rounding but by too little.
  void set_exact(bool exact) { exact_ = exact; }
  bool exact() const { return exact_; }
  // For a diagram all of whose signs are exact: the input has no noise.
  void forget_noise() { noise_ = 0; }

  void prefetch(Index v) const {
    __builtin_prefetch(vertices.data() + v);
    __builtin_prefetch(state_.data() + v);
  }
  // Those of a vertex that others may be giving new neighbours meanwhile, elsewhere (see Region).
  std::array<Index, 4> neighbors_now(Index v) const {
    return {neighbor_now(v, 0), neighbor_now(v, 1), neighbor_now(v, 2), neighbor_now(v, 3)};
  }
  Index neighbor_now(Index v, unsigned slot) const {
    return std::atomic_ref(const_cast<Index&>(vertices[v].neighbors[slot])).load(std::memory_order_relaxed);
  }
  // index_of() the neighbor among them, without writing them to memory.
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
  void add_mark(Index v, bool condition, Mark mark) {  // to an unseen one
    state_[v] = static_cast<std::uint16_t>(state_[v] | (condition ? unsigned(mark) : 0u));
  }
  // To unseen ones, of which these have a bit set.
  void add_marks(const std::array<Index, 4>& v, unsigned deleted, unsigned kept) {
    static_assert(unsigned(Mark::deleted) == 1 && unsigned(Mark::kept) == 2);
    for (unsigned i = 0; i < 4; ++i)
      state_[v[i]] = static_cast<std::uint16_t>(state_[v[i]] | ((deleted >> i) & 1u) | (((kept >> i) & 1u) << 1));
  }
  void set_mark(Index v, Mark mark) { state_[v] = static_cast<std::uint16_t>((state_[v] & ~3u) | unsigned(mark)); }

  // The squared radius minus the squared distance to q by the stored centre; no number at infinity.
  double power(Index v, const Point& q) const { return vertices[v].radius - (vertices[v].center - q).squaredNorm(); }
  double power_bound(Index v) const { return bounds_[error_class_of(v)]; }
  // Below this many squared radii of its own, the bound of a vertex at a place leaves the doubt in the input: its signs
  // are uncertain then wherever the bound does not tell. 0 with exact signs.
  double doubtful_input() const { return exact_ ? 0 : good_center_; }
#ifdef ORCHARD_FOUR_LANES
  // What power() and power_bound() tell of four vertices, and their marks: a bit for each. far or near, where the bound
  // tells; where it does not, input: the bound is below so many squared radii.
  struct FourTests {
    struct Marks {
      unsigned unseen, kept;
    } marks;
    unsigned far, near, input;
  };
  ORCHARD_AVX2 FourTests test_four(const std::array<Index, 4>& v, const FourVectors& q, double doubtful_input) const;
  // A bit for each of four pairs of vertices whose spheres are their own ones and that of the first certainly does not
  // hold q, or which have the same one.
  ORCHARD_AVX2 unsigned agree_four(const std::array<Index, 4>& v, const std::array<Index, 4>& u,
                                   const FourVectors& q) const;
  // Of four finite vertices; a mask where the sphere is a neighbour's, or may be.
  struct FourSpheres {
    __m256d radius, power_bound, shared;
  };
  ORCHARD_AVX2 FourSpheres spheres(const std::array<Index, 4>& v) const;
  // As own_power_bound(), by the radii and their squares, in the same order of operations.
  ORCHARD_AVX2 static __m256d own_power_bounds(const FourVectors& center, __m256d squared_radius, __m256d radius,
                                               __m256d off);
#endif
  // Whether its sphere is a neighbour's, or may be.
  bool shares_sphere(Index v) const { return (state_[v] & kShared) != 0; }

  // Whether the vertex is nearer to q than to its forming points. At infinity: whether q lies beyond the hull's facet.
  Sign sign(Index v, const Point& q) {
    const double p = power(v, q), bound = power_bound(v);
    if (p > bound) return Sign::positive;
    if (p < -bound) return Sign::negative;
    return doubtful_sign(v, q, bound);
  }

  // The same where the stored centre does not tell.
  Sign doubtful_sign(Index v, const Point& q, double bound);

  // doubtful_sign() of those of four vertices that have a bit set, as far as it is soon told by their points: uncertain
  // may stand for any.
  std::array<Sign, 4> doubtful_signs(const std::array<Index, 4>& v, unsigned which, const Point& q) const;

  // How deep a point in a sphere does no harm, unless many such are met on one line (see certificate.h).
  double harmless_intrusion() const { return kIntrusion * scale(); }
  // Whether the error bound of a placed vertex alone, of which input noise over a height is a part (see place()), shows
  // that power over twice this height is below the harmless intrusion.
  bool harmless(double power, const VoronoiVertex& placed, std::uint8_t error_class) const {
    return power * bounds_[error_class] < 16 * harmless_intrusion() * placed.radius * noise_;
  }
  // The dissertation's value of a deletion: distance to the forming points minus distance to q; at infinity the limit
  // of that along the unbounded edge, which is the distance of q beyond the facet.
  double value(Index v, const Point& q) const;

  // The position of a vertex of the new point and three others a, b, c, given relative to it, where rounding permits a
  // centre worth having, and the volume a . (b x c) is positive.
  Placing place(VoronoiVertex& vertex, std::uint8_t& error_class, const Point& new_point, const LengthedVector& a,
                const LengthedVector& b, const LengthedVector& c) const;
  // What place() comes to, for a sphere that placed_sphere() or place_four() placed with this noise. The class is set
  // where the centre is worth anything.
  Placing judge(const PlacedQuality& placed, std::uint8_t& error_class) const;
  // What is good by these judge() calls good, and it is not poor, or may be where that does not matter.
  PlacingLimits placing_limits(bool may_be_poor) const {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    return {noise_, exact_ ? kShaken : kThin, exact_ ? kSharpCondition : kNone,
            exact_ || may_be_poor ? kNone : good_center_, bounds_[0]};
  }
  // The same at infinity, beyond the facet of the new point, a and b.
  Placing place_at_infinity(VoronoiVertex& vertex, std::uint8_t& error_class, const LengthedVector& a,
                            const LengthedVector& b) const;
  // Whether the placed vertex, one of these, may be off by more than the input's noise.
  bool poor(const VoronoiVertex& vertex, std::uint8_t error_class) const {
    return !(bounds_[error_class] < good_center_ * vertex.radius);
  }
  bool poor(Index v) const { return poor(vertices[v], error_class_of(v)); }
  // For a vertex of the new point that forms a facet with v, if that puts it on the sphere of v as far as the input
  // goes: takes over this very sphere and its error bound, so that all vertices of many points on one sphere have the
  // same sign for the next. False, and no change, if not.
  bool share_sphere(VoronoiVertex& vertex, std::uint8_t& error_class, Index v, const Point& new_point) const;
  // Whether share_sphere() may be true.
  bool may_share_sphere(Index v, const Point& new_point) const {
    const double sphere = kSphereNoise * noise_ * std::sqrt(vertices[v].radius);
    return std::abs(power(v, new_point)) <= std::min(sphere, power_bound(v));  // not at infinity
  }
  // A length far beyond the points, for vertices whose place is as good as infinite.
  double far() const { return 1024 * scale(); }
  double scale() const { return std::sqrt(squared_scale_); }  // the size of the points' box, to a factor of two
  // Copies the vertices of a finished diagram of `points`, with room for some more. Their error bounds are infinite
  // until somebody asks: most vertices are never looked at again.
  void adopt(std::span<const VoronoiVertex> finished, const Frame& frame, std::size_t more);
  // Finds the error bound of an adopted vertex out. To be called before power() and power_bound() are relied on; sign()
  // does it by itself.
  void settle(Index v) {
    if (!settled(v)) [[unlikely]]
      find_error_class(v);
  }
  // Gives a finite vertex the sphere of its forming points, to some roundings; false if they have none.
  bool place_sharply(Index v);
  void place_sharply(Index v, const Vector& center);  // which is relative to its first point
  // The same for all that were made with exact signs and whose centres call for sharper arithmetic than they got then.
  // The number of those that keep an approximate place.
  std::size_t place_thin_vertices();
  // The same with this sphere, by which the error of a power is no more than the bound.
  void place_by_bound(Index v, const Point& center, double squared_radius, double bound) {
    vertices[v].center = center;
    vertices[v].radius = squared_radius;
    set_error_class(v, error_class(bound), false, state_[v] & 3u);
  }
  // Leaves it where it is, with the bound that follows from how far, at most, it is off that centre.
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
  // Has the system map the room for so many vertices, by several threads: that takes longer than to fill it.
  void bring_in(std::size_t count);
  void clear() {
    vertices.clear();
    state_.clear();
    free_vertices.clear();
  }
  // Room for so many vertices, of which so many are likely to be used.
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
  std::vector<std::uint16_t> state_;                 // mark, error class above, kShared
  std::array<double, 64> bounds_{};                  // by error class
  double squared_scale_ = 1, per_min_bound_ = 1;     // powers of two, so that scaled input is treated exactly alike
  static constexpr double kThin = 0x1p-24;           // how far the noise may turn a facet of a good vertex, in radians
  static constexpr double kShaken = 0.125;           // the same of one that is worth anything
  static constexpr double kSharpCondition = 0x1p12;  // with exact signs: where a centre calls for sharper arithmetic
  // How many times the noise a point may be off a sphere that it is taken to be on: the sphere's centre magnifies the
  // noise of its own points. More, up to the error bound, would make chance a rule where many spheres nearly agree, as
  // those within a torus do.
  static constexpr double kSphereNoise = 0x1p12;
  static constexpr double kFourPoints = 4;        // the noise of four points off a plane, in terms of the largest face
  static constexpr double kWide = 0x1p8;          // a bound on a height is wide above this many times the noise
  static constexpr double kIntrusion = 0x1p-36;   // harmless_intrusion() in terms of scale()
  static constexpr double kMaxNoise = 0x1p-40;    // see too_noisy()
  static constexpr double kSameCenter = 0x1p-45;  // of a sphere's size: some roundings, going in and out of the frame
  bool exact_ = false;
  double noise_ = 0;        // how far off an input point may be
  double good_center_ = 0;  // an error bound below this many squared radii
};

// The smallest class whose bound is not below the given one.
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
