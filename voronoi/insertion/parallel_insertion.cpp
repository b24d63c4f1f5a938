#include "insertion/parallel_insertion.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <numeric>
#include <thread>
#include <utility>

#include "workspace/large_pages.h"
#include "workspace/regions.h"

namespace orchard::detail {

void Inserter::enter(const Region& territory, std::span<const Index> starts) {
  territory_ = territory;
  cavity_.enter(territory);
  starts_ = starts;
  last_ = starts.front();
  blockers_.fill(kNone);
}

bool Inserter::insert_within(Index point) {
  const Point q = workspace_.points[point];
  if (is_blocked(q)) return false;
  last_ = walk(q);
  if (!territory_.owns(last_) && !(workspace_.power(last_, q) > 0)) {
    // The walk has run into a dead end of the territory. From another start there may be a way.
    last_ = nearest_start(q);
    last_ = walk(q);
  }
  if (!territory_.owns(last_)) return note_blocker(last_);
  cavity_.begin(point);
  return insert_directly(last_, q) || (cavity_.left_territory() && note_blocker(cavity_.blocker()));
}

bool Inserter::is_blocked(const Point& q) const {
  return std::any_of(blockers_.begin(), blockers_.end(),
                     [&](Index v) { return v != kNone && workspace_.power(v, q) > workspace_.power_bound(v); });
}

bool Inserter::note_blocker(Index v) {
  if (!territory_.owns(v)) blockers_[next_blocker_++ % blockers_.size()] = v;
  return false;
}

Index Inserter::nearest_start(const Point& q) const {
  Index nearest = last_;
  double min = std::numeric_limits<double>::infinity();
  for (const Index v : starts_) {
    if (workspace_.is_free(v)) continue;
    const double distance = (workspace_.points[workspace_.vertices[v].forming_points[0]] - q).squaredNorm();
    if (distance < min) min = distance, nearest = v;
  }
  return nearest;
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

std::atomic<std::size_t> large = 100000;

// Another pass is worth its time if at least large_set() / kWorthPass points are waiting, and at least one in
// kWorthPassOneIn of all points, since a pass looks at all vertices. Another cut of space is worth it if each half gets
// large_set() / kWorthHalving of the waiting points.
constexpr std::size_t kWorthPass = 24, kWorthHalving = 1, kWorthPassOneIn = 32;
constexpr int kPasses = 4;
constexpr double kMaxLeft = 0.75;          // of a pass's points: if more are left, cavities are too large for regions
constexpr double kRoomier = 1.03125;       // room for vertices, as a multiple of what the points are expected to need
constexpr std::size_t kRoom = 64;          // further vertices for each region
constexpr std::size_t kReport = 256;       // points of a region between two reports of progress
constexpr std::size_t kStarts = 64;        // vertices of a region that a walk may start from
constexpr std::size_t kSample = 1u << 17;  // vertices to choose the first cuts by
constexpr Index kGrain = 1u << 14;         // vertices that a thread looks at at once

class Pass {
 public:
  // `region_of`: the region of each vertex, as the last pass left it; empty for the first pass. `end`: all points
  // before it are inserted, except those in `waiting`.
  Pass(Workspace& workspace, std::vector<std::uint8_t>& region_of, std::span<const Index> waiting, Index end,
       const std::function<void(std::size_t)>& report)
      : workspace_(workspace),
        region_of_(region_of),
        regions_(workspace, waiting, vertices_near(), halvings(waiting)),
        parts_(regions_.count()),
        report_(report),
        inserted_(end - waiting.size()) {
    find_regions_of_points();
    for (const Index p : waiting) parts_[region_of_point_[p]].waiting.push_back(p);
    find_regions_of_vertices();
    give_room(end);
  }

  // Returns the points that could not be inserted, ascending.
  std::vector<Index> run(Inserter& inserter) {
    tbb::enumerable_thread_specific<Inserter> inserters(
        [this] { return Inserter(workspace_, Search::highest_first, 0); });
    tbb::parallel_for(std::size_t{0}, parts_.size(),
                      [&](std::size_t r) { insert(inserters.local(), static_cast<std::uint8_t>(r)); });
    for (const Inserter& each : inserters) inserter.add(each.counts());
    std::vector<Index> left;
    for (const Part& part : parts_) {
      left.insert(left.end(), part.left.begin(), part.left.end());
      workspace_.free_vertices.insert(workspace_.free_vertices.end(), part.room.begin(), part.room.end());
    }
    tbb::parallel_sort(left.begin(), left.end());
    return left;
  }

 private:
  struct Part {
    std::vector<Index> waiting, left;
    std::vector<Index> room;             // free vertices
    std::vector<Index> starts;           // some of its own
    std::atomic<std::size_t> taken = 0;  // number of vertices that the region owned when the pass began
  };

  static unsigned halvings(std::span<const Index> waiting) {
    unsigned count = 1;
    while (count < Regions::kMaxHalvings && waiting.size() >> (count + 1) >= large / kWorthHalving) ++count;
    return count;
  }

  // Vertices to choose the cuts by: for the first pass a sample of all; for later ones those that were mixed, because
  // the waiting points are near these.
  std::vector<Index> vertices_near() const {
    std::vector<Index> near;
    const std::size_t step = region_of_.empty() ? workspace_.vertices.size() / kSample + 1 : 1;
    for (std::size_t v = 0; v < workspace_.vertices.size(); v += step)
      if ((region_of_.empty() || region_of_[v] == Region::kMixed) && !workspace_.is_free(static_cast<Index>(v)))
        near.push_back(static_cast<Index>(v));
    return near;
  }

  void find_regions_of_points() {
    region_of_point_.resize(workspace_.points.size());
    tbb::parallel_for(tbb::blocked_range<Index>(0, static_cast<Index>(region_of_point_.size()), kGrain),
                      [&](const auto& range) {
                        for (Index p = range.begin(); p < range.end(); ++p)
                          region_of_point_[p] = regions_.of(workspace_.points[p]);
                      });
  }
  void find_regions_of_vertices() {
    region_of_.resize(workspace_.vertices.size());
    tbb::parallel_for(tbb::blocked_range<Index>(0, static_cast<Index>(region_of_.size()), kGrain),
                      [&](const auto& range) {
                        std::array<std::size_t, 256> taken{};
                        for (Index v = range.begin(); v < range.end(); ++v)
                          ++taken[region_of_[v] = region_of_vertex(v)];
                        for (std::size_t r = 0; r < parts_.size(); ++r) parts_[r].taken += taken[r];
                      });
  }
  // Has no branches that depend on regions: where regions meet, they could not be predicted.
  std::uint8_t region_of_vertex(Index v) const {
    const auto& corner = workspace_.vertices[v].forming_points;
    if (workspace_.is_free(v)) return Region::kMixed;
    const std::uint8_t* const of = region_of_point_.data();
    const unsigned a = of[corner[0]],
                   others[] = {of[corner[1]], of[corner[2]], of[corner[3] == kInfinitePoint ? corner[0] : corner[3]]};
    const bool mixed = ((a ^ others[0]) | (a ^ others[1]) | (a ^ others[2])) != 0;
    return static_cast<std::uint8_t>(a | (mixed ? unsigned{Region::kMixed} : 0u));
  }
  // Chooses starts evenly by number, since vertices with neighbouring numbers are mostly neighbours in space.
  void find_starts(std::uint8_t r) {
    const std::size_t count = region_of_.size(), step = count / (kStarts * parts_.size()) + 1;
    for (std::size_t v = 0; v < count; ++v) {
      const void* const next = std::memchr(region_of_.data() + v, r, count - v);
      if (next == nullptr) break;
      v = static_cast<std::size_t>(static_cast<const std::uint8_t*>(next) - region_of_.data());
      if (workspace_.is_free(static_cast<Index>(v))) continue;
      parts_[r].starts.push_back(static_cast<Index>(v));
      v += step;
    }
  }

  // Reserves vertices for each region: for each waiting point as many as the inserted points have taken, and more in
  // regions where these have taken more. Free vertices are used first.
  void give_room(Index end) {
    auto& free = workspace_.free_vertices;
    std::array<std::size_t, 256> inserted{};
    for (Index p = 0; p < end; ++p) ++inserted[region_of_point_[p]];
    std::size_t waiting = 0;
    for (const Part& part : parts_) waiting += part.waiting.size();
    const double of_all =
        static_cast<double>(workspace_.vertices.size() - free.size()) / static_cast<double>(end - waiting);
    // Mixed vertices belong to no region, so the vertices that regions own tell only the ratios between the regions.
    std::vector<double> shares(parts_.size());
    for (std::size_t r = 0; r < parts_.size(); ++r) {
      const auto points = static_cast<double>(parts_[r].waiting.size());
      shares[r] = points * static_cast<double>(parts_[r].taken) / (static_cast<double>(inserted[r]) - points + 1);
    }
    const double per_share = kRoomier * of_all * static_cast<double>(waiting) /
                             std::max(std::accumulate(shares.begin(), shares.end(), 0.0), 1.0);
    std::vector<std::size_t> wanted(parts_.size());
    for (std::size_t r = 0; r < parts_.size(); ++r) wanted[r] = static_cast<std::size_t>(per_share * shares[r]) + kRoom;
    workspace_.bring_in(workspace_.vertices.size() + std::accumulate(wanted.begin(), wanted.end(), std::size_t{0}) -
                        free.size());
    for (std::size_t r = 0; r < parts_.size(); ++r) {
      std::vector<Index>& room = parts_[r].room;
      const std::size_t recycled = std::min(wanted[r], free.size()), before = workspace_.vertices.size();
      room.assign(free.end() - static_cast<std::ptrdiff_t>(recycled), free.end());
      free.resize(free.size() - recycled);
      workspace_.resize(before + wanted[r] - recycled);
      for (std::size_t v = workspace_.vertices.size(); v-- > before;) room.push_back(static_cast<Index>(v));
      region_of_.resize(workspace_.vertices.size());
      for (const Index v : room) region_of_[v] = static_cast<std::uint8_t>(r);
    }
  }
  void insert(Inserter& inserter, std::uint8_t r) {
    Part& part = parts_[r];
    find_starts(r);
    if (part.starts.empty()) {
      part.left = std::move(part.waiting);
      return;
    }
    inserter.enter({region_of_.data(), r, &part.room}, part.starts);
    std::size_t fresh = 0;
    for (const Index p : part.waiting) {
      if (!inserter.insert_within(p))
        part.left.push_back(p);
      else if (++fresh == kReport)
        note(std::exchange(fresh, 0));
    }
    inserter.leave();
  }
  void note(std::size_t fresh) {
    const std::size_t inserted = inserted_ += fresh;
    if (std::this_thread::get_id() == caller_) report_(inserted);
  }

  Workspace& workspace_;
  std::vector<std::uint8_t>& region_of_;
  Regions regions_;
  std::vector<std::uint8_t> region_of_point_;
  std::vector<Part> parts_;
  const std::function<void(std::size_t)>& report_;
  const std::thread::id caller_ = std::this_thread::get_id();
  std::atomic<std::size_t> inserted_;
};

}  // namespace

std::size_t large_set() { return large; }

void use_large_set(std::size_t points) { large = points; }

void insert_in_regions(Workspace& workspace, Inserter& inserter, std::vector<Index>& waiting, Index end,
                       const std::function<void(std::size_t)>& report) {
  inserter.leave();
  std::vector<std::uint8_t> region_of;
  reserve_large(region_of, workspace.vertices.capacity());
  const std::size_t worth = std::max(large / kWorthPass, std::size_t{end} / kWorthPassOneIn);
  for (int pass = 0; pass < kPasses && waiting.size() >= worth; ++pass) {
    const auto before = static_cast<double>(waiting.size());
    waiting = Pass(workspace, region_of, waiting, end, report).run(inserter);
    if (static_cast<double>(waiting.size()) > kMaxLeft * before) break;
  }
  inserter.start_anywhere();
}

}  // namespace orchard::detail
