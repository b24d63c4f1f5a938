#include "orchard/medial/gap_crossing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include "cell_neighbors.h"
#include "crossings.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/voronoi/highest_first.h"
#include "point_tree.h"
#include "repair_point.h"
#include "restricted_voronoi.h"
#include "thinning.h"

namespace orchard {
namespace {

using detail::Crossing;
using detail::RepairProposal;

// Two new points of one pass are at least this share of a gap's width apart. What the first of them does not mend is
// found in the next pass, so wide gaps get few points.
constexpr double kGapSpread = 1;

// Repair points can cause further repair points, back and forth across a gap. After so many in a row, propose_repair()
// is asked to end that.
constexpr int kBounceLength = 3;

// Whether insert_points() rebuilt the whole diagram, so that cells of old points may have changed, too.
bool was_rebuilt(const InsertionReport& report, std::size_t inserted) {
  return report.certified_insertions + report.settled_insertions + report.exact_insertions +
             report.constrained_insertions >
         inserted;
}

struct CrossingCandidate {
  Index cell = kNone;
  std::vector<Index> neighbors;
  RepairProposal proposal;
  bool neck = false;
};

class Repair {
 public:
  Repair(const Surface& surface, SurfaceSampling sampling, VoronoiDiagram diagram, const GapRepairOptions& options,
         const Progress& progress)
      : surface_(surface),
        options_(options),
        progress_(progress),
        result_{std::move(sampling), std::move(diagram), {}},
        generations_(result_.sampling.size(), 0),
        neighbors_(result_.diagram),
        cuts_(surface.self_intersections()) {
    const std::size_t count = cuts_.size();
    for (std::size_t i = 0; i < count; ++i) cuts_.push_back({cuts_[i][1], cuts_[i][0]});
    std::sort(cuts_.begin(), cuts_.end());
  }

  GapRepair run() {
    find_from_scratch();
    for (int pass = 0; pass < options_.max_passes; ++pass) {
      report_progress(progress_, "gap repair", static_cast<double>(pass) / options_.max_passes);
      if (!anything_to_mend() && !from_scratch_) find_from_scratch();
      open_pass();
      if (!anything_to_mend()) break;
      const Index before = result_.sampling.size();
      add_points(propose(what_to_mend()));
      if (result_.sampling.size() == before) break;
      update(before);
    }
    if (!from_scratch_) find_from_scratch();
    result_.report.faces_still_crossing = detail::count_faces(crossings_);
    std::erase_if(crossings_, [](const Crossing& crossing) { return !crossing.at_cut; });
    result_.report.faces_at_cuts = detail::count_faces(crossings_);
    report_progress(progress_, "gap repair", 1);
    return std::move(result_);
  }

 private:
  void find_from_scratch() {
    from_scratch_ = true;
    cells_tested_ = result_.sampling.size();
    restricted_.emplace(surface_, result_.diagram.points, neighbors_);
    crossings_ = detail::find_crossings(surface_, result_.sampling, *restricted_,
                                        detail::ComponentScope::everything(surface_, result_.sampling), options_);
    mark_cuts(crossings_);
  }

  void mark_cuts(std::vector<Crossing>& crossings) const {
    for (Crossing& crossing : crossings) {
      const auto cut_inside = [&](Index triangle) {
        auto cut = std::lower_bound(cuts_.begin(), cuts_.end(), std::array{triangle, Index{0}});
        for (; cut != cuts_.end() && (*cut)[0] == triangle; ++cut) {
          if (restricted_->piece((*cut)[1], crossing.component.cell) != nullptr) return true;
        }
        return false;
      };
      const auto& triangles = crossing.component.triangles;
      crossing.at_cut = std::any_of(triangles.begin(), triangles.end(), cut_inside);
    }
  }

  bool anything_to_mend() const {
    return !std::all_of(crossings_.begin(), crossings_.end(), [](const Crossing& crossing) { return crossing.at_cut; });
  }

  void open_pass() {
    GapRepairPass& pass = result_.report.passes.emplace_back();
    pass.cells_tested = cells_tested_;
    pass.cells_crossing = detail::count_cells(crossings_);
    pass.faces_tested = neighbors_.count_faces();
    pass.faces_crossing = detail::count_faces(crossings_);
  }

  // The crossings to mend in this pass: gaps first, since closing them also mends necks around them. Those necks wait.
  std::vector<const Crossing*> what_to_mend() const {
    std::vector<std::uint8_t> at_gap(result_.sampling.size(), 0);
    for (const Crossing& crossing : crossings_) {
      if (crossing.neck || crossing.at_cut) continue;
      at_gap[crossing.component.cell] = 1;
      for (const Index other : crossing.neighbors) at_gap[other] = 1;
    }
    std::vector<const Crossing*> chosen;
    for (const Crossing& crossing : crossings_) {
      const auto is_at_gap = [&](Index cell) { return at_gap[cell] != 0; };
      if (crossing.at_cut) continue;
      const bool wait = crossing.neck && (is_at_gap(crossing.component.cell) ||
                                          std::any_of(crossing.neighbors.begin(), crossing.neighbors.end(), is_at_gap));
      if (!wait) chosen.push_back(&crossing);
    }
    return chosen;
  }

  // Repair points for these crossings: projections before points to snap to, wide gaps before narrow ones, then by
  // cell.
  std::vector<CrossingCandidate> propose(const std::vector<const Crossing*>& crossings) const {
    std::vector<CrossingCandidate> candidates(crossings.size());
    tbb::parallel_for(std::size_t{0}, crossings.size(), [&](std::size_t i) {
      const Crossing& crossing = *crossings[i];
      const Index cell = crossing.component.cell;
      candidates[i] = {cell, crossing.neighbors,
                       detail::propose_repair(surface_, result_.sampling, *restricted_, crossing,
                                              generations_[cell] >= kBounceLength),
                       crossing.neck};
    });
    std::stable_sort(candidates.begin(), candidates.end(), [](const CrossingCandidate& a, const CrossingCandidate& b) {
      const bool a_snaps = a.proposal.facing.empty(), b_snaps = b.proposal.facing.empty();
      return a_snaps != b_snaps ? b_snaps : a.proposal.gap() > b.proposal.gap();
    });
    return candidates;
  }

  void add_points(const std::vector<CrossingCandidate>& candidates) {
    std::vector<std::uint8_t> projected(result_.sampling.size(), 0);  // cells that a projection mends in this pass
    detail::PointTree new_points(surface_.bounding_box());
    for (const CrossingCandidate& candidate : candidates) {
      if (near_new_point(candidate, new_points)) continue;
      GapRepairPass& pass = result_.report.passes.back();
      const auto& [facing, snapped] = candidate.proposal;
      const auto add_place = [&](const ClosestPoint& place) { return add(place, candidate.cell, new_points); };
      if (std::any_of(facing.begin(), facing.end(), add_place)) {
        projected[candidate.cell] = 1;
        ++pass.added_by_projection;
        continue;
      }
      // If a cell across the face found a projection in this pass, that may mend this crossing as well: it waits.
      const bool wait = std::any_of(candidate.neighbors.begin(), candidate.neighbors.end(),
                                    [&](Index other) { return projected[other] != 0; });
      if (wait) continue;
      if (add(snapped, candidate.cell, new_points)) {
        ++(candidate.neck ? pass.added_at_necks : pass.added_by_snapping);
      } else {
        ++pass.refused_as_coincident;
      }
    }
    result_.report.passes.back().steps_among_new_points = new_points.steps();
  }

  static bool near_new_point(const CrossingCandidate& candidate, const detail::PointTree& new_points) {
    const RepairProposal& proposal = candidate.proposal;
    const Point& position = proposal.facing.empty() ? proposal.snapped.position : proposal.facing[0].position;
    const double spread = kGapSpread * proposal.gap();
    return new_points.any_within(
        position, spread, [&](const Point& point) { return (point - position).squaredNorm() < spread * spread; });
  }

  // Adds a repair point. Returns false if there is a point already.
  bool add(const ClosestPoint& place, Index cell, detail::PointTree& new_points) {
    SurfaceSampling& sampling = result_.sampling;
    // At least the distance below which insert_points() takes points for coincident.
    const double coincident = tolerance::kCoincidentPoints * surface_.bounding_box().diagonal().norm() / 2;
    const auto taken = [&](const Point& point) { return !((point - place.position).norm() > coincident); };
    const Index nearest = detail::nearest_point(result_.diagram.points, neighbors_, place.position, cell);
    if (taken(sampling.points[nearest]) || new_points.any_within(place.position, coincident, taken)) return false;
    new_points.add(place.position);
    sampling.points.push_back(place.position);
    sampling.triangles.push_back(place.triangle);
    sampling.features.push_back(place.feature);
    sampling.origins.push_back(PointOrigin::repair);
    generations_.push_back(generations_[cell] + 1);
    ++result_.report.points_added;
    return true;
  }

  // Inserts the new points and finds the crossings of changed cells again. Those of unchanged cells are still there.
  void update(Index first_new) {
    const auto added = std::span<const Point>(result_.sampling.points).subspan(first_new);
    const InsertionReport inserted = insert_points(result_.diagram, added);
    if (was_rebuilt(inserted, added.size())) {
      neighbors_ = detail::CellNeighbors(result_.diagram);
      find_from_scratch();
      return;
    }
    from_scratch_ = false;
    detail::ComponentScope scope;
    scope.cells = neighbors_.update(result_.diagram, first_new);
    cells_tested_ = static_cast<Index>(std::count(scope.cells.begin(), scope.cells.end(), std::uint8_t{1}));
    scope.triangles = restricted_->update(result_.diagram.points, scope.cells);
    std::erase_if(crossings_, [&](const Crossing& crossing) { return scope.cells[crossing.component.cell] != 0; });
    std::vector<Crossing> found = detail::find_crossings(surface_, result_.sampling, *restricted_, scope, options_);
    mark_cuts(found);
    std::move(found.begin(), found.end(), std::back_inserter(crossings_));
    std::stable_sort(crossings_.begin(), crossings_.end(),
                     [](const Crossing& a, const Crossing& b) { return a.component.cell < b.component.cell; });
  }

  const Surface& surface_;
  const GapRepairOptions options_;
  const Progress& progress_;
  GapRepair result_;
  std::vector<int> generations_;  // of each point: how many repair points led to it
  detail::CellNeighbors neighbors_;
  std::optional<detail::RestrictedVoronoi> restricted_;
  std::vector<Crossing> crossings_;         // crossings that are left, ascending by cell
  bool from_scratch_ = false;               // whether the crossings were found from scratch, not by updates
  Index cells_tested_ = 0;                  // number of cells in the last search for crossings
  std::vector<std::array<Index, 2>> cuts_;  // pairs of triangles that cut each other, in both orders; ascending
};

constexpr int kThinningRounds = 4;  // the first saves most; later ones a few percent each

// Removes points of crowded pairs, makes a new diagram and mends it, in several rounds. The report lists the passes of
// all rounds.
GapRepair thinned(const Surface& surface, GapRepair repaired, Index original, const GapRepairOptions& options,
                  const Progress& progress) {
  const double spacing = std::sqrt(surface.report().area / original);
  for (int round = 0; round < kThinningRounds; ++round) {
    const std::vector<std::uint8_t> stay = detail::without_crowded_pairs(surface, repaired.sampling, spacing);
    if (std::count(stay.begin(), stay.end(), 0) == 0) break;
    const Index left = static_cast<Index>(std::count(stay.begin(), stay.begin() + original, 1));
    SurfaceSampling sampling = detail::points_that_stay(repaired.sampling, stay);
    VoronoiDiagram diagram = highest_first_voronoi(sampling.points, progress).diagram;
    GapRepair next = Repair(surface, std::move(sampling), std::move(diagram), options, progress).run();
    if (next.sampling.size() >= repaired.sampling.size() ||
        next.report.faces_still_crossing > repaired.report.faces_still_crossing) {
      break;
    }
    GapRepairReport& report = next.report;
    report.passes.insert(report.passes.begin(), repaired.report.passes.begin(), repaired.report.passes.end());
    report.points_removed = repaired.report.points_removed + original - left;
    report.points_added = next.sampling.size() - left;
    original = left;
    repaired = std::move(next);
  }
  return repaired;
}

}  // namespace

GapRepair repair_gap_crossings(const Surface& surface, SurfaceSampling sampling, VoronoiDiagram diagram,
                               const GapRepairOptions& options, const Progress& progress) {
  if (!surface.solid()) {
    throw InputError("gap repair needs a solid: " + surface.report().faults() + "; repair the mesh first");
  }
  if (diagram.points.size() != sampling.size() || diagram.vertices.empty()) {
    throw InputError("gap repair needs the Voronoi diagram of the sampling's own points");
  }
  const Index original = sampling.size();
  GapRepair repaired = Repair(surface, std::move(sampling), std::move(diagram), options, progress).run();
  if (!options.thin || repaired.report.points_added == 0) return repaired;
  return thinned(surface, std::move(repaired), original, options, progress);
}

}  // namespace orchard
