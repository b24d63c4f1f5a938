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
  for (std::uint32_t z = first[2]; z <= last[2]; ++z) {
    for (std::uint32_t y = first[1]; y <= last[1]; ++y) {
      for (std::uint32_t x = first[0]; x <= last[0]; ++x) {
        Bucket& bucket = buckets_[hash_of(x, y, z) & mask_];
        if (bucket.stamp != stamp_) bucket = {stamp_, kNone};
        for (std::uint32_t e = bucket.entry; e != kNone; e = entries_[e].next) {
          const Entry& q = entries_[e];
          const double reach = r + q.radius, dx = q.x - p[0], dy = q.y - p[1], dz = q.z - p[2];
          const bool meet = Cubes ? std::fabs(dx) <= reach && std::fabs(dy) <= reach && std::fabs(dz) <= reach
                                  : dx * dx + dy * dy + dz * dz <= reach * reach;
          if (!meet || q.body == i) continue;
          const Range other = range_of(q.body);
          if (std::max(first[0], other.first[0]) == x && std::max(first[1], other.first[1]) == y &&
              std::max(first[2], other.first[2]) == z) {
            pairs.push_back({std::min(i, q.body), std::max(i, q.body)});
          }
        }
        entries_.push_back({p[0], p[1], p[2], r, i, bucket.entry});
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

double SpatialHash::best_cell_size(const std::vector<Vec3>& positions, const std::vector<double>& radii, double spacing,
                                   const Options& options) {
  double best = spacing, least = 1e300;
  std::vector<BodyPair> pairs;
  for (double size = 3; size < 2 * spacing + 3; size *= 1.4) {
    Options tried = options;
    tried.cell_size = size;
    SpatialHash hash(positions, radii, tried);
    double fastest = 1e300;
    for (int round = 0; round < 5; ++round) {
      pairs.clear();
      const auto begin = std::chrono::steady_clock::now();
      hash.find(pairs);
      fastest = std::min(fastest, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    if (fastest < least) least = fastest, best = size;
  }
  return best;
}

}  // namespace orchard::bench
