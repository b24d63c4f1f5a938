#include "algorithms/build.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "certificate/certificate.h"
#include "insertion/parallel_insertion.h"
#include "insertion/patch.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/tolerance.h"
#include "predicates/frame.h"
#include "predicates/spanning_points.h"
#include "workspace/coincident.h"
#include "workspace/insertion_order.h"
#include "workspace/large_pages.h"

namespace orchard::detail {
namespace {

constexpr Index kSlice = 1u << 14;  // points or vertices that a thread looks at at once
constexpr double kInsertion = 0.8;  // its part of the time; the rest is the certificate's

// Sets of at least kTried points are tried on a random sample first: the first one in kTriedOneIn in insertion order.
constexpr std::size_t kTried = 1u << 12, kTriedOneIn = 8;

// If at least this part of the inserted points lie on spheres of others, the set is a lattice or the like. Exact signs
// would take several times as long there, and rounding errors can be mended afterwards.
constexpr double kLattice = 0.25;

// The certificate may have to compare one vertex (a suspect) with all points for every so many points of the sample.
// More suspects are allowed if no insertion was in doubt (the first number).
constexpr std::size_t kSuspectsOneIn = 1u << 7, kSuspectsOneInDoubts = 1u << 12;

}  // namespace

Box checked_box(std::span<const Point> points) {
  Box box;
  for (Index i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite())
      throw InputError("point " + std::to_string(i) + " has a coordinate that is not a finite number: remove it");
    if (points[i].cwiseAbs().maxCoeff() > Frame::kMax)
      throw InputError("point " + std::to_string(i) + " has a coordinate beyond 1e100: scale the points down");
    box.extend(points[i]);
  }
  const double extent = box.isEmpty() ? 0 : box.sizes().maxCoeff();
  if (extent > 0 && extent < Frame::kMin) throw InputError("the points are less than 1e-100 apart: scale them up");
  return box;
}

void set_scale(Workspace& workspace, const Frame& frame, const Box& box) {
  workspace.set_scale(Box(frame.inward(box.min()), frame.inward(box.max())), frame.rounding());
}

void finish(Workspace& workspace, const Frame& frame, std::span<const Index> original_of) {
  auto& vertices = workspace.vertices;
  std::vector<Index>& free = workspace.free_vertices;
  std::sort(free.begin(), free.end());
  Index end = static_cast<Index>(vertices.size());
  for (std::size_t f = 0; f < free.size() && free[f] < end; ++f) {
    while (end > free[f] && workspace.is_free(end - 1)) --end;
    if (free[f] >= end) break;
    const Index from = --end, to = free[f];
    vertices[to] = vertices[from];
    for (const Index neighbor : vertices[to].neighbors)
      for (Index& back : vertices[neighbor].neighbors)
        if (back == from) back = to;
  }
  free.clear();
  vertices.resize(end);
  tbb::parallel_for(tbb::blocked_range<Index>(0, end, kSlice), [&](const auto& range) {
    for (Index v = range.begin(); v < range.end(); ++v) {
      VoronoiVertex& vertex = vertices[v];
      if (vertex.forming_points[3] == kInfinitePoint) {
        vertex.radius = std::numeric_limits<double>::infinity();
      } else {
        vertex.center = frame.outward(vertex.center);
        vertex.radius = frame.outward(std::sqrt(vertex.radius));
      }
      if (original_of.empty()) continue;
      for (Index& point : vertex.forming_points)
        if (point != kInfinitePoint) point = original_of[point];
    }
  });
}

void add_counts(const InsertionCounts& counts, InsertionReport& report) {
  report.certified_insertions += counts.certified;
  report.settled_insertions += counts.settled;
  report.exact_insertions += counts.exact;
  report.constrained_insertions += counts.constrained;
  report.coplanar_centers += counts.coplanar;
}

namespace {

enum class Outcome { done, flat, failed };

// Reserves memory for the vertices. Reserved memory that is not used costs nothing, since it is never touched; but
// moving the vertices to a larger block does, because they are in memory twice meanwhile. Moving up to half of them
// does not raise the peak. The first 64th, eighth and half of the points are random samples of all, from which the
// final number of vertices is extrapolated: when the points double, the vertices double (or a little more) if the
// points lie on surfaces, and grow up to fourfold if they lie on curves.
class Room {
 public:
  explicit Room(Workspace& workspace) : workspace_(workspace) {}

  // To be called before each insertion with the number of points so far.
  void make(std::size_t inserted) {
    const std::size_t count = workspace_.points.size();
    if (inserted == 0) workspace_.reserve(2 * count + 64, count * 5 / 8);
    if (inserted == count / 64) sample_ = vertices();
    if (inserted == count / 8) {
      const double expected = vertices() * growth(8);
      workspace_.reserve(std::max(8 * count, static_cast<std::size_t>(1.375 * expected)) + 64,
                         static_cast<std::size_t>(expected));
      sample_ = vertices();
    }
    if (inserted == count / 2) {
      const double expected = vertices() * std::sqrt(growth(4));
      if (1.05 * expected > static_cast<double>(workspace_.vertices.capacity()))
        workspace_.reserve(static_cast<std::size_t>(1.25 * expected), static_cast<std::size_t>(expected));
    }
  }

 private:
  double vertices() const { return static_cast<double>(workspace_.vertices.size()); }
  // By what factor the vertices have grown since the last sample, while the points grew by the factor `times`.
  double growth(double times) const {
    return sample_ > 0 ? std::clamp(vertices() / sample_, times, times * times) : times;
  }

  Workspace& workspace_;
  double sample_ = 0;  // vertices, or 0 if there was none
};

// The end of the stage of insertion that starts at point `begin`. The last rounds of insertion_order(), if they are
// large, are stages of their own, which many threads insert after all points before them. The first stage is at most
// the sample that is tried.
Index end_of_stage(std::size_t begin, std::size_t count, std::size_t sample) {
  std::size_t end = begin < sample ? sample : count;
  if (count >= large_set())
    while (end / 8 > begin && end >= large_set() / 4) end /= 8;
  return static_cast<Index>(end);
}

bool is_lattice(const InsertionCounts& counts) {
  return static_cast<double>(counts.settled) >= kLattice * static_cast<double>(counts.inserted());
}

// Whether the insertions so far left doubts that the signs of doubles cannot settle, so that more are likely to come.
bool has_doubts(const Inserter& inserter) {
  return (inserter.counts().constrained > 0 || inserter.has_deferred()) && !is_lattice(inserter.counts());
}

// Whether the signs of doubles will do for a set of which a sample has been inserted. If many points lie on planes that
// are not parallel to the axes, as in dense samples of flat or cylindrical faces, rounding errors are too many to be
// mended one by one. Finding that out at the end takes as long as exact signs from the start, hardly slower there.
bool doubles_will_do(Workspace& workspace, const Inserter& inserter) {
  const InsertionCounts& counts = inserter.counts();
  if (has_doubts(inserter)) return false;
  if (is_lattice(counts)) return true;
  constexpr std::size_t kFirst = 4;  // that the inserter started with
  const Certificate certificate = certify(workspace, counts.inserted() + kFirst);
  const std::size_t one_in = counts.certified == counts.inserted() ? kSuspectsOneIn : kSuspectsOneInDoubts;
  return certificate.holds && certificate.suspects * one_in <= counts.inserted();
}

// Inserts all points of the workspace in order. If an insertion fails, `at` is the point and `reason` is why.
Outcome insert_all(Workspace& workspace, Search search, std::string_view stage, const Progress& progress,
                   InsertionCounts& counts, Index& at, const char*& reason) {
  workspace.clear();
  Room room(workspace);
  room.make(0);
  Inserter inserter(workspace, search, workspace.points.size());
  const std::array<Index, 4> first = spanning_points(workspace.points);
  if (!inserter.start(first)) return Outcome::flat;
  if (workspace.exact()) workspace.forget_noise();
  const std::size_t count = workspace.points.size(), step = std::max<std::size_t>(count / 64, 1);
  const auto report = [&](std::size_t inserted) {
    report_progress(progress, stage, kInsertion * static_cast<double>(inserted) / static_cast<double>(count));
  };
  const bool highest_first = search == Search::highest_first, is_tried = highest_first && !workspace.exact();
  const std::size_t sample = is_tried && count >= kTried ? count / kTriedOneIn : 0;
  std::vector<Index> stage_points;
  for (Index begin = 0, end = 0; begin < count; begin = end) {
    if (begin > 0 && begin == sample && !doubles_will_do(workspace, inserter)) return Outcome::failed;
    end = highest_first ? end_of_stage(begin, count, sample) : static_cast<Index>(count);
    stage_points.clear();
    for (Index i = begin; i < end; ++i)
      if (std::find(first.begin(), first.end(), i) == first.end()) stage_points.push_back(i);
    const bool in_regions = begin > 0 && count >= large_set();
    if (in_regions) {
      room.make(begin);
      insert_in_regions(workspace, inserter, stage_points, end, report);
    }
    std::size_t inserted = end - stage_points.size();
    for (const Index i : stage_points) {
      if (!in_regions) room.make(i);
      if (++inserted % step == 0) {
        report(inserted);
        if (inserted > sample / 2 && begin < sample && has_doubts(inserter)) return Outcome::failed;
      }
      if (inserter.insert(i)) continue;
      at = i;
      reason = inserter.failure();
      return Outcome::failed;
    }
  }
  Patch patch(workspace);
  if (!inserter.insert_deferred(workspace.exact() ? nullptr : &patch)) return Outcome::failed;
  counts = inserter.counts();
  if (workspace.exact()) counts.coplanar += workspace.place_thin_vertices();
  return Outcome::done;
}

// Inserts all points. If that fails with the signs of doubles (in the trial of a sample, at a point or because the
// result has no certificate), starts again with exact signs. Returns false if the points are flat.
bool insert_with_all_means(Workspace& workspace, Search search, std::string_view stage, const Progress& progress,
                           std::span<const Index> original_of, InsertionReport& report) {
  InsertionCounts counts;
  Index at = 0;
  const char* reason = "";
  Certificate certificate;
  const auto attempt = [&] {
    const Outcome outcome = insert_all(workspace, search, stage, progress, counts, at, reason);
    if (outcome != Outcome::done || search != Search::highest_first) return outcome;
    Repairer mender(workspace);
    certificate = certify(workspace, workspace.points.size(), 0, &mender,
                          [&](double part) { report_progress(progress, stage, kInsertion + (1 - kInsertion) * part); });
    return certificate.holds ? Outcome::done : Outcome::failed;
  };
  Outcome outcome = attempt();
  if (outcome == Outcome::failed && search == Search::bowyer)
    throw Error("Bowyer's algorithm fails at point " + std::to_string(original_of[at]) + ", after " +
                std::to_string(at) + " of " + std::to_string(original_of.size()) + " points: " + reason);
  if (outcome == Outcome::failed && !workspace.exact()) {
    workspace.set_exact(true);
    outcome = attempt();
  }
  if (outcome == Outcome::failed) throw Error("internal: a Voronoi diagram made with exact signs is not exact");
  report_progress(progress, stage, 1);
  add_counts(counts, report);
  report.exact_signs = workspace.exact();
  report.certified_intrusion = certificate.intrusion;
  return outcome == Outcome::done;
}

}  // namespace

VoronoiBuild build_voronoi(std::span<const Point> points, Search search, std::string_view stage,
                           const Progress& progress, bool exact) {
  VoronoiBuild build;
  auto& [diagram, report] = build;
  const Box box = checked_box(points);
  const Frame frame(box);
  const double radius = points.empty() ? 0 : box.diagonal().norm() / 2;
  std::vector<Index> original_of;
  tbb::parallel_invoke(
      [&] { build.report.duplicates = coincident_points(points, tolerance::kCoincidentPoints * radius); },
      [&] { original_of = insertion_order(points, box); });

  if (points.size() - report.duplicates.size() >= 4) {
    // The points are stored in the order of insertion, so that neighbours in space are neighbours in memory.
    if (!report.duplicates.empty()) {
      std::vector<bool> left_out(points.size(), false);
      for (const auto& pair : report.duplicates) left_out[pair[0]] = true;
      std::erase_if(original_of, [&](Index i) { return left_out[i]; });
    }
    Workspace workspace;
    set_scale(workspace, frame, box);
    workspace.set_exact(exact || (search == Search::highest_first && workspace.too_noisy()));
    reserve_large(workspace.points, original_of.size());
    workspace.points.resize(original_of.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, original_of.size(), kSlice), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i)
        workspace.points[i] = frame.inward(points[original_of[i]]);
    });
    if (insert_with_all_means(workspace, search, stage, progress, original_of, report)) {
      report.dimension = 3;
      finish(workspace, frame, original_of);
      diagram.vertices = std::move(workspace.vertices);
    }
    diagram.points = std::move(workspace.points);
  }
  if (diagram.vertices.empty()) {
    diagram.points.clear();
    for (const Point& p : points) diagram.points.push_back(frame.inward(p));
    report.dimension = std::min(affine_dimension(diagram.points), 2);
  }
  diagram.points.assign(points.begin(), points.end());
  return build;
}

}  // namespace orchard::detail
