#include "insertion/patch.h"

#include <algorithm>
#include <utility>

#include "insertion/cavity.h"
#include "predicates/spanning_points.h"

namespace orchard::detail {
namespace {

// The most vertices of a patch: this number plus one in so many of all. If more have to be replaced, it is faster to
// build the whole diagram again.
constexpr std::size_t kMaxPatch = 1u << 12, kMaxPatchOneIn = 64;

// The most times that a patch may grow, and after how many of these it grows by one layer more.
constexpr int kMaxRounds = 64, kLayerOneIn = 4;

// The most vertices that one region enclosed by a patch may have.
constexpr std::size_t kMaxEnclosed = 1u << 10;

constexpr std::uint8_t kInside = 1, kFarOutside = 2, kReached = 3;

}  // namespace

bool Patch::replace(std::span<const Index> vertices, int layers, std::span<const Index> additional) {
  begin();
  for (const Index v : vertices) add(v);
  grow(0, layers);
  const std::size_t max = kMaxPatch + workspace_.vertices.size() / kMaxPatchOneIn;
  for (int round = 0; round < kMaxRounds && patch_.size() <= max; ++round) {
    const std::size_t before = patch_.size();
    if (insert_points(additional)) {
      note_boundary();
      if (!find_boundary()) {
        grow(before, round / kLayerOneIn);
        continue;
      }
      if (fill() && has_all_points() && has_single_facets()) {
        splice();
        return true;
      }
    }
    if (!add_enclosed()) grow(0, 1);
  }
  return false;
}

void Patch::begin() {
  patch_.clear();
  side_.assign(workspace_.vertices.size(), 0);
  exact_.clear();
  exact_.points.clear();
  exact_.take_scale(workspace_);
  exact_.set_exact(true);
  exact_.forget_noise();
  inserter_.reset();
  points_.clear();
  exact_of_.assign(workspace_.points.size(), kNone);
  noted_ = 0;
  created_.clear();
}

void Patch::add(Index v) {
  if (side_[v] == kInside) return;
  side_[v] = kInside;
  patch_.push_back(v);
}

// Adds layers of vertices around the patch's vertices from number `from` on.
void Patch::grow(std::size_t from, int layers) {
  for (; layers > 0; --layers)
    for (const std::size_t end = patch_.size(); from < end; ++from)
      for (const Index next : workspace_.vertices[patch_[from]].neighbors) add(next);
}

// Adds the vertices that the patch encloses. Returns whether there are any.
bool Patch::add_enclosed() {
  const std::size_t before = patch_.size();
  for (std::size_t i = 0; i < patch_.size(); ++i)
    for (const Index next : workspace_.vertices[patch_[i]].neighbors)
      if (side_[next] == 0 && is_enclosed(next))
        for (const Index v : reached_) add(v);
  for (std::uint8_t& side : side_)
    if (side != kInside) side = 0;
  return patch_.size() > before;
}

// Whether only a few vertices can be reached from this one without crossing the patch.
bool Patch::is_enclosed(Index first) {
  reached_.assign({first});
  side_[first] = kReached;
  bool is_far = false;
  for (std::size_t r = 0; r < reached_.size() && !is_far; ++r)
    for (const Index next : workspace_.vertices[reached_[r]].neighbors) {
      is_far = is_far || side_[next] == kFarOutside || reached_.size() > kMaxEnclosed;
      if (side_[next] != 0) continue;
      side_[next] = kReached;
      reached_.push_back(next);
    }
  for (const Index v : reached_) side_[v] = is_far ? kFarOutside : 0;
  return !is_far;
}

// Inserts the patch's points that the exact diagram does not have yet. Returns false if all of them lie in a plane.
bool Patch::insert_points(std::span<const Index> additional) {
  const std::size_t known = points_.size();
  const auto note = [this](Index point) {
    if (point == kInfinitePoint || exact_of_[point] != kNone) return;
    exact_of_[point] = 0;  // noted; its number follows below, once they are in order
    points_.push_back(point);
  };
  for (const Index point : additional) note(point);
  for (; noted_ < patch_.size(); ++noted_)
    for (const Index point : workspace_.vertices[patch_[noted_]].forming_points) note(point);
  std::sort(points_.begin() + static_cast<std::ptrdiff_t>(known), points_.end());
  for (auto i = static_cast<Index>(known); i < points_.size(); ++i) {
    exact_of_[points_[i]] = i;
    exact_.points.push_back(workspace_.points[points_[i]]);
  }
  std::array<Index, 4> first{kNone, kNone, kNone, kNone};
  const bool is_new = !inserter_;
  if (is_new) {
    first = spanning_points(exact_.points);
    inserter_.emplace(exact_, Search::highest_first, points_.size());
    if (!inserter_->start(first)) {
      inserter_.reset();
      return false;
    }
  }
  for (Index i = is_new ? 0 : static_cast<Index>(known); i < points_.size(); ++i)
    if (std::find(first.begin(), first.end(), i) == first.end()) inserter_->insert(i);
  return true;
}

// The corners of a vertex's facet in their order as seen from the vertex, turned such that the least number is first.
std::array<Index, 3> Patch::corners_of(const VoronoiVertex& vertex, unsigned slot) const {
  const auto& [a, b, c] = Cavity::kOthers[slot];
  const auto& corner = vertex.forming_points;
  std::array<Index, 3> corners{corner[a], corner[b], corner[c]};
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

void Patch::note_boundary() {
  boundary_.clear();
  for (const Index v : patch_) {
    VoronoiVertex vertex = workspace_.vertices[v];
    for (Index& point : vertex.forming_points)
      if (point != kInfinitePoint) point = exact_of_[point];
    for (unsigned slot = 0; slot < 4; ++slot)
      if (side_[vertex.neighbors[slot]] != kInside) boundary_.push_back({corners_of(vertex, slot), v, slot});
  }
  std::sort(boundary_.begin(), boundary_.end(), [](const Facet& a, const Facet& b) { return a.corners < b.corners; });
}

// Finds the facets around the patch in the exact diagram. If some are not there, adds the vertices across from them to
// the patch and returns false.
bool Patch::find_boundary() {
  std::vector<Index> end_of(points_.size() + 1,
                            0);  // for each point, the end of the facets whose least corner is below it
  for (const Facet& facet : boundary_) ++end_of[facet.corners[0] + 1];
  for (std::size_t i = 1; i < end_of.size(); ++i) end_of[i] += end_of[i - 1];
  for (Index v = 0; v < exact_.vertices.size(); ++v)
    for (unsigned slot = 0; slot < 4 && !exact_.is_free(v); ++slot) {
      const std::array<Index, 3> corners = corners_of(exact_.vertices[v], slot);
      for (Index f = end_of[corners[0]]; f < end_of[corners[0] + 1]; ++f)
        if (boundary_[f].corners[1] == corners[1] && boundary_[f].corners[2] == corners[2])
          boundary_[f].exact_inside = v, boundary_[f].exact_slot = slot;
    }
  const std::size_t before = patch_.size();
  for (const Facet& facet : boundary_)
    if (facet.exact_inside == kNone) add(workspace_.vertices[facet.inside].neighbors[facet.slot]);
  return patch_.size() == before;
}

// Collects the vertices of the exact diagram within the boundary. Returns false if they cannot be told apart from those
// beyond it.
bool Patch::fill() {
  filling_.clear();
  std::vector<std::uint8_t> fills(exact_.vertices.size(), 0), walls(exact_.vertices.size(), 0);
  const auto reach = [&](Index v) {
    if (std::exchange(fills[v], 1) == 0) filling_.push_back(v);
  };
  for (const Facet& facet : boundary_) {
    walls[facet.exact_inside] |= static_cast<std::uint8_t>(1u << facet.exact_slot);
    reach(facet.exact_inside);
  }
  for (std::size_t i = 0; i < filling_.size(); ++i)
    for (unsigned slot = 0; slot < 4; ++slot)
      if (((walls[filling_[i]] >> slot) & 1u) == 0) reach(exact_.vertices[filling_[i]].neighbors[slot]);
  return std::none_of(boundary_.begin(), boundary_.end(), [&](const Facet& facet) {
    return fills[exact_.vertices[facet.exact_inside].neighbors[facet.exact_slot]] != 0;
  });
}

// Whether every point forms a vertex of the filling.
bool Patch::has_all_points() const {
  std::vector<std::uint8_t> has(points_.size(), 0);
  for (const Index v : filling_)
    for (const Index point : exact_.vertices[v].forming_points)
      if (point != kInfinitePoint) has[point] = 1;
  return std::find(has.begin(), has.end(), 0) == has.end();
}

// Whether no vertex around the patch shares two facets with the same vertex of the patch or of the filling. If one did,
// two facets of the hull would lie on each other, upside down.
bool Patch::has_single_facets() const {
  std::vector<std::array<Index, 2>> before, after;
  for (const Facet& facet : boundary_) {
    const Index outside = workspace_.vertices[facet.inside].neighbors[facet.slot];
    before.push_back({outside, facet.inside});
    after.push_back({outside, facet.exact_inside});
  }
  const auto are_single = [](auto& pairs) {
    std::sort(pairs.begin(), pairs.end());
    return std::adjacent_find(pairs.begin(), pairs.end()) == pairs.end();
  };
  const auto same_corners = [](const Facet& a, const Facet& b) { return a.corners == b.corners; };
  return are_single(before) && are_single(after) &&
         std::adjacent_find(boundary_.begin(), boundary_.end(), same_corners) == boundary_.end();
}

// Chooses the slots of the filling's vertices: first those of the patch.
void Patch::choose_slots() {
  auto& free = workspace_.free_vertices;
  slots_.assign(exact_.vertices.size(), kNone);
  for (std::size_t i = 0; i < filling_.size(); ++i) {
    Index& slot = slots_[filling_[i]];
    if (i < patch_.size()) {
      slot = patch_[i];
    } else if (!free.empty()) {
      slot = free.back();
      free.pop_back();
    } else {
      slot = static_cast<Index>(workspace_.vertices.size());
      workspace_.append();
    }
    created_.push_back(slot);
  }
}

// Replaces the patch by the filling.
void Patch::splice() {
  std::vector<std::array<Index, 2>> across;  // the vertex across, and its slot for this facet
  for (const auto& [corners, inside, slot, exact_inside, exact_slot] : boundary_) {
    const Index outside = workspace_.vertices[inside].neighbors[slot];
    across.push_back({outside, static_cast<Index>(workspace_.slot_now(outside, inside))});
  }
  choose_slots();
  for (std::size_t i = filling_.size(); i < patch_.size(); ++i) {
    workspace_.store(patch_[i], VoronoiVertex{}, 0);
    workspace_.free_vertices.push_back(patch_[i]);
  }
  for (const Index v : filling_) {
    VoronoiVertex vertex = exact_.vertices[v];
    for (Index& point : vertex.forming_points)
      if (point != kInfinitePoint) point = points_[point];
    for (Index& neighbor : vertex.neighbors) neighbor = slots_[neighbor];
    workspace_.store(slots_[v], vertex, Workspace::kNotSettled);
  }
  for (std::size_t f = 0; f < boundary_.size(); ++f) {
    const Index inside = slots_[boundary_[f].exact_inside];
    workspace_.set_neighbor(inside, boundary_[f].exact_slot, across[f][0]);
    workspace_.set_neighbor(across[f][0], across[f][1], inside);
  }
  for (const Index v : created_) {
    workspace_.settle(v);
    if (!workspace_.at_infinity(v)) workspace_.place_sharply(v);
  }
}

}  // namespace orchard::detail
