#include "disk_grid.h"  // private

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "orchard/geometry/random.h"
#include "support/effort.h"

namespace orchard {
namespace {

using detail::Disk;
using detail::DiskGrid;
using detail::Point2;

Disk random_disk(Random& random, double size) {
  Disk disk;
  disk.center = {random.uniform(-2, 3), random.uniform(-1, 1)};
  disk.radius = random.below(8) == 0 ? -1 : size * std::exp(random.uniform(-4, 1));
  return disk;
}

Eigen::AlignedBox2d rectangle(const Disk& disk, double room) {
  const Point2 half = Point2::Constant(disk.radius + room);
  return {disk.center - half, disk.center + half};
}

// Against all disks; boxes may be as thin as a line.
TEST(DiskGrid, NamesAscendingAllDisksThatMeetOneInTheBoxAndFewThatDoNot) {
  DiskGrid grid;
  std::size_t named = 0, met = 0;
  for (std::uint64_t k = 0; k < 100 * test::more(); ++k) {
    Random random(test::first_seed() + k, 51);
    std::vector<Disk> disks;
    const std::size_t count = random.below(300);
    for (std::size_t i = 0; i < count; ++i) disks.push_back(random_disk(random, random.below(4) == 0 ? 1 : 0.1));
    const double height = random.below(4) == 0 ? 0 : random.uniform();
    const Eigen::AlignedBox2d box(Point2(-1, -height), Point2(2, height));
    grid.build(disks, box);
    for (const Disk& disk : disks) {
      if (disk.radius <= 0) continue;
      std::vector<Index> near;
      grid.meeting(disk, near);
      EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
      named += near.size();
      for (Index i = 0; i < disks.size(); ++i) {
        const bool found = std::binary_search(near.begin(), near.end(), i);
        const auto meets = [&](double room) {
          return !rectangle(disk, room).intersection(rectangle(disks[i], room)).intersection(box).isEmpty();
        };
        const bool is_disk = disks[i].radius > 0;
        met += is_disk && meets(0);
        EXPECT_TRUE(found || !is_disk || !meets(0)) << "seed " << k;
        EXPECT_TRUE(!found || (is_disk && meets(1e-6))) << "seed " << k;
      }
    }
  }
  EXPECT_GT(met, 10'000u);
  EXPECT_LT(named, 2 * met);
}

TEST(DiskGrid, OfNoDisksNamesNone) {
  DiskGrid grid;
  grid.build({}, {Point2(0, 0), Point2(1, 1)});
  std::vector<Index> near{7};
  Disk disk;
  disk.radius = 5;
  grid.meeting(disk, near);
  EXPECT_TRUE(near.empty());
}

}  // namespace
}  // namespace orchard
