#include "parallel_insertion.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

#include "regions.h"

namespace orchard::detail {

void Inserter::enter(const Territory& territory, Index start) {
  territory_ = territory;
  cavity_.enter(territory);
  last_ = start;
}

bool Inserter::insert_within(Index point) {
  const Point q = workspace_.points[point];
  last_ = walk(q);
  if (!territory_.owns(last_)) return false;
  cavity_.begin(point);
  return insert_directly(last_, q);
}

void Inserter::leave() {
  cavity_.end();
  territory_ = {};
  cavity_.enter(territory_);
}

void Inserter::start_anywhere() {
  for (last_ = 0; workspace_.is_free(last_);) ++last_;
}

namespace {

std::atomic<std::size_t> large = 50000;

// Parts of a large set: as many points are worth another pass, and as many in each half another cut.
constexpr std::size_t kWorthPass = 12, kWorthHalving = 2;
constexpr int kPasses = 3;
constexpr std::size_t kRoom = 64;          // vertices beyond what the points of a region should need
constexpr std::size_t kSample = 1u << 17;  // vertices to choose the first cuts by
constexpr Index kGrain = 1u << 14;         // vertices that a thread looks at at once

class Pass {
 public:
  // `region_of`: by vertex, as the last pass left it; empty for the first. `end`: all points before it have been
  // inserted but for those that wait.
  Pass(Workspace& workspace, std::vector<std::uint8_t>& region_of, std::span<const Index> waiting, Index end)
      : workspace_(workspace), region_of_(region_of), regions_(workspace, waiting, vertices_near(), halvings(waiting)) {
    parts_.resize(regions_.count());
    for (const Index p : waiting) parts_[regions_.of(workspace_.points[p])].waiting.push_back(p);
    find_regions_of_vertices();
    for (std::uint8_t r = 0; r < regions_.count(); ++r) find_start(r);
    give_room(end - waiting.size());
  }

  // What could not be inserted, ascending.
  std::vector<Index> run(Inserter& inserter) {
    tbb::enumerable_thread_specific<Inserter> inserters([this] { return Inserter(workspace_, Search::highest_first); });
    tbb::parallel_for(std::size_t{0}, parts_.size(),
                      [&](std::size_t r) { insert(inserters.local(), static_cast<std::uint8_t>(r)); });
    for (const Inserter& each : inserters) inserter.add(each.counts());
    std::vector<Index> left;
    for (const Part& part : parts_) {
      left.insert(left.end(), part.left.begin(), part.left.end());
      workspace_.free_vertices.insert(workspace_.free_vertices.end(), part.room.begin(), part.room.end());
    }
    std::sort(left.begin(), left.end());
    return left;
  }

 private:
  struct Part {
    std::vector<Index> waiting, left;
    std::vector<Index> room;  // free vertices
    Index start = kNone;      // one of its vertices
  };

  static unsigned halvings(std::span<const Index> waiting) {
    unsigned count = 1;
    while (count < Regions::kMaxHalvings && waiting.size() >> (count + 1) >= large / kWorthHalving) ++count;
    return count;
  }

  // Some of all, before there were regions; later those that were mixed, where points wait now.
  std::vector<Index> vertices_near() const {
    std::vector<Index> near;
    const std::size_t step = region_of_.empty() ? workspace_.vertices.size() / kSample + 1 : 1;
    for (std::size_t v = 0; v < workspace_.vertices.size(); v += step)
      if (!workspace_.is_free(static_cast<Index>(v)) && (region_of_.empty() || region_of_[v] == Territory::kMixed))
        near.push_back(static_cast<Index>(v));
    return near;
  }

  void find_regions_of_vertices() {
    std::vector<std::uint8_t> of_point(workspace_.points.size());
    tbb::parallel_for(tbb::blocked_range<Index>(0, static_cast<Index>(of_point.size()), kGrain),
                      [&](const auto& range) {
                        for (Index p = range.begin(); p < range.end(); ++p)
                          of_point[p] = regions_.of(workspace_.points[p]);
                      });
    region_of_.resize(workspace_.vertices.size());
    tbb::parallel_for(tbb::blocked_range<Index>(0, static_cast<Index>(region_of_.size()), kGrain),
                      [&](const auto& range) {
                        for (Index v = range.begin(); v < range.end(); ++v) {
                          const auto& corner = workspace_.vertices[v].forming_points;
                          region_of_[v] = Territory::kMixed;
                          if (workspace_.is_free(v)) continue;
                          const std::uint8_t first = of_point[corner[0]];
                          if (of_point[corner[1]] == first && of_point[corner[2]] == first &&
                              (corner[3] == kInfinitePoint || of_point[corner[3]] == first))
                            region_of_[v] = first;
                        }
                      });
  }
  void find_start(std::uint8_t r) {
    const auto first = std::find(region_of_.begin(), region_of_.end(), r);
    if (first != region_of_.end()) parts_[r].start = static_cast<Index>(first - region_of_.begin());
  }

  // As many vertices for each point as the others have taken: free ones first.
  void give_room(std::size_t inserted) {
    auto& free = workspace_.free_vertices;
    const std::size_t taken = workspace_.vertices.size() - free.size();
    const double per_point = static_cast<double>(taken) / static_cast<double>(inserted);
    for (std::size_t r = 0; r < parts_.size(); ++r) {
      auto& [points, left, room, start] = parts_[r];
      const std::size_t wanted = static_cast<std::size_t>(per_point * static_cast<double>(points.size())) + kRoom;
      const std::size_t recycled = std::min(wanted, free.size()), before = workspace_.vertices.size();
      room.assign(free.end() - static_cast<std::ptrdiff_t>(recycled), free.end());
      free.resize(free.size() - recycled);
      workspace_.resize(before + wanted - recycled);
      for (std::size_t v = workspace_.vertices.size(); v-- > before;) room.push_back(static_cast<Index>(v));
      region_of_.resize(workspace_.vertices.size());
      for (const Index v : room) region_of_[v] = static_cast<std::uint8_t>(r);
    }
  }
  void insert(Inserter& inserter, std::uint8_t r) {
    Part& part = parts_[r];
    if (part.start == kNone) {
      part.left = std::move(part.waiting);
      return;
    }
    inserter.enter({region_of_.data(), r, &part.room}, part.start);
    for (const Index p : part.waiting)
      if (!inserter.insert_within(p)) part.left.push_back(p);
    inserter.leave();
  }

  Workspace& workspace_;
  std::vector<std::uint8_t>& region_of_;
  Regions regions_;
  std::vector<Part> parts_;
};

}  // namespace

std::size_t large_set() { return large; }

void use_large_set(std::size_t points) { large = points; }

void insert_in_regions(Workspace& workspace, Inserter& inserter, std::vector<Index>& waiting, Index end) {
  inserter.leave();
  std::vector<std::uint8_t> region_of;
  for (int pass = 0; pass < kPasses && waiting.size() >= large / kWorthPass; ++pass)
    waiting = Pass(workspace, region_of, waiting, end).run(inserter);
  inserter.start_anywhere();
}

}  // namespace orchard::detail
