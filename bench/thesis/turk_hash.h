#pragma once
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "orchard/runtime/pose.h"

namespace orchard::bench {

// Turk's spatial hash (bench/broad_phase/spatial_hash.h) for bodies that come and go: apart from those of the narrow
// phase, whose rivals are of another class with the same name.
class TurkHash {
 public:
  TurkHash(const std::vector<runtime::Vec3>& positions, const std::vector<double>& radii);
  ~TurkHash();

  // Which spheres overlap, by their places in the arrays, which have as many entries as before.
  const std::vector<std::pair<std::uint32_t, std::uint32_t>>& find(const std::vector<runtime::Vec3>& positions,
                                                                   const std::vector<double>& radii);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace orchard::bench
