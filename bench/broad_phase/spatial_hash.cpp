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

template <bool Cubes>
void SpatialHash::find_all(std::vector<BodyPair>& pairs) {
  ++stamp_;
  entries_.clear();
  const auto cell = [&](double x) { return static_cast<std::uint32_t>(x * per_length_ + kMiddle); };
  for (BodyId i = 0; i < positions_.size(); ++i) {
    const Vec3& p = positions_[i];
    const double r = radii_[i];
    const std::uint32_t x0 = cell(p[0] - r), x1 = cell(p[0] + r), y0 = cell(p[1] - r), y1 = cell(p[1] + r),
                        z0 = cell(p[2] - r), z1 = cell(p[2] + r);
    for (std::uint32_t z = z0; z <= z1; ++z) {
      for (std::uint32_t y = y0; y <= y1; ++y) {
        for (std::uint32_t x = x0; x <= x1; ++x) {
          Bucket& bucket = buckets_[hash_of(x, y, z) & mask_];
          if (bucket.stamp != stamp_) bucket = {stamp_, kNone};
          for (std::uint32_t e = bucket.entry; e != kNone; e = entries_[e].next) {
            const BodyId j = entries_[e].body;
            const Vec3& q = positions_[j];
            const double reach = r + radii_[j];
            const double dx = q[0] - p[0], dy = q[1] - p[1], dz = q[2] - p[2];
            const bool meet = Cubes ? std::fabs(dx) <= reach && std::fabs(dy) <= reach && std::fabs(dz) <= reach
                                    : dx * dx + dy * dy + dz * dz <= reach * reach;
            if (!meet) continue;
            const double s = radii_[j];
            const bool here = std::max(x0, cell(q[0] - s)) == x && std::max(y0, cell(q[1] - s)) == y &&
                              std::max(z0, cell(q[2] - s)) == z;
            if (here && i != j) pairs.push_back({std::min(i, j), std::max(i, j)});
          }
          entries_.push_back({i, bucket.entry});
          bucket.entry = static_cast<std::uint32_t>(entries_.size() - 1);
        }
      }
    }
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
