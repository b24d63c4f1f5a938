#include "spatial_hash.h"

#include <bit>
#include <chrono>
#include <cmath>

namespace orchard::bench {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
constexpr double kMiddle = 1 << 20;  // cells: makes all coordinates positive, so that truncating rounds down

std::uint32_t hash_of(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return x * 73856093u ^ y * 19349663u ^ z * 83492791u;
}

}  // namespace

SpatialHash::SpatialHash(const std::vector<Vec3>& positions, const std::vector<double>& radii, const Options& options)
    : positions_(positions), radii_(radii), per_length_(1 / options.cell_size), cubes_(options.cubes) {
  std::size_t buckets = std::bit_ceil(2 * positions.size());
  if (options.table_bytes > 0) buckets = std::bit_floor(std::max<std::size_t>(1, options.table_bytes / sizeof(Bucket)));
  buckets_.assign(buckets, Bucket{0, kNone});
  mask_ = static_cast<std::uint32_t>(buckets - 1);
}

std::size_t SpatialHash::memory_bytes() const {
  return buckets_.capacity() * sizeof(Bucket) + entries_.capacity() * sizeof(Entry);
}

SpatialHash::Range SpatialHash::range_of(BodyIndex i) const {
  Range range;
  for (std::size_t d = 0; d < 3; ++d) {
    const double x = positions_[i][d] * per_length_ + kMiddle, r = radii_[i] * per_length_;
    range.first[d] = static_cast<std::uint32_t>(x - r);
    range.last[d] = static_cast<std::uint32_t>(x + r);
  }
  return range;
}

template <bool Cubes>
void SpatialHash::enter(BodyIndex i, const Range& range, std::vector<BodyPair>& pairs) {
  const auto& [first, last] = range;
  const Vec3& p = positions_[i];
  const double r = radii_[i];
  constexpr int kCoordinateBits = 21;
  for (std::uint32_t z = first[2]; z <= last[2]; ++z) {
    for (std::uint32_t y = first[1]; y <= last[1]; ++y) {
      for (std::uint32_t x = first[0]; x <= last[0]; ++x) {
        Bucket& bucket = buckets_[hash_of(x, y, z) & mask_];
        if (bucket.stamp != stamp_) bucket = {stamp_, kNone};
        const std::uint64_t cell = (std::uint64_t{z} << kCoordinateBits | y) << kCoordinateBits | x;
        for (std::uint32_t e = bucket.entry; e != kNone; e = entries_[e].next) {
          const Entry& q = entries_[e];
          if (q.cell != cell) continue;
          const double reach = r + q.radius, dx = q.x - p[0], dy = q.y - p[1], dz = q.z - p[2];
          const bool meet = Cubes ? std::fabs(dx) <= reach && std::fabs(dy) <= reach && std::fabs(dz) <= reach
                                  : dx * dx + dy * dy + dz * dz <= reach * reach;
          if (!meet) continue;
          const Range other = range_of(q.body);
          if (std::max(first[0], other.first[0]) == x && std::max(first[1], other.first[1]) == y &&
              std::max(first[2], other.first[2]) == z) {
            pairs.push_back({std::min(i, q.body), std::max(i, q.body)});
          }
        }
        entries_.push_back({p[0], p[1], p[2], r, cell, i, bucket.entry});
        bucket.entry = static_cast<std::uint32_t>(entries_.size() - 1);
      }
    }
  }
}

template <bool Cubes>
void SpatialHash::find_all(std::vector<BodyPair>& pairs) {
  constexpr std::size_t kAhead = 16;
  ++stamp_;
  entries_.clear();
  std::array<Range, kAhead> ranges;
  for (std::size_t begin = 0; begin < positions_.size(); begin += kAhead) {
    const std::size_t count = std::min(kAhead, positions_.size() - begin);
    for (std::size_t k = 0; k < count; ++k) {
      ranges[k] = range_of(static_cast<BodyIndex>(begin + k));
      __builtin_prefetch(&buckets_[hash_of(ranges[k].first[0], ranges[k].first[1], ranges[k].first[2]) & mask_], 1);
    }
    for (std::size_t k = 0; k < count; ++k) enter<Cubes>(static_cast<BodyIndex>(begin + k), ranges[k], pairs);
  }
}

void SpatialHash::find(std::vector<BodyPair>& pairs) { cubes_ ? find_all<true>(pairs) : find_all<false>(pairs); }

namespace {

double fastest_of(SpatialHash& hash, int rounds) {
  std::vector<BodyPair> pairs;
  double fastest = 1e300;
  for (int round = 0; round < rounds; ++round) {
    pairs.clear();
    const auto begin = std::chrono::steady_clock::now();
    hash.find(pairs);
    fastest = std::min(fastest, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return fastest;
}

// The edge of the cube that each body has, were they spread evenly over the box around them.
double even_spacing(const std::vector<Vec3>& positions) {
  double volume = 1;
  for (std::size_t d = 0; d < 3; ++d) {
    const auto less = [&](const Vec3& a, const Vec3& b) { return a[d] < b[d]; };
    const auto [low, high] = std::minmax_element(positions.begin(), positions.end(), less);
    volume *= std::max(1.0, (*high)[d] - (*low)[d]);
  }
  return std::cbrt(volume / static_cast<double>(positions.size()));
}

}  // namespace

double SpatialHash::best_cell_size(const std::vector<Vec3>& positions, const std::vector<double>& radii, double spacing,
                                   const Options& options) {
  double best = spacing, least = 1e300;
  for (double size = 3; size < 2 * spacing + 3; size *= 1.4) {
    Options tried = options;
    tried.cell_size = size;
    SpatialHash hash(positions, radii, tried);
    const double fastest = fastest_of(hash, 5);
    if (fastest < least) least = fastest, best = size;
  }
  return best;
}

// From large cells to small ones, which take a hundred times as long where bodies are small for the distances between
// them, and many gigabytes of a million bodies: not tried once smaller ones have only been slower for a while.
double SpatialHash::best_cell_size(const std::vector<State>& states, const std::vector<double>& radii) {
  constexpr double kMaxEntries = 40;  // a body: cells so small are not worth trying
  constexpr double kMuchSlower = 2;
  constexpr int kSlowerInTurn = 3;  // sizes, much slower than the best one, after which smaller ones are left out
  double radius = 0, widest = 0, farthest = 0, best = 0, least = 1e300;
  for (const double r : radii) radius += r / static_cast<double>(radii.size());
  for (const State& state : states) {
    widest = std::max(widest, even_spacing(state));
    for (const Vec3& p : state) farthest = std::max({farthest, std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2])});
  }
  int slower = 0;
  double size = std::max(3 * widest, 8 * radius);
  while (size >= 0.5 * radius && slower < kSlowerInTurn) {
    double entries = 0;
    for (const double r : radii) entries += std::pow(1 + 2 * r / size, 3);
    if (entries > kMaxEntries * static_cast<double>(radii.size()) || farthest > 0.9 * kMiddle * size) break;
    double sum = 0;
    for (const State& state : states) {
      SpatialHash hash(state, radii, {size});
      sum += fastest_of(hash, 3);
      if (sum > kMuchSlower * least) break;
    }
    slower = sum > kMuchSlower * least ? slower + 1 : 0;
    if (sum < least) least = sum, best = size;
    size /= 1.25;
  }
  return best;
}

}  // namespace orchard::bench
