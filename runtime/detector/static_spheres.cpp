#include "detector/static_spheres.h"

#include <algorithm>
#include <bit>

#include "simd/machine.h"

namespace orchard::runtime::detail {
namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t kFewChanges = 256;

constexpr auto kLaneBits = [] {
  std::array<std::uint32_t, 32> bits{};
  for (std::size_t lane = 0; lane < bits.size(); ++lane) bits[lane] = 1u << lane;
  return bits;
}();

// The lanes for which test(lane) holds, as bits: no branches, so that it becomes comparisons of vectors.
template <std::size_t kLanes, typename Test>
ORCHARD_INLINE std::uint32_t lanes_where(Test&& test) noexcept {
  static_assert(kLanes <= kLaneBits.size());
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) bits |= test(lane) ? kLaneBits[lane] : 0;
  return bits;
}

// use(lane) for each of these.
template <typename Use>
ORCHARD_INLINE void for_lanes(std::uint32_t bits, Use&& use) {
  for (; bits != 0; bits &= bits - 1) use(static_cast<std::size_t>(std::countr_zero(bits)));
}

}  // namespace

// A sum of floats is off by 2^-24 of itself.
StaticSpheres::Box StaticSpheres::box_around(const FloatSphere& sphere) noexcept {
  Box box;
  const std::array<float, 3> center = {sphere.x, sphere.y, sphere.z};
  for (std::size_t d = 0; d < 3; ++d) {
    const float spare = 0x1p-22f * (std::fabs(center[d]) + sphere.radius);
    box.low[d] = (center[d] - sphere.radius) - spare;
    box.high[d] = (center[d] + sphere.radius) + spare;
  }
  return box;
}

void StaticSpheres::take_away(BodyIndex body) noexcept {
  if (body >= places_.size()) return;
  gone_ += places_[body].spheres;
  places_[body] = {places_[body].version + 1, 0};
}

void StaticSpheres::put(BodyIndex body, std::span<const FloatSphere> spheres) {
  grow(places_, std::size_t{body} + 1);
  take_away(body);
  Place& place = places_[body];
  for (const FloatSphere& sphere : spheres) append(spheres_, {sphere, body, place.version});
  place.spheres = static_cast<std::uint32_t>(spheres.size());
  if (gone_ > spheres_.size() / 2 + kFewChanges) sort();  // no query may come for long
}

// By the coordinate in which they differ most, the radius being one: large ones stay with large ones. In parts of whole
// groups.
void StaticSpheres::split(std::span<Sphere> spheres) {
  if (spheres.size() <= kGroup) return;
  constexpr std::array kCoordinates = {&FloatSphere::x, &FloatSphere::y, &FloatSphere::z, &FloatSphere::radius};
  float FloatSphere::*widest = kCoordinates[0];
  float most = -1;
  for (float FloatSphere::*const coordinate : kCoordinates) {
    const auto [low, high] = std::minmax_element(
        spheres.begin(), spheres.end(),
        [coordinate](const Sphere& p, const Sphere& q) { return p.at.*coordinate < q.at.*coordinate; });
    const float spread = high->at.*coordinate - low->at.*coordinate;
    if (spread > most) most = spread, widest = coordinate;
  }
  const std::size_t half = std::max(kGroup, std::bit_ceil(spheres.size()) / 2);
  std::nth_element(spheres.begin(), spheres.begin() + static_cast<std::ptrdiff_t>(half), spheres.end(),
                   [widest](const Sphere& p, const Sphere& q) { return p.at.*widest < q.at.*widest; });
  split(spheres.first(half));
  split(spheres.subspan(half));
}

// spheres_[place], whose place is the next one, into its group, and the boxes around that.
void StaticSpheres::enter(std::size_t place) {
  const Sphere& sphere = spheres_[place];
  if (place % kGroup == 0) {
    SphereGroup& added = groups_.emplace_back();
    for (auto& lanes : added.at) lanes.fill(kNothing);
    added.body.fill(kNoIndex), added.version.fill(0);
  }
  SphereGroup& group = groups_.back();
  const std::size_t lane = place % kGroup;
  const std::array at = {sphere.at.x, sphere.at.y, sphere.at.z, sphere.at.radius};
  for (std::size_t d = 0; d < 4; ++d) group.at[d][lane] = at[d];
  group.body[lane] = sphere.body, group.version[lane] = sphere.version;
  const Box box = box_around(sphere.at);
  const std::size_t index = place / kGroup, in_boxes = index % kGroup;
  if (index / kGroup == boxes_.size()) {
    BoxGroup& added = boxes_.emplace_back();
    for (std::size_t d = 0; d < 3; ++d) added.low[d].fill(kNothing), added.high[d].fill(kNothing);
  }
  for (std::size_t d = 0; d < 3; ++d) {
    float &low = boxes_.back().low[d][in_boxes], &high = boxes_.back().high[d][in_boxes];
    low = low <= box.low[d] ? low : box.low[d];
    high = high >= box.high[d] ? high : box.high[d];
  }
}

void StaticSpheres::sort() {
  std::erase_if(spheres_, [this](const Sphere& sphere) { return !is_there(sphere.body, sphere.version); });
  split(spheres_);
  groups_.clear();
  boxes_.clear();
  sorted_ = spheres_.size();
  gone_ = entered_ = 0;
}

void StaticSpheres::prepare() {
  if (gone_ + spheres_.size() - sorted_ > spheres_.size() / 4 + kFewChanges) sort();
  for (; entered_ < spheres_.size(); ++entered_) enter(entered_);
}

ORCHARD_INLINE std::uint32_t StaticSpheres::meeting(const BoxGroup& boxes, const Box& box) noexcept {
  return lanes_where<kGroup>([&](std::size_t lane) ORCHARD_INLINE_LAMBDA {
    const auto meets = [&](std::size_t d) ORCHARD_INLINE_LAMBDA {
      return static_cast<int>(boxes.low[d][lane] <= box.high[d]) & static_cast<int>(boxes.high[d][lane] >= box.low[d]);
    };
    return (meets(0) & meets(1) & meets(2)) != 0;
  });
}

ORCHARD_INLINE std::uint32_t StaticSpheres::touching(const SphereGroup& spheres, const FloatSphere& sphere) noexcept {
  return lanes_where<kGroup>([&](std::size_t lane) ORCHARD_INLINE_LAMBDA {
    const float x = spheres.at[0][lane] - sphere.x, y = spheres.at[1][lane] - sphere.y,
                z = spheres.at[2][lane] - sphere.z, reach = spheres.at[3][lane] + sphere.radius;
    return x * x + y * y + z * z <= reach * reach;
  });
}

ORCHARD_INLINE void StaticSpheres::append_all(const FloatSphere& sphere, std::vector<BodyIndex>& bodies) const {
  const Box box = box_around(sphere);
  for (std::size_t first = 0; first < boxes_.size(); ++first) {
    for_lanes(meeting(boxes_[first], box), [&](std::size_t lane) ORCHARD_INLINE_LAMBDA {
      const SphereGroup& spheres = groups_[first * kGroup + lane];
      for_lanes(touching(spheres, sphere), [&](std::size_t hit) ORCHARD_INLINE_LAMBDA {
        const BodyIndex body = spheres.body[hit];
        if (is_there(body, spheres.version[hit])) bodies.push_back(body);
      });
    });
  }
}

void StaticSpheres::append_touching(const FloatSphere& sphere, std::vector<BodyIndex>& bodies) const {
  per_machine([&]() ORCHARD_INLINE_LAMBDA { append_all(sphere, bodies); });
}

std::size_t StaticSpheres::memory_bytes() const noexcept { return bytes_of(places_, spheres_, groups_, boxes_); }

}  // namespace orchard::runtime::detail
