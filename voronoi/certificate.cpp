// One proof, whose parts hand each other the intrusion that is left, hence more than 300 lines.
#include "certificate.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>

#include "cavity.h"
#include "certificate_four.h"
#include "covers_once.h"
#include "forming_points.h"
#include "four_tetrahedra.h"
#include "line_sum.h"
#include "orchard/geometry/tolerance.h"
#include "parallel_insertion.h"
#include "suspects.h"
#include "workspace_four.h"

namespace orchard::detail {
namespace {

// The part of the intrusion that a single facet may take up. What takes more is wrong, not rounded.
constexpr double kFacet = 1.0 / 64;

// The part of the intrusion that a point may take up in the mean, where there are many: a straight line meets few of
// them.
constexpr double kMean = 1.0 / 512;

// The part of the intrusion that may lie between the sphere that a vertex was given and its own.
constexpr double kGiven = 1.0 / 4;

// The part of the intrusion that may lie between a vertex's sphere and its own by the bound of its error; where that is
// more, its own is found.
constexpr double kTold = 1.0 / 64;

// Where the bound tells more than so many times that, a sphere is mostly off as far as the cheapest look can tell.
constexpr double kHopelesslyTold = 0x1p11;

// What a facet may take off, where the bounds are too much for all: of what all of them may, this part for each vertex.
constexpr double kShares = 64;

// Vertices that are held against all points one by one; where there are more, exact signs are cheaper.
constexpr std::size_t kMaxSuspects = 512, kOfDent = 4;

// Vertices that a thread looks at at once. That is worth while for sets that are too small for regions.
constexpr Index kBlock = 1u << 14, kHullBlock = 1u << 10;
constexpr std::size_t kWorthThreads = 2;

// Where there are no more points than that, they all are in the cache.
constexpr std::size_t kCached = 1u << 13;

// Of mending and looking at what is new.
constexpr int kRounds = 24;

// Times that the hull as a whole is looked at, each after what was wrong there has been made anew.
constexpr int kHullRounds = 4;

// How many doubts are still local ones, those of all rounds together: more are made anew sooner than mended.
constexpr std::size_t kMaxDoubts = 16, kMaxDoubtsOneIn = 64;

// Facets that mending may look at, for each point and beside those: what takes more is made anew sooner.
constexpr std::size_t kMendingForEach = 4, kMending = 1u << 16;

// The edge of the hull between the facets of a vertex at infinity and of its neighbour `slot`.
struct HullEdge {
  Index v, u;
  unsigned slot;
  friend bool operator==(const HullEdge&, const HullEdge&) = default;
  friend bool operator<(const HullEdge& a, const HullEdge& b) { return a.v != b.v ? a.v < b.v : a.slot < b.slot; }
};

void sort_unique(std::vector<Index>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

// What is seen of a finite vertex before anything follows from it: its orientation, and how far the sphere that it was
// given is from its own, at most, with its own centre, relative to its first point, where that had to be found.
struct Look {
  Determinant negative;  // of six times its volume, the other way around
  double apart = 0;
  bool has_center = false;
  Vector center;
};

// What the facet of three points takes off, where that is more than its share.
struct Loss {
  double intrusion;
  std::array<Index, 3> facet;
};

// What is found at some vertices, to be put together in their order, whichever thread looked at which.
struct Findings {
  bool good = true;
  double intrusion = 0, lost = 0, given = 0, max_volume = 0;
  Index fattest = kNone;
  std::vector<Loss> losses;
  std::vector<Index> suspects;
  std::vector<Index> hull;   // vertices at infinity
  std::vector<Index> lossy;  // that share a sphere farther from their own than a facet's share
  std::vector<Doubt> doubts;

  void add(const Findings& next) {
    good = good && next.good;
    intrusion += next.intrusion;
    lost += next.lost;
    given = std::max(given, next.given);
    if (next.max_volume > max_volume) max_volume = next.max_volume, fattest = next.fattest;
    losses.insert(losses.end(), next.losses.begin(), next.losses.end());
    suspects.insert(suspects.end(), next.suspects.begin(), next.suspects.end());
    hull.insert(hull.end(), next.hull.begin(), next.hull.end());
    lossy.insert(lossy.end(), next.lossy.begin(), next.lossy.end());
    doubts.insert(doubts.end(), next.doubts.begin(), next.doubts.end());
  }
};

class Certifier {
 public:
  Certifier(Workspace& workspace, FormingPoints& forming, Index first_new, Mender* mender,
            const std::function<void(double)>& report)
      : workspace_(workspace),
        forming_(forming),
        first_new_(first_new),
        mender_(workspace.exact() ? nullptr : mender),
        report_(report) {
    for (const Point& p : workspace.points) box_.extend(p);
    diameter_ = box_.diagonal().norm();
    max_ = tolerance::kVoronoiIntrusion * diameter_ / 2;
    const double count = static_cast<double>(workspace_.points.size());
    max_sum_ = (1 - kGiven) * max_ * std::max(1.0, kMean * count);
    share_ = kFacet * max_;
    small_share_ = max_sum_ / (kShares * static_cast<double>(workspace_.vertices.size() + 1));
  }

  // For a part of the vertices of the whole, found by a thread of its own.
  struct Part {};
  Certifier(const Certifier& whole, Part)
      : workspace_(whole.workspace_),
        forming_(whole.forming_),
        box_(whole.box_),
        first_new_(whole.first_new_),
        diameter_(whole.diameter_),
        max_(whole.max_),
        max_sum_(whole.max_sum_),
        share_(whole.share_),
        small_share_(whole.small_share_),
        mender_(whole.mender_),
        looks_at_changed_(whole.looks_at_changed_),
        report_(whole.report_) {}

  // `points`: how many form vertices if none was lost.
  Certificate run(std::size_t points) {
    points_ = points;
    if (!look_at_all()) return {};
    for (int round = 0; round < kHullRounds; ++round) {
      if (found_.intrusion > max_sum_ && (!look_closer() || found_.intrusion > max_sum_)) return {};
      if (mended_ && !is_tetrahedron(found_.fattest)) find_fattest();
      std::vector<Index> wrong;
      if (found_.fattest == kNone ? !found_.hull.empty()
                                  : !covers_once(workspace_, hull_vertices(), found_.fattest, box_)) {
        if (found_.fattest != kNone) wrong = facets_above(workspace_, hull_vertices(), found_.fattest);
        if (wrong.empty()) return {};
      } else {
        wrong = guilty_suspects();
        if (wrong.empty() && mended_ && !has_all_points()) break;
        if (wrong.empty()) return {true, 2 * (found_.intrusion + found_.given) / diameter_, found_.suspects.size()};
      }
      if (!patch(wrong)) return {};
    }
    return {};
  }

 private:
  const Point& corner(Index v, unsigned i) const { return workspace_.points[workspace_.vertices[v].forming_points[i]]; }
  unsigned slot_of(Index v, Index neighbor) const {
    return static_cast<unsigned>(index_of(workspace_.vertices[v].neighbors, neighbor));
  }

  bool is_tetrahedron(Index v) const { return v != kNone && !workspace_.is_free(v) && !workspace_.at_infinity(v); }
  bool is_new(Index v) const {
    const auto& p = workspace_.vertices[v].forming_points;
    const auto from = [this](Index point) { return point >= first_new_ && point != kInfinitePoint; };
    return first_new_ == 0 || from(p[0]) || from(p[1]) || from(p[2]) || from(p[3]);
  }

  // After mending: a lost point would lie in a sphere that no facet tells of.
  bool has_all_points() const { return count_forming(workspace_) == points_; }
  // All that is new; and where facets are in doubt, what they are mended by.
  bool look_at_all() {
    found_.hull.clear();
    if (!look_at_each_oriented() || forming_.count() != points_ || !look_at_each_facet() || !look_at_edges(found_.hull))
      return false;
    return mend_doubts();
  }
  bool mend_doubts() {
    std::stable_sort(found_.doubts.begin(), found_.doubts.end(),
                     [](const Doubt& a, const Doubt& b) { return a.vertex < b.vertex; });
    for (int round = 0; !found_.doubts.empty(); ++round) {
      doubtful_ += found_.doubts.size();
      if (round == kRounds || doubtful_ > kMaxDoubts + workspace_.vertices.size() / kMaxDoubtsOneIn) return false;
      const std::vector<Doubt> doubts = std::exchange(found_.doubts, {});
      if (!look_at_mended(mender_->mend(doubts, round)) ||
          mender_->work() > kMending + kMendingForEach * workspace_.points.size())
        return false;
    }
    return true;
  }
  bool look_at_mended(const std::vector<Index>& changed) {
    mended_ = true;
    changed_.insert(changed_.end(), changed.begin(), changed.end());
    looks_at_changed_ = true;
    if (!look_at_changed(changed)) return false;
    looks_at_changed_ = false;
    return !found_.doubts.empty() || look_at_hull();
  }
  // What the hull as a whole shows to be wrong, and what is in doubt around it then.
  bool patch(const std::vector<Index>& wrong) {
    if (mender_ == nullptr) return false;
    const std::vector<Index> changed = mender_->patch(wrong);
    return !changed.empty() && look_at_mended(changed) && mend_doubts();
  }
  bool look_at_each_oriented() {
    const auto count = static_cast<Index>(workspace_.vertices.size());
    return look_in_blocks((count + kCertificateBatch - 1) / kCertificateBatch, kBlock / kCertificateBatch,
                          [&](Certifier& part, Index batch) {
                            const Index begin = batch * kCertificateBatch,
                                        end = std::min(count, begin + kCertificateBatch);
                            if (workspace_.points.size() > kCached)
                              for (Index v = end; v < std::min(count, end + kCertificateBatch); ++v)
                                for (const Index point : workspace_.vertices[v].forming_points)
                                  __builtin_prefetch(workspace_.points.data() + point);
                            for (Index v = begin; v < end; ++v) forming_.note(workspace_.vertices[v]);
                            if (first_new_ == 0 && can_take_four()) return part.are_all_oriented(begin, end);
                            for (Index v = begin; v < end; ++v)
                              if (!workspace_.is_free(v) && is_new(v) && !part.is_oriented(v)) return false;
                            return true;
                          });
  }
  // Those of the hull aside.
  bool look_at_each_facet() {
    const auto count = static_cast<Index>(workspace_.vertices.size());
    return look_in_blocks(
        (count + kCertificateBatch - 1) / kCertificateBatch, kBlock / kCertificateBatch,
        [&](Certifier& part, Index batch) {
          const Index begin = batch * kCertificateBatch, end = std::min(count, begin + kCertificateBatch);
          if (first_new_ == 0) return part.are_all_facets_good(begin, end);
          for (Index v = begin; v < end; ++v)
            if (!workspace_.is_free(v) && is_new(v) && !workspace_.at_infinity(v) && !part.are_facets_good(v))
              return false;
          return true;
        });
  }
  // The edges between the facets of vertices at infinity, ascending, that are seen from there.
  bool look_at_edges(const std::vector<Index>& hull) {
    const auto count = static_cast<Index>(hull.size());
    return look_in_blocks((count + kCertificateBatch - 1) / kCertificateBatch, kHullBlock / kCertificateBatch,
                          [&](Certifier& part, Index batch) {
                            // Listed first, so that the vertices across are in the cache when they are asked for.
                            std::array<HullEdge, std::size_t{3} * kCertificateBatch> edges;
                            std::size_t listed = 0;
                            for (Index i = batch * kCertificateBatch;
                                 i < std::min(count, (batch + 1) * kCertificateBatch); ++i)
                              for (unsigned slot = 0; slot < 3; ++slot) {
                                const Index v = hull[i], u = workspace_.vertices[v].neighbors[slot];
                                __builtin_prefetch(workspace_.vertices.data() + u);
                                edges[listed] = {v, u, slot};
                                listed += (u > v) | !is_new(u);
                              }
                            return std::all_of(edges.begin(), edges.begin() + listed, [&part](const HullEdge& edge) {
                              return part.is_hull_convex(edge.v, edge.slot) || part.doubt(edge.v, edge.u);
                            });
                          });
  }
  // good(part, i) for all i below the count, until one is not; by several threads where there are many. Nothing changes
  // on the way but a vertex that is looked at itself.
  template <class Good>
  bool look_in_blocks(Index count, Index block, const Good& good) {
    if (workspace_.points.size() < large_set() / kWorthThreads || first_new_ > 0) {
      for (Index i = 0; i < count; ++i)
        if (!good(*this, i)) return false;
      return found_.suspects.size() <= kMaxSuspects + kOfDent;
    }
    std::vector<Findings> found((count + block - 1) / block);
    const std::thread::id caller = std::this_thread::get_id();
    tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t b) {
      if (report_ && std::this_thread::get_id() == caller) report_(share_done(static_cast<double>(looked_at_)));
      Certifier part(*this, Part{});
      const Index begin = static_cast<Index>(b) * block, end = std::min(count, begin + block);
      for (Index i = begin; i < end && part.found_.good; ++i) part.found_.good = good(part, i);
      found[b] = std::move(part.found_);
      looked_at_ += std::size_t{end - begin} * (kBlock / block);
    });
    for (const Findings& each : found) found_.add(each);
    return found_.good && found_.suspects.size() <= kMaxSuspects + kOfDent;
  }
  // Each of all vertices is looked at twice at first, and some again later.
  double share_done(double looked_at) const {
    return std::min(looked_at / (2 * static_cast<double>(workspace_.vertices.size())), 1.0);
  }
  bool look_at_changed(const std::vector<Index>& changed) {
    for (const auto good : {&Certifier::is_oriented, &Certifier::are_facets_good})
      for (const Index v : changed)
        if (!workspace_.is_free(v) && !(this->*good)(v)) return false;
    return true;
  }
  // After mending: what is around an edge of the hull may have changed, though the facets next to it have not.
  bool look_at_hull() {
    if (first_new_ > 0) {
      found_.suspects.clear();
      return look_at_edges(hull_vertices());
    }
    sort_unique(changed_);
    forget_changed_suspects();
    const std::vector<HullEdge> edges = changed_edges();
    changed_.clear();
    return std::all_of(edges.begin(), edges.end(), [this](const HullEdge& edge) {
      return is_hull_convex(edge.v, edge.slot) || doubt(edge.v, edge.u);
    });
  }
  bool has_changed(Index v) const { return std::binary_search(changed_.begin(), changed_.end(), v); }
  void forget_changed_suspects() {
    std::vector<Index>& suspects = found_.suspects;
    std::size_t count = 0;
    for (std::size_t i = 0; i < suspects.size(); i += kOfDent) {
      const auto dent = suspects.begin() + static_cast<std::ptrdiff_t>(i);
      const auto is_gone = [this](Index v) { return workspace_.is_free(v) || has_changed(v); };
      if (std::any_of(dent, dent + kOfDent, is_gone)) continue;
      std::copy_n(dent, kOfDent, suspects.begin() + static_cast<std::ptrdiff_t>(count));
      count += kOfDent;
    }
    suspects.resize(count);
  }
  // Those where one of the facets has changed, or the vertex below it, in the order in which all are looked at.
  std::vector<HullEdge> changed_edges() const {
    std::vector<Index> facets;
    for (const Index v : changed_) {
      if (workspace_.is_free(v)) continue;
      if (workspace_.at_infinity(v)) facets.push_back(v);
      for (const Index u : workspace_.vertices[v].neighbors)
        if (workspace_.at_infinity(u) && !workspace_.at_infinity(v)) facets.push_back(u);
    }
    std::vector<HullEdge> edges;
    for (const Index v : facets)
      for (unsigned slot = 0; slot < 3; ++slot) {
        const Index u = workspace_.vertices[v].neighbors[slot];
        edges.push_back(v < u ? HullEdge{v, u, slot} : HullEdge{u, v, slot_of(u, v)});
      }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
  }

  // Once more, where bounds that suffice for each facet are too much for all of them: with own spheres where those of
  // neighbours are far enough to count, with exact signs where a facet takes off more than its share, and only with
  // what one line can meet. What was mended need not have a new point.
  bool look_closer() {
    for (const Index v : found_.lossy)
      if (!workspace_.is_free(v) && !workspace_.at_infinity(v)) workspace_.place_sharply(v);
    if (mended_) first_new_ = 0;
    share_ = small_share_;
    found_.intrusion = 0;
    found_.suspects.clear();
    if (!look_at_all()) return false;
    found_.intrusion += std::min(found_.lost, max_lost_on_line());
    return true;
  }
  double max_lost_on_line() const {
    LineSum losses(box_);
    const auto& points = workspace_.points;
    for (const auto& [intrusion, facet] : found_.losses)
      losses.add(intrusion, points[facet[0]], points[facet[1]], points[facet[2]]);
    return losses.max();
  }
  void find_fattest() {
    found_.max_volume = 0;
    found_.fattest = kNone;
    look_in_blocks(static_cast<Index>(workspace_.vertices.size()), kBlock, [&](Certifier& part, Index v) {
      if (!workspace_.is_free(v) && !workspace_.at_infinity(v)) part.note_volume(v, six_volumes(v).value);
      return true;
    });
  }
  Determinant six_volumes(Index v) const {
    const Point& last = corner(v, 3);
    return volume(corner(v, 0) - last, corner(v, 1) - last, corner(v, 2) - last);
  }
  void note_volume(Index v, double negative) {
    if (-negative > found_.max_volume) found_.max_volume = -negative, found_.fattest = v;
  }
  bool doubt(Index v, Index u) {
    if (mender_) found_.doubts.push_back({v, u});
    return mender_ != nullptr;
  }

  // And whether the sphere that it was given is its own, nearly. What doubles could not place well is placed anew, and
  // so is what was given a neighbour's sphere and is too far from it.
  bool is_oriented(Index v) { return workspace_.at_infinity(v) ? is_hull_facet(v) : is_oriented(v, look(v)); }
  bool is_hull_facet(Index v) {
    found_.hull.push_back(v);
    return is_triangle(corner(v, 0), corner(v, 1), corner(v, 2));
  }
  Look look(Index v) {
    Look seen;
    seen.negative = six_volumes(v);
    if (seen.negative.sign() == Sign::positive) return seen;
    workspace_.settle(v);
    seen.apart = from_told_sphere(v);
    const double enough = kTold * max_;
    const bool can_be_seen = seen.negative.sign() == Sign::negative && !workspace_.shares_sphere(v);
    if (can_be_seen && seen.apart > enough && seen.apart <= kHopelesslyTold * enough)
      seen.apart = std::min(seen.apart, from_seen_sphere(v));
    if (can_be_seen && seen.apart > enough) seen.apart = std::min(seen.apart, from_moved_sphere(v));
    if (seen.apart > enough) seen.has_center = own_center(v, seen.center);
    return seen;
  }
  bool is_oriented(Index v, const Look& seen) {
    const Determinant& det = seen.negative;
    if (det.sign() == Sign::positive ||
        (det.sign() == Sign::uncertain &&
         volume_sign(corner(v, 3), corner(v, 0), corner(v, 1), corner(v, 2)) != Sign::negative))
      return false;
    note_volume(v, det.value);
    double apart = seen.apart;
    if (apart > kTold * max_) {
      if (!seen.has_center) return false;
      const Vector& center = seen.center;
      const bool shared = workspace_.shares_sphere(v);
      apart = from_sphere(v, center);
      if (apart > (shared ? kGiven : kTold) * max_) {
        workspace_.place_sharply(v, center);
        apart = 0;
      } else if (!shared) {
        workspace_.note_own_center(v, (corner(v, 0) + center - workspace_.vertices[v].center).norm());
      }
    }
    if (apart > small_share_ && workspace_.shares_sphere(v)) found_.lossy.push_back(v);
    found_.given = std::max(found_.given, apart);
    return apart <= kGiven * max_;
  }

  // The same of some vertices, where all are new, with the same bits. Each is a long chain of sums with branches as
  // good as random at its ends: so what has to be found is listed first, then found for four at once.
  bool are_all_oriented(Index begin, Index end) {
    BatchList list;
    for (Index v = begin; v < end; ++v) {
      const bool at_infinity = workspace_.at_infinity(v), is_free = workspace_.is_free(v);
      list.push_if(v, !is_free & !at_infinity);
      if (at_infinity && !is_free && !is_hull_facet(v)) return false;
    }
    for (const Index v : list.items()) workspace_.settle(v);
    BatchLooks seen;
    const double far = workspace_.exact() ? 0 : diameter_;
    list.for_each_four([&](std::size_t first, const std::array<Index, 4>& four) {
      take_volumes(four_volumes(tetrahedra(four)), first, seen);
      told_of_four(workspace_, four, far, &seen.radius[first], &seen.apart[first]);
    });
    see_four_spheres(list, seen);
    return are_listed_oriented(list, seen);
  }
  static void take_volumes(const FourVolumes& six, std::size_t first, BatchLooks& seen) {
    std::copy(six.value.begin(), six.value.end(), seen.negative.begin() + first);
    std::copy(six.bound.begin(), six.bound.end(), seen.negative_bound.begin() + first);
  }
  FourTetrahedra tetrahedra(const std::array<Index, 4>& four) const {
    FourTetrahedra corners;
    for (unsigned i = 0; i < 4; ++i)
      for (unsigned lane = 0; lane < 4; ++lane) corners[i][lane] = &corner(four[lane], i);
    return corners;
  }
  // As from_seen_sphere(), then from_moved_sphere().
  void see_four_spheres(const BatchList& list, BatchLooks& seen) {
    const double enough = kTold * max_;
    see_far(list, seen, kHopelesslyTold * enough,
            [&](const std::array<Index, 4>& v, const std::array<Index, 4>& at, const auto& centers) {
              const FourOffCenters off = off_four_circumcenters(centers, tetrahedra(v));
              note_four(v, at, apart_of_four(workspace_, v, off, diameter_), seen);
            });
    see_far(list, seen, std::numeric_limits<double>::infinity(),
            [&](const std::array<Index, 4>& v, const std::array<Index, 4>& at, const auto& centers) {
              const FourOffCenters off = sharply_off_four_circumcenters(centers, tetrahedra(v));
              if (note_four(v, at, apart_of_four(workspace_, v, off, diameter_), seen)) return;
              const FourMoved moved = moved_four(workspace_, v, off, diameter_);
              for (unsigned lane = 0; lane < 4; ++lane) {
                if (seen.apart[at[lane]] <= enough || !(moved.apart[lane] <= enough)) continue;
                workspace_.place_by_bound(v[lane], Point(moved.x[lane], moved.y[lane], moved.z[lane]),
                                          moved.squared_radius[lane], moved.power_bound[lane]);
                seen.apart[at[lane]] = moved.apart[lane];
              }
            });
  }
  // see(vertices, their places in the list, their centers) for four of those at once that are too far from their own
  // spheres as far as was seen, but no more than that far.
  template <class See>
  void see_far(const BatchList& list, const BatchLooks& seen, double hopeless, const See& see) {
    BatchList far;  // places in the list
    for (Index at = 0; at < list.items().size(); ++at) {
      const bool is_open = (seen.apart[at] > kTold * max_) & (seen.apart[at] <= hopeless),
                 is_positive = seen.negative[at] < -seen.negative_bound[at],
                 shares = workspace_.shares_sphere(list.items()[at]);
      far.push_if(at, is_open & is_positive & !shares);
    }
    far.for_each_four([&](std::size_t, const std::array<Index, 4>& four) {
      std::array<Index, 4> v;
      std::array<const Point*, 4> centers;
      for (unsigned lane = 0; lane < 4; ++lane) {
        v[lane] = list.items()[four[lane]];
        centers[lane] = &workspace_.vertices[v[lane]].center;
      }
      see(v, four, centers);
    });
  }
  // Whether all are near enough now.
  bool note_four(const std::array<Index, 4>& v, const std::array<Index, 4>& at, const FourSeen& found,
                 BatchLooks& seen) {
    bool all_near = true;
    for (unsigned lane = 0; lane < 4; ++lane) {
      const bool is_near = found.apart[lane] <= kTold * max_;
      if (is_near) workspace_.note_bound(v[lane], found.power_bound[lane]);
      seen.apart[at[lane]] = std::min(seen.apart[at[lane]], found.apart[lane]);
      all_near &= is_near;
    }
    return all_near;
  }
  bool are_listed_oriented(const BatchList& list, const BatchLooks& seen) {
    BatchList rest;  // places in the list
    double given = 0, max_volume = found_.max_volume;
    Index fattest = found_.fattest;
    for (Index at = 0; at < list.items().size(); ++at) {
      const bool is_positive = seen.negative[at] < -seen.negative_bound[at], is_near = seen.apart[at] <= kTold * max_;
      const bool good = is_positive & is_near, is_fatter = good & (-seen.negative[at] > max_volume);
      rest.push_if(at, !good);
      given = std::max(given, good ? seen.apart[at] : 0);
      max_volume = is_fatter ? -seen.negative[at] : max_volume;
      fattest = is_fatter ? list.items()[at] : fattest;
    }
    found_.given = std::max(found_.given, given);
    found_.max_volume = max_volume;
    found_.fattest = fattest;
    bool good = true;
    rest.for_each_four([&](std::size_t first, const std::array<Index, 4>& four) {
      std::array<Index, 4> v;
      for (unsigned lane = 0; lane < 4; ++lane) v[lane] = list.items()[four[lane]];
      std::array<Vector, 4> centers;
      const unsigned found = four_sharp_circumcenters(tetrahedra(v), centers);
      for (unsigned lane = 0; lane < std::min<std::size_t>(rest.items().size() - first, 4); ++lane) {
        Look look{
            {seen.negative[four[lane]], seen.negative_bound[four[lane]]}, seen.apart[four[lane]], true, centers[lane]};
        if (((found >> lane) & 1u) == 0) look.has_center = own_center(v[lane], look.center);
        good = good && is_oriented(v[lane], look);
      }
    });
    return good;
  }

  // Whether three points are not on one line.
  static bool is_triangle(const Point& a, const Point& b, const Point& c) {
    const Vector ab = b - a, ac = c - a;
    // Of a component's two products: two roundings in the factors of each, one in the product, one in the difference of
    // both; and as many for what is of second order.
    constexpr double kRoundings = 2 * 8 * kRounding;
    const double largest_product = ab.lpNorm<Eigen::Infinity>() * ac.lpNorm<Eigen::Infinity>();
    Vector normal;
    return ab.cross(ac).lpNorm<Eigen::Infinity>() > kRoundings * largest_product || sharp_normal(a, b, c, normal);
  }

  // How far the sphere that a vertex was given is from that of its forming points, at most, where points may be.
  double from_own_sphere(Index v) const {
    const double told = from_told_sphere(v);
    if (told <= kTold * max_) return told;
    Vector center;
    return own_center(v, center) ? from_sphere(v, center) : diameter_;
  }
  // The same as far as its error bound tells.
  double from_told_sphere(Index v) const { return from_told_sphere(v, std::sqrt(workspace_.vertices[v].radius)); }
  double from_told_sphere(Index v, double radius) const {
    if (workspace_.exact()) return 0;
    if (workspace_.shares_sphere(v)) return diameter_;
    return workspace_.power_bound(v) / radius;
  }
  // The same by how far its forming points are off its sphere: often a much better bound, which is noted then.
  double from_seen_sphere(Index v) {
    return note_off(
        v, off_circumcenter(workspace_.vertices[v].center, corner(v, 3), corner(v, 0), corner(v, 1), corner(v, 2)));
  }
  double note_off(Index v, const OffCenter& seen) {
    const double apart = apart_by(seen.off, std::sqrt(workspace_.vertices[v].radius));
    if (apart <= kTold * max_) workspace_.note_own_center(v, seen.off);
    return apart;
  }
  // The same with more digits, and where it is too far, after a step to its own sphere, if that is near enough.
  double from_moved_sphere(Index v) {
    const OffCenter seen =
        sharply_off_circumcenter(workspace_.vertices[v].center, corner(v, 3), corner(v, 0), corner(v, 1), corner(v, 2));
    const double before = note_off(v, seen);
    if (before <= kTold * max_) return before;
    const Point center = workspace_.vertices[v].center - seen.step;
    const double squared_radius = (center - corner(v, 0)).squaredNorm();
    const double rest = seen.rest + 2 * kRounding * center.lpNorm<1>();
    const double apart = apart_by(rest, std::sqrt(squared_radius));
    if (!(apart <= kTold * max_)) return before;
    workspace_.place_by_bound(v, center, squared_radius, Workspace::own_power_bound(center, squared_radius, rest));
    return apart;
  }
  // By how far the centre is off, at most: as in from_sphere(), the radius of the own sphere being three quarters of
  // this at least.
  double apart_by(double off, double radius) const {
    return off <= radius / 8 ? off * (4 * std::min(2.0, diameter_ / (0.75 * radius))) : diameter_;
  }
  bool own_center(Index v, Vector& center) const {
    return sharp_circumcenter(corner(v, 0), corner(v, 1), corner(v, 2), corner(v, 3), center);
  }
  double from_sphere(Index v, const Vector& center) const {
    // Both go through a point: at a distance d from it, powers differ by 2 d times the distance of the centres.
    const double apart = (corner(v, 0) + center - workspace_.vertices[v].center).norm(), radius = center.norm();
    return apart <= radius / 2 ? 4 * apart * std::min(2.0, diameter_ / radius) : diameter_;
  }

  bool are_facets_good(Index v) {
    for (unsigned i = 0; i < 4; ++i) {
      const Index u = workspace_.vertices[v].neighbors[i];
      if (u < v && is_new(u) && !looks_at_changed_) continue;                // seen from there
      if (workspace_.at_infinity(v) != workspace_.at_infinity(u)) continue;  // of the hull: its edges will be looked at
      if (!is_facet_good(v, i, u)) return false;
    }
    return true;
  }
  bool is_facet_good(Index v, unsigned i, Index u) {
    return (workspace_.at_infinity(v) ? is_hull_convex(v, i) : do_spheres_agree(v, i, u)) || doubt(v, u);
  }

  // The same facets of some vertices, those of the hull aside, where all are new. Waiting for memory and mispredicted
  // branches would be most of the time, so all facets are listed first, without branches. Across each, doubles mostly
  // show that the sphere there does not hold the vertex's own point, which spares looking for the one across.
  bool are_all_facets_good(Index begin, Index end) {
    std::size_t listed = 0, count = 0;
    std::array<Facet, std::size_t{4} * kCertificateBatch + 4> facets;
    for (Index v = begin; v < end; ++v)
      for (unsigned i = 0; i < 4; ++i) {
        const Index u = workspace_.vertices[v].neighbors[i];
        workspace_.prefetch(u);
        facets[listed] = {v, u, i, 0};
        listed += (u > v) & (u != kNone);
      }
    for (std::size_t f = 0; f < listed; ++f) {
      const auto [v, u, i, none] = facets[f];
      facets[count] = {v, u, i, workspace_.vertices[v].forming_points[i]};
      __builtin_prefetch(workspace_.points.data() + facets[count].opposite);
      count += std::size_t{!workspace_.at_infinity(v)} & std::size_t{!workspace_.at_infinity(u)};
    }
    for (std::size_t f = 0; f < count; f += 4) {
      const std::size_t lanes = std::min<std::size_t>(count - f, 4);
      std::fill(facets.begin() + f + lanes, facets.begin() + f + 4, facets[f]);
      unsigned doubtful = can_place_four() ? doubtful_of_four(workspace_, &facets[f]) : 0xf;
      doubtful &= (1u << lanes) - 1;
      std::array<double, 4> added;
      added.fill(std::numeric_limits<double>::infinity());
      if ((doubtful & (doubtful - 1)) != 0 && can_place_four() && !workspace_.exact()) added = added_across(&facets[f]);
      for (; doubtful != 0; doubtful &= doubtful - 1) {
        const auto lane = static_cast<unsigned>(std::countr_zero(doubtful));
        const auto [v, u, i, opposite] = facets[f + lane];
        if (are_own_spheres(v, u) && are_apart(v, i, u, corner(u, slot_of(u, v)))) continue;
        if (added[lane] <= share_ && !is_same_sphere(v, u)) {
          found_.intrusion += added[lane];
          continue;
        }
        if (!is_facet_good(v, i, u)) return false;
      }
    }
    return true;
  }
  // What is added across four facets.
  std::array<double, 4> added_across(const Facet* facets) {
    FourSteps steps;
    for (unsigned lane = 0; lane < 4; ++lane) {
      const auto& [v, u, i, opposite] = facets[lane];
      workspace_.settle(v);
      workspace_.settle(u);
      const auto& [a, b, c] = Cavity::kOthers[i];
      steps.from[lane] = &workspace_.vertices[v];
      steps.to[lane] = &workspace_.vertices[u];
      steps.from_corner[lane] = &corner(v, 0);
      steps.to_corner[lane] = &corner(u, 0);
      steps.a[lane] = &corner(v, a);
      steps.b[lane] = &corner(v, b);
      steps.c[lane] = &corner(v, c);
    }
    return added_by_four(steps, diameter_);
  }

  bool add(double intrusion) {
    if (!(intrusion <= kFacet * max_)) return false;
    found_.intrusion += intrusion;
    return true;
  }
  // What only lines through the facet of v that is opposite to its point i lose.
  void note_loss(double intrusion, Index v, unsigned i) {
    if (share_ > small_share_) {
      found_.intrusion += intrusion;
      return;
    }
    found_.lost += intrusion;
    const auto& [a, b, c] = Cavity::kOthers[i];
    const auto& corner = workspace_.vertices[v].forming_points;
    found_.losses.push_back({intrusion, {corner[a], corner[b], corner[c]}});
  }

  // Across the facet between v and its neighbour i, u.
  bool do_spheres_agree(Index v, unsigned i, Index u) {
    workspace_.settle(u);
    if (!workspace_.exact() && is_same_sphere(v, u)) return true;  // as on grids most are: nothing is lost
    const Point& across = corner(u, slot_of(u, v));
    const bool own = are_own_spheres(v, u);
    if (own && are_apart(v, i, u, across)) return true;
    double lost = 2 * diameter_;
    if (!workspace_.exact()) {
      const auto& [a, b, c] = Cavity::kOthers[i];
      Vector away;
      const double blur = normal(corner(v, a), corner(v, b), corner(v, c), away);
      lost = intrusion_added(v, u, corner(v, a), away, blur, Vector::Zero(), 0);
      if (lost <= share_ && add(lost)) return true;
    }
    if (inside_sphere(across, corner(v, 0), corner(v, 1), corner(v, 2), corner(v, 3)) != Sign::positive) {
      // In terms of the vertices' own spheres there is no doubt.
      lost = std::min(lost, own ? 0 : from_own_sphere(v) + from_own_sphere(u));
    } else if (!(lost <= kFacet * max_)) {
      return false;
    }
    note_loss(lost, v, i);
    return true;
  }

  bool are_own_spheres(Index v, Index u) const { return !workspace_.shares_sphere(v) && !workspace_.shares_sphere(u); }
  // Whether one of them certainly does not hold the point that the other has instead of a shared one.
  bool are_apart(Index v, unsigned i, Index u, const Point& across) const {
    return workspace_.power(v, across) < -workspace_.power_bound(v) ||
           workspace_.power(u, corner(v, i)) < -workspace_.power_bound(u);
  }

  bool is_same_sphere(Index v, Index u) const { return workspace_.vertices[v].center == workspace_.vertices[u].center; }

  // The unit normal of a facet, and by what angle it may be off.
  static double normal(const Point& a, const Point& b, const Point& c, Vector& result) {
    const Vector ab = b - a, ac = c - a;
    result = ab.cross(ac);
    const double blur = 8 * kRounding * ab.norm() * ac.norm() / result.norm();
    if (!(blur < kBlurred)) return sharp_normal(a, b, c, result) ? 8 * kRounding : 1;
    result.normalize();
    return blur;
  }

  // The power of q with respect to the sphere of v, through its first point, to some roundings of the sphere's radius
  // times the distance of points, however large the sphere is.
  double near_power(Index v, const Point& q) const {
    const Vector from_corner = q - corner(v, 0);
    return from_corner.dot(2 * (workspace_.vertices[v].center - corner(v, 0)) - from_corner);
  }

  // The intrusion that may be lost from v to u, for points beyond the plane through the origin, the normal, which may
  // be off by the angle `blur`, pointing to them, if u is on that side, or, if `up` is not zero, less than `height`
  // above the plane that it is normal to.
  double intrusion_added(Index v, Index u, const Point& origin, const Vector& normal, double blur, const Vector& up,
                         double height) const {
    const VoronoiVertex &from = workspace_.vertices[v], &to = workspace_.vertices[u];
    if (is_same_sphere(v, u)) return 0;
    const Vector step = to.center - from.center;
    const double radius = std::sqrt(from.radius), reach = std::min(2 * radius, diameter_);
    const double along = normal.dot(step), above = up.dot(step), length = step.norm();
    const double sideways = (step - along * normal - above * up).norm() + (2 * blur + 8 * kRounding) * length;
    const double lost = near_power(v, origin) - near_power(u, origin) +
                        16 * kRounding * (radius + std::sqrt(to.radius) + diameter_) * diameter_;
    return (std::max(lost, 0.0) + 2 * reach * (std::max(-along, 0.0) + sideways) + 2 * std::abs(above) * height) /
           radius;
  }

  // At the edge of the hull between the facets of v and its neighbour i: this one's third point must be below the facet
  // of v, or, by a rounding, not, but opposite to it.
  bool is_hull_convex(Index v, unsigned i) {
    const Point &b = corner(v, (i + 1) % 3), &c = corner(v, (i + 2) % 3);
    const Index u = workspace_.vertices[v].neighbors[i];
    const Point& p = corner(u, slot_of(u, v));
    const Sign below = volume_sign(p, corner(v, 0), corner(v, 1), corner(v, 2));
    if (below == Sign::positive) return true;
    if (same_side_of_line(b, c, corner(v, i), p) != Sign::negative) return false;
    return below == Sign::uncertain || (!workspace_.exact() && is_dent_shallow(v, i, p, b, c));
  }

  // Where p is above the facet of v, beyond the edge from b to c: the hull's other points may be above the facet by as
  // much at the same angle. In the dent, the spheres below the two facets meet in the edge.
  bool is_dent_shallow(Index v, unsigned i, const Point& p, const Point& b, const Point& c) {
    Vector normal;
    if (!sharp_normal(corner(v, 0), corner(v, 1), corner(v, 2), normal)) return false;
    const Vector along = (c - b).normalized(), from_edge = (p - b) - along.dot(p - b) * along;
    const double rise = diameter_ * std::abs(normal.dot(from_edge)) / from_edge.norm();
    Vector away = normal.cross(along);
    if (away.dot(corner(v, i) - b) > 0) away = -away;
    const Index u = workspace_.vertices[v].neighbors[i];
    const Index below = workspace_.vertices[v].neighbors[3], next = workspace_.vertices[u].neighbors[3];
    if (!add(rise + intrusion_added(below, next, b, away, 16 * kRounding, normal, rise)))
      found_.suspects.insert(found_.suspects.end(), {v, u, below, next});  // kOfDent
    return found_.suspects.size() <= kMaxSuspects;
  }

  // All points, against the planes and the spheres at edges of the hull so short or facets so thin that bounds from
  // next to them, carried across the whole set, say nothing.
  // Those that are not innocent, with a vertex of the point that shows it for each.
  std::vector<Index> guilty_suspects() {
    if (found_.suspects.empty()) return {};
    note_hull_points();
    std::vector<Index> suspects = found_.suspects;
    sort_unique(suspects);
    std::vector<Intruder> intruders(suspects.size());
    tbb::parallel_for(std::size_t{0}, intruders.size(), [&](std::size_t s) {
      const Index v = suspects[s];
      intruders[s] = workspace_.at_infinity(v) ? farthest_beyond(workspace_, v, hull_points_, diameter_)
                                               : deepest_within(workspace_, v, forming_, diameter_);
    });
    std::vector<Index> guilty, points;
    for (std::size_t s = 0; s < suspects.size(); ++s) {
      if (add(intruders[s].depth)) continue;
      guilty.push_back(suspects[s]);
      if (intruders[s].point != kNone) points.push_back(intruders[s].point);
    }
    add_vertex_of_each(points, guilty);
    return guilty;
  }
  void add_vertex_of_each(std::vector<Index>& points, std::vector<Index>& vertices) const {
    sort_unique(points);
    for (Index v = 0; v < workspace_.vertices.size() && !points.empty(); ++v)
      for (const Index point : workspace_.vertices[v].forming_points)
        if (std::erase(points, point) > 0) vertices.push_back(v);
  }
  void note_hull_points() {
    hull_points_.clear();
    for (const Index v : hull_vertices()) {
      const auto& corner = workspace_.vertices[v].forming_points;
      hull_points_.insert(hull_points_.end(), corner.begin(), corner.begin() + 3);
    }
    sort_unique(hull_points_);
  }
  // Ascending.
  std::vector<Index> hull_vertices() {
    if (first_new_ > 0) return all_hull_vertices();
    // All of the hull has been looked at, and what was new since.
    if (!mended_) return found_.hull;
    std::vector<Index>& hull = found_.hull;
    std::erase_if(hull, [this](Index v) { return workspace_.is_free(v) || !workspace_.at_infinity(v); });
    const auto last_seen = std::is_sorted_until(hull.begin(), hull.end());
    std::sort(last_seen, hull.end());
    std::inplace_merge(hull.begin(), last_seen, hull.end());
    hull.erase(std::unique(hull.begin(), hull.end()), hull.end());
    return hull;
  }
  std::vector<Index> all_hull_vertices() const {
    const auto count = static_cast<Index>(workspace_.vertices.size());
    std::vector<std::vector<Index>> blocks((count + kBlock - 1) / kBlock);
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
      const Index begin = static_cast<Index>(b) * kBlock, end = std::min(count, begin + kBlock);
      for (Index v = begin; v < end; ++v)
        if (!workspace_.is_free(v) && workspace_.at_infinity(v)) blocks[b].push_back(v);
    });
    std::vector<Index> hull;
    for (const auto& block : blocks) hull.insert(hull.end(), block.begin(), block.end());
    return hull;
  }
  Workspace& workspace_;
  FormingPoints& forming_;
  Box box_;
  Index first_new_;
  double diameter_ = 0, max_ = 0, max_sum_ = 0, share_ = 0, small_share_ = 0;
  Findings found_;
  std::size_t points_ = 0;
  std::vector<Index> hull_points_;
  std::vector<Index> changed_;  // by mending, since the hull was looked at
  Mender* mender_;
  std::size_t doubtful_ = 0;
  bool looks_at_changed_ = false, mended_ = false;
  const std::function<void(double)>& report_;
  std::atomic<std::size_t> looked_at_ = 0;
};

}  // namespace

std::size_t count_forming(const Workspace& workspace) {
  FormingPoints forming(workspace.points.size());
  const auto count = static_cast<Index>(workspace.vertices.size());
  tbb::parallel_for(tbb::blocked_range<Index>(0, count, kBlock), [&](const auto& range) {
    for (Index v = range.begin(); v < range.end(); ++v) forming.note(workspace.vertices[v]);
  });
  return forming.count();
}

Certificate certify(Workspace& workspace, std::size_t points, Index first_new, Mender* mender,
                    const std::function<void(double)>& report) {
  FormingPoints forming(workspace.points.size());
  return Certifier(workspace, forming, first_new, mender, report).run(points);
}

}  // namespace orchard::detail
