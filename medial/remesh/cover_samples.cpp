#include "cover_samples.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <map>

#include "../axis/incidence.h"
#include "../quality/reconstruction.h"

namespace orchard::detail {
namespace {

constexpr double kNearCell = 0.5;  // of the limit: a cell that is nearer than this is near enough

Sphere sphere(const SheetMesh& mesh, Index v) { return {mesh.ball(v).center, mesh.ball(v).radius}; }

// Returns the distance of a place to the balls of a cell.
double distance_to_cell(const SheetMesh& mesh, const SheetMesh::Cell& cell, const Point& place) {
  const Sphere a = sphere(mesh, cell[0]);
  Sphere nearest = a;
  if (is_triangle(cell)) {
    nearest = nearest_ball(place, a, sphere(mesh, cell[1]), sphere(mesh, cell[2]));
  } else if (cell[0] != cell[1]) {
    nearest = nearest_ball(place, a, sphere(mesh, cell[1]));
  }
  return (place - nearest.center).norm() - nearest.radius;
}

SheetMesh::Cell sorted(SheetMesh::Cell cell) {
  std::sort(cell.begin(), cell.end());
  return cell;
}

}  // namespace

CoverSamples::CoverSamples(const SheetMesh& mesh, std::span<const Point> places, double limit)
    : places_(places), limit_(limit), distance_(places.size(), 0) {
  std::map<SheetMesh::Cell, Index> number;
  MedialMesh all;
  for (Index v = 0; v < mesh.vertices(); ++v) {
    all.centers.push_back(mesh.ball(v).center);
    all.radii.push_back(mesh.ball(v).radius);
  }
  for (Index c = 0; c < mesh.cells(); ++c) {
    if (!mesh.alive(c)) continue;
    const SheetMesh::Cell& cell = mesh.corners(c);
    number[sorted(cell)] = c;
    if (is_triangle(cell)) all.triangles.push_back(cell);
    if (!is_triangle(cell) && cell[0] != cell[1]) all.edges.push_back({cell[0], cell[1]});
  }
  complete_cells(all.edges, all.triangles);
  const Reconstruction reconstruction(all);
  std::vector<Index> cell_of(places.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, places.size(), 128), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const Reconstruction::Nearest nearest = reconstruction.nearest(places[i]);
      distance_[i] = nearest.distance;
      const auto at = number.find(sorted(reconstruction.corners_of(nearest.cell)));
      cell_of[i] = at == number.end() ? kNone : at->second;
    }
  });
  places_of_.resize(mesh.cells());
  for (Index i = 0; i < places.size(); ++i) {
    if (cell_of[i] != kNone) places_of_[cell_of[i]].push_back(i);
  }
}

// Finds the existing cells at the touched vertices, without those that were just made.
void CoverSamples::find_around(const SheetMesh& mesh, std::span<const Index> made, std::span<const Index> touched) {
  for (const Index v : touched) around_.insert(around_.end(), mesh.cells_at(v).begin(), mesh.cells_at(v).end());
  std::sort(around_.begin(), around_.end());
  around_.erase(std::unique(around_.begin(), around_.end()), around_.end());
  std::erase_if(around_, [&](Index c) { return std::find(made.begin(), made.end(), c) != made.end(); });
}

bool CoverSamples::stay_covered(const SheetMesh& mesh, std::span<const Index> old, std::span<const Index> made,
                                std::span<const Index> touched) {
  moves_.clear();
  old_.assign(old.begin(), old.end());
  around_.clear();
  for (const Index c : old) {
    if (c >= places_of_.size()) continue;
    for (const Index place : places_of_[c]) {
      Move move{.place = place, .cell = kNone, .distance = std::numeric_limits<double>::infinity()};
      const auto look_at = [&](std::span<const Index> cells) {
        for (const Index cell : cells) {
          const double distance = distance_to_cell(mesh, mesh.corners(cell), places_[place]);
          if (distance < move.distance) move = {.place = place, .cell = cell, .distance = distance};
        }
      };
      look_at(made);
      if (move.distance > kNearCell * limit_) {
        if (around_.empty()) find_around(mesh, made, touched);
        look_at(around_);
      }
      if (!(move.distance <= std::max(limit_, distance_[place]))) return false;
      moves_.push_back(move);
    }
  }
  return true;
}

void CoverSamples::settle() {
  for (const Index c : old_) {
    if (c < places_of_.size()) places_of_[c].clear();
  }
  for (const Move& move : moves_) {
    if (move.cell >= places_of_.size()) places_of_.resize(move.cell + 1);
    places_of_[move.cell].push_back(move.place);
    distance_[move.place] = move.distance;
  }
  moves_.clear();
}

}  // namespace orchard::detail
