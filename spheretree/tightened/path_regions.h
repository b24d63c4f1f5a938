#pragma once
#include <array>
#include <span>
#include <vector>

#include "coordinates.h"
#include "level_samples.h"

namespace orchard::detail {

// The path regions in which the balls of a level may lie, and the samples in each. A path region is the intersection of
// the balls on a path of the levels above. Path regions overlap, so a sample may lie in several. They are numbered in
// the order of the given paths, and samples in the order in which they were added. Samples are never removed.
class PathRegions {
 public:
  // paths[r] contains the balls from the root down, at least one, whose intersection is path region r. Samples in no
  // path region are left out.
  PathRegions(const Samples& samples, std::vector<std::vector<Sphere>> paths);

  Index size() const { return static_cast<Index>(paths_.size()); }
  const Samples& samples() const { return samples_; }
  const std::vector<Index>& samples_in(Index path_region) const { return samples_in_[path_region]; }  // ascending
  const Coordinates& places_in(Index path_region) const { return places_in_[path_region]; }           // their places
  const std::vector<Index>& regions_of(Index sample) const { return regions_of_[sample]; }            // ascending
  // Appends the samples of a path region with numbers of at least `first` and a squared distance from `center` of at
  // most squared_radius.
  void append_samples(Index path_region, Index first, const Point& center, double squared_radius,
                      std::vector<Index>& samples) const;
  bool holds(Index path_region, const Point& point) const;
  bool holds_sample(Index path_region, Index sample) const;
  std::vector<Index> regions_around(const Point& point) const;  // the regions that contain it, ascending

  // Adds a sample, which may lie in no path region.
  void add_sample(const Point& point, const Point& start);

 private:
  using Cell = std::array<Index, 3>;
  void make_grid();
  Cell cell_at(const Point& point) const;  // for a point outside the grid, the nearest cell
  Index place_of(const Cell& cell) const { return cell[0] + cells_[0] * (cell[1] + cells_[1] * cell[2]); }
  void append(const Point& point, const Point& start, std::vector<Index> regions);

  std::vector<std::vector<Sphere>> paths_;
  // A grid around the last balls of the paths, with the paths whose last ball meets each cell, ascending.
  Point corner_ = Point::Zero();
  double cell_side_ = 1;
  Cell cells_{1, 1, 1};
  std::vector<std::vector<Index>> near_;
  Samples samples_;
  std::vector<std::vector<Index>> samples_in_;  // by path region
  std::vector<Coordinates> places_in_;          // the places of these samples
  std::vector<std::vector<Index>> regions_of_;  // by sample
};

}  // namespace orchard::detail
