#pragma once
#include <array>
#include <span>
#include <vector>

#include "coordinates.h"
#include "level_samples.h"

namespace orchard::detail {

// The path regions that a level's balls may lie in, and the samples in each. A path region is the common part of the
// balls on a path of the levels above; path regions overlap, so a sample may lie in several. Path regions are numbered
// as the paths were given, samples in the order in which they came; samples are never taken out.
class PathRegions {
 public:
  // paths[r]: the balls from the root down, at least one, whose common part is path region r. Samples in no path region
  // are left out.
  PathRegions(const Samples& samples, std::vector<std::vector<Sphere>> paths);

  Index size() const { return static_cast<Index>(paths_.size()); }
  const Samples& samples() const { return samples_; }
  const std::vector<Index>& samples_in(Index path_region) const { return samples_in_[path_region]; }  // ascending
  const Coordinates& places_in(Index path_region) const { return places_in_[path_region]; }           // of these
  const std::vector<Index>& regions_of(Index sample) const { return regions_of_[sample]; }            // ascending
  // Appends those of the path region's samples, from number `first` on, whose squared distance from the center is at
  // most so much.
  void append_samples(Index path_region, Index first, const Point& center, double squared_radius,
                      std::vector<Index>& samples) const;
  bool holds(Index path_region, const Point& point) const;
  bool holds_sample(Index path_region, Index sample) const;
  std::vector<Index> regions_around(const Point& point) const;  // those that hold it, ascending

  // Also takes samples that lie in no path region.
  void add_sample(const Point& point, const Point& start);

 private:
  using Cell = std::array<Index, 3>;
  void make_grid();
  Cell cell_at(const Point& point) const;  // the nearest one of a point outside
  Index place_of(const Cell& cell) const { return cell[0] + cells_[0] * (cell[1] + cells_[1] * cell[2]); }
  void append(const Point& point, const Point& start, std::vector<Index> regions);

  std::vector<std::vector<Sphere>> paths_;
  // A grid around the last balls of the paths, and which of these meet each cell, ascending.
  Point corner_ = Point::Zero();
  double cell_side_ = 1;
  Cell cells_{1, 1, 1};
  std::vector<std::vector<Index>> near_;
  Samples samples_;
  std::vector<std::vector<Index>> samples_in_;  // each path region
  std::vector<Coordinates> places_in_;          // of these
  std::vector<std::vector<Index>> regions_of_;  // each sample
};

}  // namespace orchard::detail
