#include "certificate/certificate.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "certificate/certifier.h"
#include "certificate/covers_once.h"
#include "certificate/suspects.h"
#include "insertion/parallel_insertion.h"
#include "orchard/geometry/tolerance.h"
#include "predicates/line_sum.h"

namespace orchard::detail {
namespace {

// If there are many points: the share of the intrusion that a point may use up on average. A straight line meets only a
// few of them.
constexpr double kMean = 1.0 / 512;

// If the bounds of all facets together are too large: the share that a single facet may take off, of what all of them
// may take off for each vertex.
constexpr double kShares = 64;

// The number of vertices that a thread examines at once. It is also worthwhile for sets that are too small for regions.
constexpr Index kBlock = 1u << 14, kHullBlock = 1u << 10;
constexpr std::size_t kWorthThreads = 2;

// Up to this number of points, all of them are in the cache.
constexpr std::size_t kCached = 1u << 13;

// rounds of repairing the diagram and examining the new vertices
constexpr int kRounds = 24;

// The number of times that the hull as a whole is examined, each time after its faulty parts have been rebuilt.
constexpr int kHullRounds = 4;

// The number of doubts, in all rounds together, up to which they count as local. If there are more, rebuilding is
// faster than repairing.
constexpr std::size_t kMaxDoubts = 16, kMaxDoubtsOneIn = 64;

// The number of facets that repairing may examine, for each point and in addition. If it needs more, rebuilding is
// faster.
constexpr std::size_t kMendingForEach = 4, kMending = 1u << 16;

void sort_unique(std::vector<Index>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}  // namespace

Certifier::Certifier(Workspace& workspace, FormingPoints& forming, Index first_new, Repairer* mender,
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

Certifier::Certifier(const Certifier& whole, Part)
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

Certificate Certifier::run(std::size_t points) {
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

// Examines everything that is new. Facets in doubt are repaired if there is a repairer.
bool Certifier::look_at_all() {
  found_.hull.clear();
  if (!look_at_each_oriented() || forming_.count() != points_ || !look_at_each_facet() || !look_at_edges(found_.hull))
    return false;
  return mend_doubts();
}

bool Certifier::mend_doubts() {
  std::size_t last = 0;
  std::stable_sort(found_.doubts.begin(), found_.doubts.end(),
                   [](const Doubt& a, const Doubt& b) { return a.vertex < b.vertex; });
  for (int round = 0; !found_.doubts.empty(); ++round) {
    doubtful_ += found_.doubts.size();
    // insertions alone do not repair it any further, and the parts were too large
    const bool is_stuck = round > 0 && !mender_->may_patch() && found_.doubts.size() >= last;
    if (is_stuck || round == kRounds || doubtful_ > kMaxDoubts + workspace_.vertices.size() / kMaxDoubtsOneIn)
      return false;
    const std::vector<Doubt> doubts = std::exchange(found_.doubts, {});
    last = doubts.size();
    if (!look_at_mended(mender_->mend(doubts, round)) ||
        mender_->work() > kMending + kMendingForEach * workspace_.points.size())
      return false;
  }
  return true;
}

bool Certifier::look_at_mended(const std::vector<Index>& changed) {
  mended_ = true;
  changed_.insert(changed_.end(), changed.begin(), changed.end());
  looks_at_changed_ = true;
  if (!look_at_changed(changed)) return false;
  looks_at_changed_ = false;
  return !found_.doubts.empty() || look_at_hull();
}

// Rebuilds the parts that the hull as a whole shows to be wrong, and repairs what is in doubt around them afterwards.
bool Certifier::patch(const std::vector<Index>& wrong) {
  if (mender_ == nullptr) return false;
  const std::vector<Index> changed = mender_->patch(wrong);
  return !changed.empty() && look_at_mended(changed) && mend_doubts();
}

bool Certifier::look_at_each_oriented() {
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

// Examines all facets except those of the hull.
bool Certifier::look_at_each_facet() {
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

// Examines the edges between the facets of these vertices at infinity (ascending) and of their neighbours, each once.
bool Certifier::look_at_edges(const std::vector<Index>& hull) {
  const auto count = static_cast<Index>(hull.size());
  return look_in_blocks((count + kCertificateBatch - 1) / kCertificateBatch, kHullBlock / kCertificateBatch,
                        [&](Certifier& part, Index batch) {
                          // The edges are listed first, so that the vertices across them are in the cache when they are
                          // needed.
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

// Calls good(part, i) for all i below the count, until it returns false; in several threads if there are many. The only
// thing that may change meanwhile is the vertex that is being examined.
template <class Good>
bool Certifier::look_in_blocks(Index count, Index block, const Good& good) {
  if (workspace_.points.size() < large_set() / kWorthThreads || first_new_ > 0) {
    for (Index i = 0; i < count; ++i)
      if (!good(*this, i)) return false;
    return found_.suspects.size() <= kMaxSuspects + kOfReflexEdge;
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
  return found_.good && found_.suspects.size() <= kMaxSuspects + kOfReflexEdge;
}

// Every vertex is examined twice at first, and some again later.
double Certifier::share_done(double looked_at) const {
  return std::min(looked_at / (2 * static_cast<double>(workspace_.vertices.size())), 1.0);
}

bool Certifier::look_at_changed(const std::vector<Index>& changed) {
  for (const auto good : {&Certifier::is_oriented, &Certifier::are_facets_good})
    for (const Index v : changed)
      if (!workspace_.is_free(v) && !(this->*good)(v)) return false;
  return true;
}

// Examines the edges of the hull after a repair: vertices around such an edge may have changed although the facets next
// to it have not.
bool Certifier::look_at_hull() {
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

void Certifier::forget_changed_suspects() {
  std::vector<Index>& suspects = found_.suspects;
  std::size_t count = 0;
  for (std::size_t i = 0; i < suspects.size(); i += kOfReflexEdge) {
    const auto edge = suspects.begin() + static_cast<std::ptrdiff_t>(i);
    const auto is_gone = [this](Index v) { return workspace_.is_free(v) || has_changed(v); };
    if (std::any_of(edge, edge + kOfReflexEdge, is_gone)) continue;
    std::copy_n(edge, kOfReflexEdge, suspects.begin() + static_cast<std::ptrdiff_t>(count));
    count += kOfReflexEdge;
  }
  suspects.resize(count);
}

// Returns the edges at which a facet, or the vertex below it, has changed, in the order in which all edges are
// examined.
std::vector<Certifier::HullEdge> Certifier::changed_edges() const {
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

// Examines the diagram once more, after bounds that are small enough for each facet have turned out too large for all
// of them together. It uses the own spheres of vertices where those of neighbours are too far off, exact signs where a
// facet takes off more than its share, and counts only what a single line can meet. Repaired vertices do not need a new
// point for that.
bool Certifier::look_closer() {
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

double Certifier::max_lost_on_line() const {
  LineSum losses(box_);
  const auto& points = workspace_.points;
  for (const auto& [intrusion, facet] : found_.losses)
    losses.add(intrusion, points[facet[0]], points[facet[1]], points[facet[2]]);
  return losses.max();
}

void Certifier::find_fattest() {
  found_.max_volume = 0;
  found_.fattest = kNone;
  look_in_blocks(static_cast<Index>(workspace_.vertices.size()), kBlock, [&](Certifier& part, Index v) {
    if (!workspace_.is_free(v) && !workspace_.at_infinity(v)) part.note_volume(v, six_volumes(v).value);
    return true;
  });
}

// Compares all points with the planes and spheres at edges of the hull that are so short, or facets that are so thin,
// that bounds from their surroundings say nothing when they are carried across the whole set. Returns those that are
// contradicted, each with a vertex of the point that contradicts it.
std::vector<Index> Certifier::guilty_suspects() {
  if (found_.suspects.empty()) return {};
  note_hull_points();
  const PointBlocks blocks(workspace_.points);
  std::vector<Index> suspects = found_.suspects;
  sort_unique(suspects);
  std::vector<Intruder> intruders(suspects.size());
  tbb::parallel_for(std::size_t{0}, intruders.size(), [&](std::size_t s) {
    const Index v = suspects[s];
    intruders[s] = workspace_.at_infinity(v) ? farthest_beyond(workspace_, v, hull_points_, diameter_)
                                             : blocks.deepest_within(workspace_, v, forming_, diameter_);
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

void Certifier::add_vertex_of_each(std::vector<Index>& points, std::vector<Index>& vertices) const {
  sort_unique(points);
  for (Index v = 0; v < workspace_.vertices.size() && !points.empty(); ++v)
    for (const Index point : workspace_.vertices[v].forming_points)
      if (std::erase(points, point) > 0) vertices.push_back(v);
}

void Certifier::note_hull_points() {
  hull_points_.clear();
  for (const Index v : hull_vertices()) {
    const auto& corner = workspace_.vertices[v].forming_points;
    hull_points_.insert(hull_points_.end(), corner.begin(), corner.begin() + 3);
  }
  sort_unique(hull_points_);
}

// Returns them in ascending order.
std::vector<Index> Certifier::hull_vertices() {
  if (first_new_ > 0) return all_hull_vertices();
  // the whole hull has been examined, and everything that is new since then
  if (!mended_) return found_.hull;
  std::vector<Index>& hull = found_.hull;
  std::erase_if(hull, [this](Index v) { return workspace_.is_free(v) || !workspace_.at_infinity(v); });
  const auto last_seen = std::is_sorted_until(hull.begin(), hull.end());
  std::sort(last_seen, hull.end());
  std::inplace_merge(hull.begin(), last_seen, hull.end());
  hull.erase(std::unique(hull.begin(), hull.end()), hull.end());
  return hull;
}

std::vector<Index> Certifier::all_hull_vertices() const {
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

std::size_t count_forming(const Workspace& workspace) {
  FormingPoints forming(workspace.points.size());
  const auto count = static_cast<Index>(workspace.vertices.size());
  tbb::parallel_for(tbb::blocked_range<Index>(0, count, kBlock), [&](const auto& range) {
    for (Index v = range.begin(); v < range.end(); ++v) forming.note(workspace.vertices[v]);
  });
  return forming.count();
}

Certificate certify(Workspace& workspace, std::size_t points, Index first_new, Repairer* mender,
                    const std::function<void(double)>& report) {
  FormingPoints forming(workspace.points.size());
  return Certifier(workspace, forming, first_new, mender, report).run(points);
}

}  // namespace orchard::detail
