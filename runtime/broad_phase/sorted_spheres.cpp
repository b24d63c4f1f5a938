#include "broad_phase/sorted_spheres.h"

#include <bit>

#include "broad_phase/horn.h"
#include "broad_phase/motion_lanes.h"
#include "broad_phase/swept_grid.h"

namespace orchard::runtime::detail {
namespace {

constexpr double kCellSpare = 1 + 0x1p-12;  // a factor; more than the rounding errors of coordinates in the grid
constexpr double kOriginCell = 0x1p30;      // coordinate of the origin's cell; the largest is twice as much
constexpr double kCellsPerSpacing = 2;      // smaller cells do not have fewer bodies
constexpr std::size_t kLargeShare = 256;    // one in so many bodies may be larger than a cell
constexpr std::size_t kMaxTests = 64;       // per body and pair; with more tests, boxes are the better choice
constexpr std::size_t kLanes = 4;           // so many numbers may be read beyond the last sphere
constexpr std::uint32_t kLarge = ~0u;       // the line of spheres that are larger than a cell

}  // namespace

void SortedSpheres::begin(std::size_t bodies, const Vec3& origin, double spacing) {
  const std::size_t lines = std::bit_ceil(std::max<std::size_t>(2 * bodies, std::size_t{1} << kMinLineBits));
  const unsigned bits = std::min(static_cast<unsigned>(std::countr_zero(lines)), kMaxLineBits);
  factors_ = line_factors(bits);
  mask_ = (1u << bits) - 1;
  origin_ = origin;
  spacing_ = spacing;
  begins_.assign(std::size_t{mask_} + 4, 0);
  spheres_.clear();
  spheres_.reserve(bodies);
  large_.clear();
  pairs_.clear();
  tests_ = 0;
  per_length_ = cell_ > 0 ? 1 / cell_ : 0;
}

// Returns the coordinate of a cell. It is monotone, and clamped for what is too far away, so neighbours remain
// neighbours.
std::uint32_t SortedSpheres::coordinate(double x, std::size_t axis) const noexcept {
  const double cells = (x - origin_[axis]) * per_length_ + kOriginCell;
  return static_cast<std::uint32_t>(std::clamp(cells, 1.0, 2 * kOriginCell));
}

std::uint32_t SortedSpheres::line_of(const Vec3& center) const noexcept {
  return (coordinate(center[0], 0) + coordinate(center[1], 1) * factors_[1] + coordinate(center[2], 2) * factors_[2]) &
         mask_;
}

void SortedSpheres::enter(Sphere& sphere) {
  if (2 * sphere.radius * kCellSpare > cell_) {
    sphere.line = kLarge;
    large_.push_back(static_cast<std::uint32_t>(&sphere - spheres_.data()));
    return;
  }
  sphere.line = line_of(sphere.center);
  ++begins_[sphere.line + 1];
}

void SortedSpheres::add(std::span<const BodyIndex> bodies, std::span<const Motion> motions) {
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    spheres_.push_back({motions[k].position, motions[k].radius, bodies[k], 0});
    enter(spheres_.back());
  }
}

// Chooses the width of a cell so that few spheres are larger, and enters all spheres again.
void SortedSpheres::choose_cell() {
  sorted_.x.clear();
  for (const Sphere& sphere : spheres_) sorted_.x.push_back(sphere.radius);
  const auto nth = sorted_.x.end() - 1 - static_cast<std::ptrdiff_t>(sorted_.x.size() / kLargeShare);
  std::nth_element(sorted_.x.begin(), nth, sorted_.x.end());
  cell_ = std::max({2 * *nth * kCellSpare * kCellSpare, spacing_ / kCellsPerSpacing, 4 * kMinLength});
  per_length_ = 1 / cell_;
  std::fill(begins_.begin(), begins_.end(), 0);
  large_.clear();
  for (Sphere& sphere : spheres_) enter(sphere);
}

void SortedSpheres::sort() {
  const std::size_t lines = std::size_t{mask_} + 1;
  for (std::size_t line = 0; line < lines; ++line) begins_[line + 1] += begins_[line];
  const std::uint32_t count = begins_[lines], first = begins_[1], second = begins_[2];
  const std::size_t room = std::size_t{count} + second + kLanes;
  for (std::vector<double>* numbers : {&sorted_.x, &sorted_.y, &sorted_.z, &sorted_.radius}) {
    if (numbers->size() < room) numbers->resize(room);
  }
  if (sorted_.body.size() < room) sorted_.body.resize(room);
  for (const Sphere& sphere : spheres_) {
    if (sphere.line == kLarge) continue;
    const std::uint32_t place = begins_[sphere.line]++;
    sorted_.x[place] = sphere.center[0], sorted_.y[place] = sphere.center[1], sorted_.z[place] = sphere.center[2];
    sorted_.radius[place] = sphere.radius;
    sorted_.body[place] = sphere.body;
  }
  for (std::size_t line = lines; line > 0; --line) begins_[line] = begins_[line - 1];
  begins_[0] = 0;
  begins_[lines + 1] = count + first;
  begins_[lines + 2] = count + second;
  for (std::uint32_t k = 0; k < second; ++k) {
    sorted_.x[count + k] = sorted_.x[k], sorted_.y[count + k] = sorted_.y[k], sorted_.z[count + k] = sorted_.z[k];
    sorted_.radius[count + k] = sorted_.radius[k];
    sorted_.body[count + k] = sorted_.body[k];
  }
}

// Returns how many lines after that of a cell the four rows of three neighbours begin that come after it, apart from
// its own row.
std::array<std::uint32_t, 4> SortedSpheres::neighbour_rows() const noexcept {
  return {factors_[1] - 1, factors_[2] - factors_[1] - 1, factors_[2] - 1, factors_[2] + factors_[1] - 1};
}

template <typename Kind>
ORCHARD_INLINE void SortedSpheres::compare(std::uint32_t i, Run run) {
  constexpr std::uint32_t kWidth = Kind::kLanes;
  const BodyIndex body = sorted_.body[i];
  for (std::uint32_t at = run.begin; at < run.end; at += kWidth) {
    const auto off = [&](const std::vector<double>& of)
                         ORCHARD_INLINE_LAMBDA { return load_lanes<Kind>(&of[at]) - all_of<Kind>(of[i]); };
    const auto dx = off(sorted_.x), dy = off(sorted_.y), dz = off(sorted_.z);
    const auto reach = load_lanes<Kind>(&sorted_.radius[at]) + all_of<Kind>(sorted_.radius[i]);
    std::uint32_t bits = Kind::bits(dx * dx + dy * dy + dz * dz <= reach * reach);
    if (run.end - at < kWidth) bits &= (1u << (run.end - at)) - 1;
    for (; bits != 0; bits &= bits - 1) {
      const BodyIndex other = sorted_.body[at + static_cast<std::uint32_t>(std::countr_zero(bits))];
      pairs_.push_back({std::min(body, other), std::max(body, other)});
    }
  }
}

template <typename Kind>
ORCHARD_INLINE void SortedSpheres::find_all() {
  const std::array<std::uint32_t, 4> rows = neighbour_rows();
  std::array<Run, 5> runs;
  for (std::uint32_t line = 0; line <= mask_; ++line) {
    const std::uint32_t begin = begins_[line], end = begins_[line + 1];
    if (begin == end) continue;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const std::uint32_t first = (line + rows[k]) & mask_;
      runs[k + 1] = {begins_[first], begins_[first + 3]};
      tests_ += (end - begin) * std::uint64_t{runs[k + 1].end - runs[k + 1].begin};
    }
    tests_ += (end - begin) * std::uint64_t{begins_[line + 2] - begin};
    for (std::uint32_t i = begin; i < end; ++i) {
      runs[0] = {i + 1, begins_[line + 2]};
      for (const Run& run : runs) compare<Kind>(i, run);
    }
  }
}

void SortedSpheres::compare_large() {
  for (const std::uint32_t index : large_) {
    const Sphere& large = spheres_[index];
    for (std::uint32_t other = 0; other < spheres_.size(); ++other) {
      const Sphere& sphere = spheres_[other];
      if (sphere.line == kLarge && other >= index) continue;  // the pair is found from the other sphere
      const Vec3 apart = sphere.center - large.center;
      const double reach = sphere.radius + large.radius;
      if (dot(apart, apart) > reach * reach) continue;
      pairs_.push_back({std::min(large.body, sphere.body), std::max(large.body, sphere.body)});
    }
  }
}

std::span<const BodyPair> SortedSpheres::find() {
  const bool too_many = large_.size() > spheres_.size() / kLargeShare;
  if (!spheres_.empty() && (cell_ == 0 || too_many)) choose_cell();
  sort();
  with_best_lanes([&]<typename Kind>() ORCHARD_INLINE_LAMBDA { find_all<Kind>(); });
  compare_large();
  return pairs_;
}

bool SortedSpheres::suits() const noexcept { return tests_ <= kMaxTests * (spheres_.size() + pairs_.size()); }

bool SortedSpheres::append_near(const Vec3& lower, const Vec3& upper, std::vector<BodyIndex>& bodies) const {
  if (spheres_.empty()) return true;
  std::array<std::uint32_t, 3> first, last;
  double cells = 1;
  for (std::size_t d = 0; d < 3; ++d) {
    first[d] = coordinate(lower[d] - cell_, d), last[d] = coordinate(upper[d] + cell_, d);
    cells *= last[d] - first[d] + 1.0;
  }
  if (cells > static_cast<double>(spheres_.size())) return false;
  for (std::uint32_t z = first[2]; z <= last[2]; ++z) {
    for (std::uint32_t y = first[1]; y <= last[1]; ++y) {
      for (std::uint32_t x = first[0]; x <= last[0]; ++x) {
        const std::uint32_t line = (x + y * factors_[1] + z * factors_[2]) & mask_;
        bodies.insert(bodies.end(), sorted_.body.begin() + begins_[line], sorted_.body.begin() + begins_[line + 1]);
      }
    }
  }
  for (const std::uint32_t index : large_) bodies.push_back(spheres_[index].body);
  return true;
}

void SortedSpheres::release() { *this = {}; }

std::size_t SortedSpheres::memory_bytes() const noexcept {
  return bytes_of(spheres_, begins_, sorted_.x, sorted_.y, sorted_.z, sorted_.radius, sorted_.body, large_, pairs_);
}

}  // namespace orchard::runtime::detail
