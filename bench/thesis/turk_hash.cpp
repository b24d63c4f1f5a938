#include "turk_hash.h"

#include <algorithm>

#include "spatial_hash.h"

namespace orchard::bench {

struct TurkHash::Data {
  std::vector<runtime::Vec3> positions;
  std::vector<double> radii;
  std::unique_ptr<SpatialHash> hash;
  std::vector<runtime::BodyPair> found;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
};

TurkHash::TurkHash(const std::vector<runtime::Vec3>& positions, const std::vector<double>& radii)
    : data_(std::make_unique<Data>()) {
  data_->positions = positions;
  data_->radii = radii;
  const double largest = *std::max_element(radii.begin(), radii.end());
  const double cell = SpatialHash::best_cell_size(data_->positions, data_->radii, 2 * largest, {1, 0, false});
  data_->hash = std::make_unique<SpatialHash>(data_->positions, data_->radii, SpatialHash::Options{cell, 0, false});
}

TurkHash::~TurkHash() = default;

const std::vector<std::pair<std::uint32_t, std::uint32_t>>& TurkHash::find(const std::vector<runtime::Vec3>& positions,
                                                                           const std::vector<double>& radii) {
  data_->positions = positions;
  data_->radii = radii;
  data_->found.clear();
  data_->pairs.clear();
  data_->hash->find(data_->found);
  // Two cells of a body may share a bucket, where a pair is found twice then.
  std::sort(data_->found.begin(), data_->found.end());
  data_->found.erase(std::unique(data_->found.begin(), data_->found.end()), data_->found.end());
  for (const runtime::BodyPair& pair : data_->found) data_->pairs.emplace_back(pair.a, pair.b);
  return data_->pairs;
}

}  // namespace orchard::bench
