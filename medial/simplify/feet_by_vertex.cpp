#include "feet_by_vertex.h"

namespace orchard::detail {
namespace {

// Updates the cell of a foot after vertex b has been contracted into a.
void follow(Foot& foot, Index a, Index b) {
  std::size_t of_a = 3, of_b = 3;
  for (std::size_t k = 0; k < 3; ++k) {
    if (foot.corners[k] == a && of_a == 3) of_a = k;
    if (foot.corners[k] == b && of_b == 3) of_b = k;
  }
  if (of_b == 3) return;
  for (Index& corner : foot.corners) {
    if (corner == b) corner = a;
  }
  if (of_a == 3) return;
  // Cells smaller than triangles repeat their first corner.
  Index other = kNone;
  double share = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (foot.corners[k] == a) continue;
    other = foot.corners[k];
    share = foot.weights[k];
  }
  foot.corners = {a, other == kNone ? a : other, a};
  foot.weights = {1 - share, share, 0};
}

template <class Change>
void visit_corners(const Foot& foot, const Change& change) {
  const auto& [a, b, c] = foot.corners;
  change(a);
  if (b != a) change(b);
  if (c != a && c != b) change(c);
}

}  // namespace

FeetByVertex::FeetByVertex(const ContractibleMesh& mesh, std::span<const FitSample> samples, Assignment& feet)
    : mesh_(mesh), samples_(samples), feet_(feet), at_(mesh.size()) {
  for (Index i = 0; i < samples.size(); ++i) enter(i);
}

std::vector<Index> FeetByVertex::at_either(Index a, Index b) const {
  std::vector<Index> result;
  result.reserve(at_[a].size() + at_[b].size());
  std::set_union(at_[a].begin(), at_[a].end(), at_[b].begin(), at_[b].end(), std::back_inserter(result));
  return result;
}

void FeetByVertex::set_foot(Index sample, const Foot& foot) {
  leave(sample);
  feet_.feet[sample] = foot;
  enter(sample);
}

void FeetByVertex::contract(Index a, Index b, std::span<const Index> samples) {
  for (const Index i : samples) {
    leave(i);
    Foot& foot = feet_.feet[i];
    follow(foot, a, b);
    foot = walk_to_foot(mesh_, samples_[i].position, foot).below(samples_[i].depth);
    enter(i);
  }
}

void FeetByVertex::enter(Index sample) {
  visit_corners(feet_.feet[sample],
                [&](Index v) { at_[v].insert(std::lower_bound(at_[v].begin(), at_[v].end(), sample), sample); });
}

void FeetByVertex::leave(Index sample) {
  visit_corners(feet_.feet[sample],
                [&](Index v) { at_[v].erase(std::lower_bound(at_[v].begin(), at_[v].end(), sample)); });
}

}  // namespace orchard::detail
