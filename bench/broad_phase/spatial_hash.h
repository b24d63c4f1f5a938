#pragma once
#include "scene.h"

namespace orchard::bench {

// Turk's spatial hash, rebuilt at each step: every body enters the cells that its box overlaps and is compared with
// what is there. Cells are buckets of a table with a stamp, so that nothing is cleared, and are loaded a block of
// bodies ahead; an entry has its sphere with it, and its cell, as several cells share a bucket. A pair counts in the
// cell of the lower corner of what its boxes have in common, and once. Of spheres, or of isothetic cubes with the
// radius as half the edge (7.1).
class SpatialHash final : public Rival {
 public:
  struct Options {
    double cell_size;
    std::size_t table_bytes = 0;  // at most; 0: two buckets a body
    bool cubes = false;
  };
  SpatialHash(const std::vector<Vec3>& positions, const std::vector<double>& radii, const Options& options);

  void find(std::vector<BodyPair>& pairs) override;
  std::size_t memory_bytes() const override;

  // The fastest of a row of cell sizes, on the positions as they are.
  static double best_cell_size(const std::vector<Vec3>& positions, const std::vector<double>& radii, double spacing,
                               const Options& options);
  // The same by the sum over several states of a scene, from cells of half a mean radius up to three times the spacing
  // that their volume has room for.
  using State = std::vector<Vec3>;
  static double best_cell_size(const std::vector<State>& states, const std::vector<double>& radii);

 private:
  struct Bucket {
    std::uint32_t stamp, entry;
  };
  struct Entry {
    double x, y, z, radius;
    std::uint64_t cell;
    std::uint32_t body, next;
  };
  struct Range {
    std::array<std::uint32_t, 3> first, last;
  };
  Range range_of(BodyIndex body) const;
  template <bool Cubes>
  void enter(BodyIndex body, const Range& range, std::vector<BodyPair>& pairs);
  template <bool Cubes>
  void find_all(std::vector<BodyPair>& pairs);

  const std::vector<Vec3>& positions_;
  const std::vector<double>& radii_;
  const double per_length_;
  const bool cubes_;
  std::vector<Bucket> buckets_;
  std::vector<Entry> entries_;
  std::uint32_t stamp_ = 0, mask_;
};

}  // namespace orchard::bench
