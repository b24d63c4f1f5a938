// All steps of one insertion, from the deleted vertices to the new ones, work on the same arrays, which stay in the
// cache; hence more than 300 lines in one file.
#include "insertion/cavity.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

namespace orchard::detail {
namespace {

constexpr unsigned kLanes = 4;  // facets that are placed at once

}  // namespace

void Cavity::end() {
  for (Index v : deleted_.items()) workspace_.set_mark(v, Mark::unseen);
  for (Index v : seen_.items()) workspace_.set_mark(v, Mark::unseen);
  for (const Index point : local_points_.items()) known_local(point) = kNone;
  deleted_.clear();
  seen_.clear();
  boundary_.clear();
  is_boundary_noted_ = undoubted_ = false;
  local_points_.clear();
  edge_limit_ = 0;
}

void Cavity::begin(Index new_point) {
  end();
  left_territory_ = false;
  new_point_ = new_point;
  position_ = workspace_.points[new_point];
  if (local_of_.size() != workspace_.points.size() + 1) local_of_.assign(workspace_.points.size() + 1, kNone);
}

void Cavity::measure_local_points() {
  if (from_new_.size() < local_points_.size()) from_new_.resize(local_points_.size());
  for (std::size_t i = 0; i < local_points_.size(); ++i) {
    const Index point = local_points_.items()[i];
    from_new_[i] = point == kInfinitePoint ? LengthedVector() : LengthedVector(workspace_.points[point] - position_);
  }
}

void Cavity::note_boundary() {
  boundary_.clear();
  for (const Index v : deleted_.items()) {
    boundary_.ensure_room();
    for (unsigned i = 0; i < 4; ++i)
      boundary_.push_if(4 * v + i, workspace_.mark(workspace_.vertices[v].neighbors[i]) != Mark::deleted);
  }
}

// Values that change in the loop are kept in local variables. Otherwise the compiler has to assume that each store of a
// byte may change them, and loading a count from memory again for every corner takes most of the time.
void Cavity::note_facets() {
  if (!is_boundary_noted_) note_boundary();
  const std::size_t count = boundary_.size();
  facets_.resize(count);
  Facet* const facets = facets_.data();
  const Index* const boundary = boundary_.items().data();
  Index* const points = local_points_.room_for(3 * count);
  Index* const local_of = local_of_.data();
  auto known_points = static_cast<Index>(local_points_.size());
  // The number of a local point, a new one if it has none yet; without branches.
  const auto local = [points, local_of, &known_points](Index point) {
    Index& known = local_of[static_cast<Index>(point + 1)];
    const bool fresh = known == kNone;
    known = fresh ? known_points : known;
    points[known_points] = point;
    known_points += fresh;
    return known;
  };
  for (std::size_t f = 0; f < count; ++f) {
    const Index inside = boundary[f] / 4;
    const unsigned slot = boundary[f] % 4;
    const VoronoiVertex& deleted = workspace_.vertices[inside];
    const Index outside = deleted.neighbors[slot];
    const std::size_t back = workspace_.slot_now(outside, inside);
    const auto& [a, b, c] = kOthers[slot];
    const auto& corner = deleted.forming_points;
    const Index of_a = local(corner[a]), of_b = local(corner[b]), of_c = local(corner[c]);
    facets[f] = {inside, outside, {of_a, of_b, of_c}, static_cast<std::uint8_t>(slot), static_cast<std::uint8_t>(back),
                 0,      false,   Placing::failed};
  }
  local_points_.resize(known_points);
  measure_local_points();
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
  delete_vertex(v);
  local_points_.ensure_room();
  for (Index point : workspace_.vertices[v].forming_points) local(point);
  const auto count = static_cast<Index>(local_points_.size());
  if (count <= edge_limit_) return note_edges(v);
  // There are more points than the table has room for: it is set up for twice as many and filled again.
  edge_limit_ = std::max(EdgeTable::kDense, 2 * count);
  edges_.reset(edge_limit_);
  for (Index d : deleted_.items()) note_edges(d);
}

void Cavity::note_edges(Index v) {
  const auto& corner = workspace_.vertices[v].forming_points;
  for (unsigned i = 0; i < 4; ++i)
    for (unsigned j = i + 1; j < 4; ++j) {
      const Index a = known_local(corner[i]), b = known_local(corner[j]);
      edges_.insert(std::min(a, b), std::max(a, b), 0);
    }
}

Sign Cavity::side_of_facet(Index v, unsigned i) const {
  const auto& corner = workspace_.vertices[v].forming_points;
  const auto& [a, b, c] = kOthers[i];
  const Point& first = workspace_.points[corner[a]];
  const Point& second = workspace_.points[corner[b]];
  if (corner[c] != kInfinitePoint) return volume_sign(position_, first, second, workspace_.points[corner[c]]);
  // A new vertex at infinity always has the right orientation, but its points must form a triangle.
  Vector normal;
  return sharp_normal(position_, first, second, normal) ? Sign::positive : Sign::uncertain;
}

bool Cavity::place_vertices() {
  // Facets are placed four at a time, so the last four may reach beyond the last facet.
  if (fresh_.size() < facets_.size() + kLanes - 1) fresh_.resize(facets_.size() + kLanes - 1);
  bool visible = true;
  worst_ = Placing::good;
  const bool in_lanes = can_place_four();
  for (std::size_t first = 0; first < facets_.size(); first += kLanes) {
    const std::size_t count = std::min<std::size_t>(facets_.size() - first, kLanes);
    FourQualities qualities;
    qualities.good = 0;
    if (in_lanes)
      place_spheres(first, first + count, qualities);
    else
      qualities.error_class.fill(0);
    for (std::size_t lane = 0; lane < count; ++lane) {
      note_forming_points(first + lane);
      Facet& facet = facets_[first + lane];
      facet.error_class =
          ((qualities.good >> lane) & 1u) != 0 ? static_cast<std::uint8_t>(qualities.error_class[lane]) : 0;
      facet.placing = Placing::good;
      facet.visible = true;
    }
    // The facets whose vertices are not certainly good are placed one by one.
    for (unsigned rest = ~qualities.good & ((1u << count) - 1); rest != 0; rest &= rest - 1) {
      const auto lane = static_cast<unsigned>(std::countr_zero(rest));
      visible &= place_vertex(first + lane, in_lanes, qualities[lane]);
      worst_ = std::max(worst_, facets_[first + lane].placing);
    }
  }
  return visible_ = visible;
}

inline void Cavity::note_forming_points(std::size_t f) {
  fresh_[f].forming_points = workspace_.vertices[facets_[f].inside].forming_points;
  fresh_[f].forming_points[facets_[f].slot] = new_point_;
}

// Places the spheres of four facets at once. Facets with the point at infinity, which has no position, never count as
// good.
inline void Cavity::place_spheres(std::size_t first, std::size_t end, FourQualities& qualities) {
  FourTriangles triangles;
  for (unsigned lane = 0; lane < kLanes; ++lane) {
    const auto& [a, b, c] = facets_[std::min(first + lane, end - 1)].local;
    triangles.a[lane] = &from_new_[a];
    triangles.b[lane] = &from_new_[b];
    triangles.c[lane] = &from_new_[c];
  }
  place_four(position_, workspace_.placing_limits(undoubted_), triangles, &fresh_[first], qualities);
}

// Places one new vertex. Returns whether the facet is visible from the new point. `placed`: the quality of the sphere
// that place_spheres() has computed, if `has_sphere`.
bool Cavity::place_vertex(std::size_t f, bool has_sphere, const PlacedQuality& placed) {
  Facet& facet = facets_[f];
  VoronoiVertex& vertex = fresh_[f];
  const bool at_infinity = vertex.forming_points[kOthers[facet.slot][2]] == kInfinitePoint;
  const LengthedVector& a = from_new_[facet.local[0]];
  const LengthedVector& b = from_new_[facet.local[1]];
  if (at_infinity)
    facet.placing = workspace_.place_at_infinity(vertex, facet.error_class, a, b);
  else if (has_sphere)
    facet.placing = workspace_.judge(placed, facet.error_class);
  else
    facet.placing = workspace_.place(vertex, facet.error_class, position_, a, b, from_new_[facet.local[2]]);
  facet.visible = facet.placing != Placing::failed || side_of_facet(facet.inside, facet.slot) == Sign::positive;
  if ((facet.placing != Placing::good || workspace_.poor(vertex, facet.error_class)) && !undoubted_ && !at_infinity &&
      facet.visible && !workspace_.exact()) {
    if (workspace_.share_sphere(vertex, facet.error_class, facet.outside, position_))
      facet.placing = Placing::shared;
    else if (facet.placing == Placing::good && workspace_.sign(facet.outside, position_) == Sign::uncertain)
      facet.placing = Placing::thin;
  }
  return facet.visible;
}

bool Cavity::link_vertices() {
  if (facets_.size() + 4 != 2 * local_points_.size()) return false;
  if (local_points_.size() <= kFewPoints) return link_by(few_links_);
  return local_points_.size() <= kManyPoints ? link_by(many_links_) : link_by_lists();
}

// Links facets that share an edge: they run along it in opposite directions. To have no branches, first all edges are
// entered in the table, then each edge looks for the opposite one.
template <unsigned kPoints, unsigned kStride>
bool Cavity::link_by(LinkTable<kPoints, kStride>& links) {
  using Table = LinkTable<kPoints, kStride>;
  const unsigned round = links.begin();
  std::uint16_t* const table = links.entries.data();
  bool good = true;
  for (unsigned f = 0; f < facets_.size(); ++f) {
    const auto& [a, b, c] = facets_[f].local;
    for (const Index edge : {b * kStride + c, c * kStride + a, a * kStride + b}) {
      good &= (table[edge] ^ round) > Table::kFacetMask;  // true if no other facet has the edge in this direction
      table[edge] = static_cast<std::uint16_t>(round | f);
    }
  }
  for (unsigned f = 0; f < facets_.size(); ++f) {
    const Facet& facet = facets_[f];
    const auto& [a, b, c] = facet.local;
    const auto& other = kOthers[facet.slot];
    auto& neighbors = fresh_[f].neighbors;
    neighbors[facet.slot] = f;
    const unsigned across_a = table[c * kStride + b] ^ round, across_b = table[a * kStride + c] ^ round,
                   across_c = table[b * kStride + a] ^ round;
    good &= (across_a | across_b | across_c) <= Table::kFacetMask;
    neighbors[other[0]] = across_a & Table::kFacetMask;
    neighbors[other[1]] = across_b & Table::kFacetMask;
    neighbors[other[2]] = across_c & Table::kFacetMask;
  }
  return good;
}

// Links facets by lists of edges, without hashing: each edge that waits for its opposite is in the list of that of its
// corners that has fewer facets. These lists are short for most edges, because a planar graph has fewer than three
// edges per corner.
bool Cavity::link_by_lists() {
  const auto count = static_cast<Index>(facets_.size());
  const Facet* const facets = facets_.data();
  VoronoiVertex* const fresh = fresh_.data();
  // Ranks corners by their number of facets, then by their own number.
  ranks_.resize(local_points_.size());
  std::iota(ranks_.begin(), ranks_.end(), std::uint64_t{0});
  std::uint64_t* const ranks = ranks_.data();
  for (Index f = 0; f < count; ++f)
    for (const Index corner : facets[f].local) ranks[corner] += std::uint64_t{1} << 32;
  waiting_.assign(local_points_.size(), kNone);
  Index* const waiting = waiting_.data();
  links_.resize(std::size_t{3} * count);
  Link* const links = links_.data();
  Index end = 0, open = 0;
  for (Index f = 0; f < count; ++f) {
    const auto& local = facets[f].local;
    const auto& others = kOthers[facets[f].slot];
    fresh[f].neighbors[facets[f].slot] = f;
    for (unsigned n = 0; n < 3; ++n) {
      const Index from = local[(n + 1) % 3], to = local[(n + 2) % 3];
      const bool at_from = ranks[from] < ranks[to];
      const Index at = at_from ? from : to, far = at_from ? to : from;
      Index* link = &waiting[at];
      while (*link != kNone && links[*link].far != far) link = &links[*link].next;
      if (*link == kNone) {
        links[*link = end++] = {far, kNone, f, others[n], at_from};
        ++open;
        continue;
      }
      Link& other = links[*link];
      if (other.facet == kNone || other.outward == at_from) return false;
      fresh[f].neighbors[others[n]] = other.facet;
      fresh[other.facet].neighbors[other.slot] = f;
      other.facet = kNone;
      --open;
    }
  }
  return open == 0;
}

// The loop has no branches, because on grids nearly every insertion calls this.
bool Cavity::is_ball() {
  bool loses_point = false;
  const Index known_new = std::exchange(known_local(new_point_), Index{0});  // the new point does not count as lost
  for (const Index v : deleted_.items()) {
    const auto& [a, b, c, d] = workspace_.vertices[v].forming_points;
    const bool loses_a = known_local(a) == kNone, loses_b = known_local(b) == kNone, loses_c = known_local(c) == kNone,
               loses_d = known_local(d) == kNone;
    loses_point |= loses_a | loses_b | loses_c | loses_d;
  }
  known_local(new_point_) = known_new;
  if (loses_point) return false;
  // Each edge has two facets, and there are as many facets as one sphere through these points has. Several pieces, or a
  // piece with a handle, can have that number only if they touch themselves in points. So if there is one piece, it is
  // a sphere that does not touch itself. If the new point sees every facet, each piece covers its whole view at least
  // once, and all pieces together cover it exactly once, since tetrahedra do not overlap: so there is one piece. This
  // argument does not hold for facets at infinity.
  if (visible_ && known_local(kInfinitePoint) == kNone) return true;
  if (!are_local_points_on_boundary()) return false;
  return facets_.size() <= 64 ? is_one_small_piece() : is_one_piece();
}

// A point that was on the boundary at first may be inside the cavity after more vertices were deleted.
bool Cavity::are_local_points_on_boundary() {
  reached_.assign(local_points_.size(), false);
  for (const Facet& facet : facets_)
    for (const Index point : facet.local) reached_[point] = true;
  return std::find(reached_.begin(), reached_.end(), false) == reached_.end();
}

// A search from facet to neighbouring facets, with one bit for each facet. Two facets are handled at a time, so that a
// step need not wait for the one before.
bool Cavity::is_one_small_piece() const {
  std::array<std::uint64_t, 64> around;
  const auto bit = [](Index f) { return std::uint64_t{1} << f; };
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const auto& [a, b, c, d] = fresh_[f].neighbors;
    around[f] = bit(a) | bit(b) | bit(c) | bit(d);
  }
  std::uint64_t reached = 1;
  for (std::uint64_t waiting = 1; waiting != 0;) {
    const auto first = static_cast<unsigned>(std::countr_zero(waiting)),
               last = static_cast<unsigned>(63 - std::countl_zero(waiting));
    const std::uint64_t next = (around[first] | around[last]) & ~reached;
    reached |= next;
    waiting = (waiting & ~bit(first) & ~bit(last)) | next;
  }
  return reached == ~std::uint64_t{0} >> (64 - facets_.size());
}

bool Cavity::is_one_piece() {
  reached_.assign(facets_.size(), false);
  reached_[0] = true;
  queue_.resize(facets_.size() + 1);
  queue_[0] = 0;
  std::size_t count = 1;
  for (std::size_t i = 0; i < count; ++i) {
    const Index f = queue_[i];
    for (const std::uint8_t k : kOthers[facets_[f].slot]) {
      const Index next = fresh_[f].neighbors[k];
      queue_[count] = next;
      count += 1u - reached_[next];
      reached_[next] = true;
    }
  }
  return count == facets_.size();
}

// All spheres through a facet cut its plane in the same circle, and their centres lie on a line. The distance between
// the centres of the sphere through the new point and of the neighbour's sphere is the new point's power with respect
// to the neighbour's sphere, divided by twice the new point's height above the facet.
bool Cavity::doubts_are_harmless() const {
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const Facet& facet = facets_[f];
    const double power = workspace_.power(facet.outside, position_);
    if (!(power > 0) || facet.placing == Placing::shared) continue;  // nor do vertices at infinity matter
    if (workspace_.harmless(power, fresh_[f], facet.error_class)) continue;
    const Vector& a = from_new_[facet.local[0]].vector;
    const Vector& b = from_new_[facet.local[1]].vector;
    const Vector& c = from_new_[facet.local[2]].vector;
    const double height = a.dot(b.cross(c)) / (b - a).cross(c - a).norm();
    if (!(power <= 2 * workspace_.harmless_intrusion() * height)) return false;
  }
  return true;
}

Index Cavity::place_flat_vertices() {
  if (worst_ == Placing::good) return 0;
  Index coplanar = 0;
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    Facet& facet = facets_[f];
    coplanar += facet.placing == Placing::shared;
    if (facet.placing <= Placing::shared) continue;
    if (facet.placing == Placing::failed) facet.error_class = Workspace::kUnknownError;
    VoronoiVertex& vertex = fresh_[f];
    const VoronoiVertex& outside = workspace_.vertices[facet.outside];
    const auto corner = [&](unsigned i) -> const Point& {
      return workspace_.points[vertex.forming_points[kOthers[facet.slot][i]]];
    };
    if (vertex.forming_points[3] == kInfinitePoint) {
      vertex.radius = std::numeric_limits<double>::quiet_NaN();
      if (sharp_normal(position_, corner(0), corner(1), vertex.center)) continue;
      vertex.center = outside.center;
      ++coplanar;
      continue;
    }
    // With exact signs there are many such vertices, and most are soon deleted again. Until the end, a position that is
    // good enough for walks will do.
    const bool exact = workspace_.exact();
    if (exact && facet.placing == Placing::thin) continue;
    const auto circumcenter = exact ? rough_circumcenter : sharp_circumcenter;
    Vector relative;
    if (circumcenter(position_, corner(0), corner(1), corner(2), relative)) {
      vertex.center = position_ + relative;
    } else if (facet.placing == Placing::failed) {
      coplanar += !exact;
      // Takes the position of the neighbour that is not deleted; if that is at infinity, one far away in its direction.
      const bool bounded = outside.forming_points[3] != kInfinitePoint;
      vertex.center = bounded ? outside.center : Point(position_ + workspace_.far() * outside.center);
    }
    vertex.radius = (vertex.center - position_).squaredNorm();
  }
  return coplanar;
}

// Chooses the slots of the new vertices: first those of deleted vertices, which are in the cache.
void Cavity::choose_slots() {
  const auto reused = deleted_.items().first(std::min(deleted_.size(), facets_.size()));
  slots_.assign(reused.begin(), reused.end());
  const auto& free = territory_.whole() ? workspace_.free_vertices : *territory_.free_vertices;
  for (std::size_t i = 0; i < free.size() && slots_.size() < facets_.size(); ++i)
    slots_.push_back(free[free.size() - 1 - i]);
  for (auto next = static_cast<Index>(workspace_.vertices.size()); slots_.size() < facets_.size(); ++next)
    slots_.push_back(next);
}

Index Cavity::replace() {
  choose_slots();
  auto& free = territory_.whole() ? workspace_.free_vertices : *territory_.free_vertices;
  for (std::size_t i = facets_.size(); i < deleted_.size(); ++i) {
    workspace_.store(deleted_.items()[i], VoronoiVertex{}, 0);
    free.push_back(deleted_.items()[i]);
  }
  if (facets_.size() > deleted_.size()) {
    free.resize(free.size() - std::min(facets_.size() - deleted_.size(), free.size()));
  }
  const Index* const slots = slots_.data();
  Index last = slots[0];
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const Facet& facet = facets_[f];
    const VoronoiVertex& vertex = fresh_[f];
    if (slots_[f] == workspace_.vertices.size()) workspace_.append();
    // Neighbours are written directly to their place: loading a value as a whole right after storing it in parts is
    // slow.
    workspace_.store_but_neighbors(slots_[f], vertex, facet.error_class, facet.placing == Placing::shared);
    const auto& [a, b, c, d] = vertex.neighbors;
    auto& neighbors = workspace_.vertices[slots_[f]].neighbors;
    neighbors = {slots[a], slots[b], slots[c], slots[d]};
    neighbors[facet.slot] = facet.outside;
    workspace_.set_neighbor(facet.outside, facet.back, slots_[f]);
    if (facet.placing != Placing::failed && vertex.forming_points[3] != kInfinitePoint) last = slots_[f];
  }
  deleted_.clear();  // storing the new vertices has removed their marks
  return last;
}

}  // namespace orchard::detail
