#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "orchard/runtime/motion.h"

namespace orchard::broad_phase_methods {

using runtime::Motion;
using runtime::Vec3;

inline constexpr double kNoContact = std::numeric_limits<double>::infinity();

// Where a body can be from time 0 to `duration`, the same for all bodies compared (dissertation 4.1). Times are seconds
// since that common start, not normalised to [0, 1] as in the dissertation.
//   parabolic horn:          the ball around c(t) = center + velocity t with radius h(t) = size + growth t + bend t^2
//   quadratic bound (8.2):   the isothetic cube around that ball
//   hypertrapezoid (4.1.3):  the cube around c(t) with half the edge size + slope t, equal to the last one at 0 and at
//                            the end, larger between
//   cutting plane (4.1.4):   the half-space (x - c(t)) . normal <= cut + cut_growth t; none if normal is zero
// The cutting plane belongs to each of them. Everything is enlarged by runtime::kMotionSlack.
struct SpaceTimeBound {
  Vec3 center{}, velocity{};
  double size = 0, growth = 0, bend = 0, slope = 0;
  Vec3 normal{};  // of length 1
  double cut = 0, cut_growth = 0;

  bool has_plane() const noexcept { return dot(normal, normal) != 0; }
  Vec3 center_at(double t) const noexcept { return center + t * velocity; }
  double horn_radius(double t) const noexcept { return size + t * (growth + t * bend); }
  double trapezoid_half(double t) const noexcept { return size + t * slope; }
};

// From a motion of `age` seconds ago; it holds until the end of the interval. A bound that started earlier is chopped
// off at the new start (4.3). `slack` is added to the radius: what the position may be wrong by.
SpaceTimeBound make_bound(const Motion& motion, double age, double duration, double slack = 0) noexcept;

enum class BoundShape : std::uint8_t { hypertrapezoid, quadratic, horn };

// The first t in [0, duration] at which the two bounds have a point in common, or kNoContact. Closed: touching counts.
// Without cutting planes it is exact to rounding. With them it is exact for hypertrapezoids: it is then the first time
// at which a face meets a face that no plane has cut off, a face meets a cutting plane (4.2.6) or two cutting planes
// meet (4.2.7). Horns and quadratic bounds with planes take the later of their own contact and the hypertrapezoids',
// which enclose them: never late.
double first_contact(const SpaceTimeBound& a, const SpaceTimeBound& b, double duration, BoundShape shape) noexcept;

// The points that both bounds' cubes and cutting planes have in common at t: is there one?
bool cut_cubes_meet(const SpaceTimeBound& a, const SpaceTimeBound& b, double t) noexcept;

struct BoundContact {
  double time;
  std::uint32_t a, b;  // into the bounds; a < b
};

enum class IntersectionMethod : std::uint8_t {
  all_pairs,    // first_contact() of every pair: the reference, any shape
  projection,   // 4.2.3: a sweep over the faces' projections on an axis and time; hypertrapezoids, quadratic bounds
  subdivision,  // 4.2.4: 16-way cells in space and time; hypertrapezoids
  hybrid,       // 8.2: few cells, projection in each; hypertrapezoids
  sorted        // along x by what the bounds sweep, then first_contact(): meant for horns; any shape
};

struct IntersectionOptions {
  IntersectionMethod method = IntersectionMethod::projection;
  BoundShape shape = BoundShape::hypertrapezoid;
  std::uint32_t base_case = 32;  // n_b of 4.2.4: faces in a cell that is not divided further
};

// What a search did, for growth curves that no clock blurs.
struct SearchCounts {
  std::size_t crossings = 0;       // of projected segments, which the sweeps processed
  std::size_t base_cells = 0;      // of the subdivision, that were not divided further
  std::size_t faces_in_cells = 0;  // in all of those together; a face counts in each
};

struct Intersections {
  // All pairs whose cubes (horns: balls) meet at t = 0 (4.3), each with its first_contact(), which is later than 0 or
  // never where a cutting plane keeps them apart. In ascending order of pairs.
  std::vector<BoundContact> initial;
  // The earliest contact of all, those included; time kNoContact if there is none. Of several at the same time, any.
  BoundContact earliest{kNoContact, 0, 0};
  SearchCounts counts;
};

// False: the two, a < b, are not to be compared. It has to answer alike while find() runs.
using BoundFilter = std::function<bool(std::uint32_t a, std::uint32_t b)>;

// Finds where N bounds first meet between 0 and `duration` (Fig. 4.22), and which meet at the start. Every method gives
// the same time, to rounding. A method that does not know the shape is replaced by `sorted`.
// The object keeps its memory from call to call.
class IntersectionFinder {
 public:
  IntersectionFinder();
  IntersectionFinder(IntersectionFinder&&) noexcept;
  IntersectionFinder& operator=(IntersectionFinder&&) noexcept;
  ~IntersectionFinder();

  const Intersections& find(std::span<const SpaceTimeBound> bounds, double duration, const IntersectionOptions& options,
                            const BoundFilter& filter = {});
  std::size_t memory_bytes() const noexcept;

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace orchard::broad_phase_methods
