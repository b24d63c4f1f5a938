#include "orchard/medial/gap_crossing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "cell_neighbors.h"
#include "cell_patches.h"
#include "gap_test.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/voronoi/exact.h"
#include "repair_point.h"
#include "restricted_voronoi.h"

namespace orchard {
namespace {

using detail::CellPatch;
using detail::RepairPoint;

// A crossing patch, and what the loop knows about it.
struct Crossing {
  Index patch = kNone;
  std::vector<Index> neighbors;  // cells whose shared face crosses harmfully
  RepairPoint repair;
};

// Two new points of one pass keep this share of their gaps' widths between them: what one of them does not mend is seen
// in the next pass, so that wide gaps get few points.
constexpr double kSpread = 0.5;

class Repair {
 public:
  Repair(const Surface& surface, SurfaceSampling sampling, VoronoiDiagram diagram, const RepairOptions& options,
         const Progress& progress)
      : surface_(surface),
        options_(options),
        progress_(progress),
        result_{std::move(sampling), std::move(diagram), {}},
        generations_(result_.sampling.size(), 0),
        neighbors_(detail::cell_neighbors(result_.diagram)),
        restricted_(surface, result_.diagram.points, neighbors_) {}

  Repaired run() {
    for (int pass = 0; pass < options_.max_passes; ++pass) {
      report_progress(progress_, "gap repair", static_cast<double>(pass) / options_.max_passes);
      detect();
      result_.report.passes.push_back(summary_);
      result_.report.faces_still_crossing = summary_.faces_crossing;
      if (crossings_.empty()) break;
      const Index before = result_.sampling.size();
      add_points();
      if (result_.sampling.size() == before) break;
      update_diagram(before);
    }
    final_check();
    report_progress(progress_, "gap repair", 1);
    return std::move(result_);
  }

 private:
  void detect() {
    patches_ = detail::find_cell_patches(surface_, result_.sampling, restricted_);
    std::vector<Crossing> found;
    for (Index i = 0; i < patches_.size(); ++i) {
      if (!patches_[i].home) found.push_back({i, {}, {}});
    }
    tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t i) {
      found[i].neighbors = detail::harmful_neighbors(surface_, result_.sampling, restricted_, patches_[found[i].patch],
                                                     options_.joined_radius);
    });
    crossings_.clear();
    std::vector<std::array<Index, 2>> faces;
    for (Crossing& crossing : found) {
      if (crossing.neighbors.empty()) continue;
      const Index cell = patches_[crossing.patch].cell;
      for (const Index other : crossing.neighbors) faces.push_back({std::min(cell, other), std::max(cell, other)});
      crossings_.push_back(std::move(crossing));
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    summary_ = {};
    summary_.faces_tested = static_cast<Index>(neighbors_.items.size() / 2);
    summary_.faces_crossing = static_cast<Index>(faces.size());
  }

  void add_points() {
    tbb::parallel_for(std::size_t{0}, crossings_.size(), [&](std::size_t i) {
      const CellPatch& patch = patches_[crossings_[i].patch];
      const auto across = generations_[patch.cell] > 0 ? detail::Across::straight : detail::Across::normal;
      crossings_[i].repair =
          detail::propose_repair(surface_, result_.sampling, restricted_, patch, home_of(crossings_[i].patch), across);
    });
    std::stable_sort(crossings_.begin(), crossings_.end(), [](const Crossing& a, const Crossing& b) {
      return a.repair.snapped != b.repair.snapped ? !a.repair.snapped : a.repair.gap > b.repair.gap;
    });
    const Index first_new = result_.sampling.size();
    for (const Crossing& crossing : crossings_) consider(crossing.repair, first_new);
  }

  void consider(const RepairPoint& repair, Index first_new) {
    SurfaceSampling& sampling = result_.sampling;
    for (Index i = first_new; i < sampling.size(); ++i) {
      if ((sampling.points[i] - repair.position).norm() < kSpread * repair.gap) return;
    }
    const Index nearest = detail::nearest_point(result_.diagram.points, neighbors_, repair.position, repair.cell);
    const double coincident = tolerance::kCoincidentPoints * surface_.bounding_radius();
    if (!((sampling.points[nearest] - repair.position).norm() > coincident)) {
      ++result_.report.passes.back().refused_as_coincident;
      return;
    }
    sampling.points.push_back(repair.position);
    sampling.triangles.push_back(repair.triangle);
    sampling.features.push_back(repair.feature);
    sampling.origins.push_back(PointOrigin::repair);
    generations_.push_back(generations_[repair.cell] + 1);
    ++result_.report.points_added;
    ++(repair.snapped ? result_.report.passes.back().added_by_snapping
                      : result_.report.passes.back().added_by_projection);
  }

  const CellPatch* home_of(Index patch) const {
    const Index cell = patches_[patch].cell;
    Index first = patch;
    while (first > 0 && patches_[first - 1].cell == cell) --first;
    for (Index i = first; i < patches_.size() && patches_[i].cell == cell; ++i) {
      if (patches_[i].home) return &patches_[i];
    }
    return nullptr;
  }

  void update_diagram(Index first_new) {
    result_.diagram = exact_voronoi(result_.sampling.points);
    neighbors_ = detail::cell_neighbors(result_.diagram);
    std::vector<std::uint8_t> changed(result_.sampling.size(), 0);
    for (Index point = first_new; point < changed.size(); ++point) {
      changed[point] = 1;
      for (const Index other : neighbors_[point]) changed[other] = 1;
    }
    restricted_.update(result_.diagram.points, neighbors_, changed);
  }

  void final_check() {
    restricted_ = detail::RestrictedVoronoi(surface_, result_.diagram.points, neighbors_);
    detect();
    result_.report.faces_still_crossing = summary_.faces_crossing;
  }

  const Surface& surface_;
  const RepairOptions options_;
  const Progress& progress_;
  Repaired result_;
  std::vector<int> generations_;  // of each point: how many repair points led to it
  Rows neighbors_;
  detail::RestrictedVoronoi restricted_;
  std::vector<CellPatch> patches_;
  std::vector<Crossing> crossings_;
  RepairPass summary_;
};

}  // namespace

Repaired repair_gap_crossings(const Surface& surface, SurfaceSampling sampling, VoronoiDiagram diagram,
                              const RepairOptions& options, const Progress& progress) {
  if (!surface.solid()) {
    throw InputError("gap repair needs a solid: " + surface.report().faults() + "; repair the mesh first");
  }
  return Repair(surface, std::move(sampling), std::move(diagram), options, progress).run();
}

}  // namespace orchard
