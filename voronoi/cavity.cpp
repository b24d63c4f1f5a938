#include "cavity.h"

#include <algorithm>
#include <cassert>

namespace orchard::detail {
namespace {

// kOthers[i]: the other corners, so that (i, others) is an even permutation. The infinite corner 3 comes last.
constexpr std::array<std::array<std::uint8_t, 3>, 4> kOthers{{{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {0, 2, 1}}};

std::uint8_t slot_of(const std::array<Index, 4>& four, Index item) {
  std::uint8_t slot = 0;
  while (four[slot] != item) ++slot;
  return slot;
}

}  // namespace

void Cavity::begin(Index new_point) {
  for (Index v : deleted_) workspace_.set_mark(v, Mark::unseen);
  for (Index v : seen_) workspace_.set_mark(v, Mark::unseen);
  for (const LocalPoint& local : local_points_) set_local(local.point, kNone);
  deleted_.clear();
  seen_.clear();
  facets_.clear();
  local_points_.clear();
  edge_limit_ = 0;
  new_point_ = new_point;
  position_ = workspace_.points[new_point];
  if (local_of_.size() != workspace_.points.size() + 1) local_of_.assign(workspace_.points.size() + 1, kNone);
}

Index Cavity::local(Index point) {
  const Index known = known_local(point);
  if (known != kNone) return known;
  const auto fresh = static_cast<Index>(local_points_.size());
  set_local(point, fresh);
  local_points_.push_back(
      {point == kInfinitePoint ? LengthedVector() : LengthedVector(workspace_.points[point] - position_), point});
  return fresh;
}

void Cavity::add_facet(Index inside, unsigned i) {
  const VoronoiVertex& deleted = workspace_.vertices[inside];
  Facet& facet = facets_.emplace_back();
  facet.vertex.forming_points = deleted.forming_points;
  facet.vertex.forming_points[i] = new_point_;
  facet.slot = static_cast<std::uint8_t>(i);
  facet.outside = deleted.neighbors[i];
  facet.back = slot_of(workspace_.vertices[facet.outside].neighbors, inside);
  facet.vertex.neighbors[i] = facet.outside;
  for (std::uint8_t k : kOthers[i]) facet.local[k] = local(deleted.forming_points[k]);
}

void Cavity::add_all_facets() {
  for (Index v : deleted_)
    for (unsigned i = 0; i < 4; ++i)
      if (workspace_.mark(workspace_.vertices[v].neighbors[i]) != Mark::deleted) add_facet(v, i);
}

// Deleting a tetrahedron v next to a ball-shaped cavity D keeps it a ball iff v touches D in a disk: in one facet and
// not in the opposite corner, or in two facets and not in the edge between the two opposite corners. (Three facets meet
// in a corner all of whose other tetrahedra are deleted: its cell would vanish; four would leave nothing.) This is
// Inagaki et al.'s five constraints. Forward, by induction over the deletions: D is a ball all of whose points lie on
// its boundary, so it is (1) not empty and (2) connected, and around each point, on the sphere of the tetrahedra there,
// D is a disk, hence (4) connected, and the rest is a disk, hence (3) not empty and (5) connected.
// Backward: with one facet and the opposite corner w in D, v is deleted in w's cell but not connected to what else is
// deleted there, against (4). With two facets and the edge w x of their opposite corners in D, on the sphere around w
// the deleted disk would grow by a triangle that touches it in one edge and in the opposite corner x, which parts the
// rest in two, against (5). Three facets are against (3). Only the deletion of a neighbour can make an illegal vertex
// legal, since D's points and edges only become more.
bool Cavity::legal(Index v) const {
  const VoronoiVertex& vertex = workspace_.vertices[v];
  unsigned contacts = 0;
  std::array<unsigned, 4> contact;
  for (unsigned i = 0; i < 4; ++i)
    if (workspace_.mark(vertex.neighbors[i]) == Mark::deleted) contact[contacts++] = i;
  if (contacts == 1) return known_local(vertex.forming_points[contact[0]]) == kNone;
  if (contacts != 2) return false;
  const Index a = known_local(vertex.forming_points[contact[0]]), b = known_local(vertex.forming_points[contact[1]]);
  return edges_.find(std::min(a, b), std::max(a, b)) == kNone;
}

void Cavity::delete_legally(Index v) {
  add_deleted(v);
  for (Index point : workspace_.vertices[v].forming_points) local(point);
  const auto count = static_cast<Index>(local_points_.size());
  if (count <= edge_limit_) return note_edges(v);
  // More points than the table was set up for: twice as many, and everything again.
  edge_limit_ = std::max(EdgeTable::kDense, 2 * count);
  edges_.reset(edge_limit_);
  for (Index d : deleted_) note_edges(d);
}

void Cavity::note_edges(Index v) {
  const auto& corner = workspace_.vertices[v].forming_points;
  for (unsigned i = 0; i < 4; ++i)
    for (unsigned j = i + 1; j < 4; ++j) {
      const Index a = known_local(corner[i]), b = known_local(corner[j]);
      edges_.insert(std::min(a, b), std::max(a, b), 0);
    }
}

bool Cavity::sees_facet(Index v, unsigned i) const {
  const auto& corner = workspace_.vertices[v].forming_points;
  const auto from_new = [&](unsigned k) { return Vector(workspace_.points[corner[kOthers[i][k]]] - position_); };
  if (corner[3] != kInfinitePoint || i == 3)
    return volume_sign(from_new(0), from_new(1), from_new(2)) == Sign::positive;
  VoronoiVertex ignored;
  std::uint8_t error = 0;
  return workspace_.place_at_infinity(ignored, error, LengthedVector(from_new(0)), LengthedVector(from_new(1)));
}

bool Cavity::place_vertices() {
  bool all = true;
  for (Facet& facet : facets_) {
    const auto& [i, j, k] = kOthers[facet.slot];
    const LengthedVector& a = local_points_[facet.local[i]].from_new;
    const LengthedVector& b = local_points_[facet.local[j]].from_new;
    facet.placed = facet.vertex.forming_points[k] == kInfinitePoint
                       ? workspace_.place_at_infinity(facet.vertex, facet.error_class, a, b)
                       : workspace_.place(facet.vertex, facet.error_class, position_, a, b,
                                          local_points_[facet.local[k]].from_new);
    all = all && facet.placed;
  }
  return all;
}

bool Cavity::link_vertices() {
  if (facets_.size() + 4 != 2 * local_points_.size()) return false;
  edges_.reset(static_cast<Index>(local_points_.size()));
  edge_limit_ = 0;
  slots_.resize(facets_.size());
  const std::size_t reused = deleted_.size(), recycled = workspace_.free_vertices.size();
  for (std::size_t f = 0; f < slots_.size(); ++f)
    slots_[f] = f < reused              ? deleted_[f]
                : f < reused + recycled ? workspace_.free_vertices[recycled - 1 - (f - reused)]
                                        : static_cast<Index>(workspace_.vertices.size() + f - reused - recycled);
  std::size_t links = 0;
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    Facet& facet = facets_[f];
    const auto& other = kOthers[facet.slot];
    for (unsigned n = 0; n < 3; ++n) {
      const Index from = facet.local[other[(n + 1) % 3]], to = facet.local[other[(n + 2) % 3]];
      if (!edges_.insert(from, to, static_cast<Index>(4 * f + other[n]))) return false;
      // Facets that meet in an edge run along it in opposite directions.
      const Index mate = edges_.find(to, from);
      if (mate == kNone) continue;
      facet.vertex.neighbors[other[n]] = slots_[mate / 4];
      facets_[mate / 4].vertex.neighbors[mate % 4] = slots_[f];
      ++links;
    }
  }
  return 2 * links == 3 * facets_.size();
}

bool Cavity::is_ball() {
  for (Index v : deleted_)
    for (Index point : workspace_.vertices[v].forming_points)
      if (known_local(point) == kNone) return false;
  // With the right number of facets for one sphere, several pieces or a piece with a handle would have to touch
  // themselves; one piece is a sphere.
  std::vector<Index>& stack = stack_;
  stack.assign(1, 0);
  std::size_t reached = 0;
  std::vector<bool> seen(facets_.size(), false);
  seen[0] = true;
  while (!stack.empty()) {
    const Facet& facet = facets_[stack.back()];
    stack.pop_back();
    ++reached;
    const auto& other = kOthers[facet.slot];
    for (unsigned n = 0; n < 3; ++n) {
      const Index next = edges_.find(facet.local[other[(n + 2) % 3]], facet.local[other[(n + 1) % 3]]) / 4;
      if (seen[next]) continue;
      seen[next] = true;
      stack.push_back(next);
    }
  }
  return reached == facets_.size();
}

Index Cavity::approximate_unplaced() {
  Index count = 0;
  for (Facet& facet : facets_) {
    if (facet.placed) continue;
    ++count;
    const VoronoiVertex& outside = workspace_.vertices[facet.outside];
    const VoronoiVertex& inside = workspace_.vertices[outside.neighbors[facet.back]];
    facet.error_class = Workspace::kUnknownError;
    facet.vertex.center = outside.center;
    if (facet.vertex.forming_points[3] == kInfinitePoint) {
      facet.vertex.radius = outside.radius;
      continue;
    }
    if (outside.forming_points[3] == kInfinitePoint)
      facet.vertex.center =
          (inside.forming_points[3] == kInfinitePoint ? position_ : inside.center) + workspace_.far() * outside.center;
    facet.vertex.radius = (facet.vertex.center - position_).squaredNorm();
  }
  return count;
}

Index Cavity::replace() {
  const std::size_t reused = deleted_.size(), recycled = workspace_.free_vertices.size();
  for (std::size_t f = facets_.size(); f < reused; ++f) {
    workspace_.store(deleted_[f], VoronoiVertex{}, 0);
    workspace_.free_vertices.push_back(deleted_[f]);
  }
  if (facets_.size() > reused) {
    const std::size_t more = facets_.size() - reused;
    workspace_.free_vertices.resize(recycled - std::min(more, recycled));
    if (more > recycled) workspace_.resize(workspace_.vertices.size() + more - recycled);
  }
  Index last = slots_[0];
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const Facet& facet = facets_[f];
    workspace_.store(slots_[f], facet.vertex, facet.error_class);
    workspace_.vertices[facet.outside].neighbors[facet.back] = slots_[f];
    if (facet.placed && facet.vertex.forming_points[3] != kInfinitePoint) last = slots_[f];
  }
  deleted_.clear();  // their marks went with them
  return last;
}

}  // namespace orchard::detail
