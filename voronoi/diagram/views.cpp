#include "orchard/voronoi/views.h"

#include <algorithm>

namespace orchard {
namespace {

constexpr std::array<std::array<unsigned, 2>, 6> kPairs{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

unsigned slot_of(const std::array<Index, 4>& four, Index item) {
  return (four[1] == item) + 2u * (four[2] == item) + 3u * (four[3] == item);
}

// Whether (a, b, c, d) is an even permutation of 0 to 3.
bool even(unsigned a, unsigned b, unsigned c, unsigned d) {
  return ((a > b) + (a > c) + (a > d) + (b > c) + (b > d) + (c > d)) % 2 == 0;
}

}  // namespace

VoronoiFace::VoronoiFace(const VoronoiDiagram& diagram, Index vertex, unsigned first, unsigned second)
    : diagram_(&diagram), start_(vertex) {
  const auto& corner = diagram.vertices[vertex].forming_points;
  points_ = {corner[first], corner[second]};
  while (leave_ == first || leave_ == second) ++leave_;
  pivot_ = 6 - first - second - leave_;
  if (!even(first, second, leave_, pivot_)) std::swap(leave_, pivot_);
}

VoronoiFace::Iterator VoronoiFace::begin() const {
  Iterator it;
  it.diagram_ = diagram_;
  it.points_ = points_;
  it.at_ = it.start_ = start_;
  it.leave_ = leave_;
  it.pivot_ = pivot_;
  return it;
}

VoronoiFace::Iterator& VoronoiFace::Iterator::operator++() {
  const VoronoiVertex& from = diagram_->vertices[at_];
  const Index pivot_point = from.forming_points[pivot_];
  at_ = from.neighbors[leave_];
  if (at_ == start_) {
    at_ = kNone;
    return *this;
  }
  const auto& corner = diagram_->vertices[at_].forming_points;
  leave_ = slot_of(corner, pivot_point);
  pivot_ = 6 - slot_of(corner, points_[0]) - slot_of(corner, points_[1]) - leave_;
  return *this;
}

Index VoronoiFace::lowest_vertex() const {
  Index lowest = kNone;
  for (const Index vertex : *this) lowest = std::min(lowest, vertex);
  return lowest;
}

VoronoiEdge VoronoiEdges::Iterator::operator*() const {
  const auto vertex = static_cast<Index>(at_ / 4);
  const std::size_t left_out = at_ % 4;
  const VoronoiVertex& from = diagram_->vertices[vertex];
  VoronoiEdge edge{{vertex, from.neighbors[left_out]}, {}};
  for (std::size_t i = 0, k = 0; i < 4; ++i)
    if (i != left_out) edge.points[k++] = from.forming_points[i];
  return edge;
}

void VoronoiEdges::Iterator::settle() {
  const auto& vertices = diagram_->vertices;
  while (at_ < 4 * vertices.size() && vertices[at_ / 4].neighbors[at_ % 4] < at_ / 4) ++at_;
}

void VoronoiFaceRange::Iterator::settle() {
  while (at_ < 6 * source_.size && !settle_here()) ++at_;
}

bool VoronoiFaceRange::Iterator::settle_here() {
  const Index vertex = source_.vertices == nullptr ? static_cast<Index>(at_ / 6) : source_.vertices[at_ / 6];
  auto [first, second] = kPairs[at_ % 6];
  const auto& corner = source_.diagram->vertices[vertex].forming_points;
  if (corner[first] == kInfinitePoint || corner[second] == kInfinitePoint) return false;
  if (source_.point == kNone ? corner[first] > corner[second] : corner[second] == source_.point)
    std::swap(first, second);
  if (source_.point != kNone && corner[first] != source_.point) return false;
  face_ = VoronoiFace(*source_.diagram, vertex, first, second);
  return face_.lowest_vertex() == vertex;
}

bool VoronoiCells::bounded(Index point) const {
  return std::none_of(vertices_[point].begin(), vertices_[point].end(),
                      [&](Index v) { return diagram_->vertices[v].at_infinity(); });
}

}  // namespace orchard
