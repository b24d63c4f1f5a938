#include "orchard/medial/segments.h"

#include <algorithm>
#include <limits>

#include "axis_complex.h"
#include "orchard/geometry/disjoint_sets.h"
#include "orchard/medial/prune.h"

namespace orchard {
namespace {

class Segmenter {
 public:
  Segmenter(const MedialAxis& axis, const SegmentOptions& options) : axis_(axis), options_(options), complex_(axis) {}

  MedialSegments run() {
    const Index edges = static_cast<Index>(complex_.edges().size());
    result_.of_edge.assign(edges, kNone);
    number_sheets(edges);
    number_curves(edges);
    measure();
    label_vertices();
    return std::move(result_);
  }

 private:
  bool touches(Index vertex) const { return axis_.radii[vertex] <= options_.touching; }
  bool counts(Index face) const {
    return face < axis_.faces.size() &&
           separation_angle(axis_, complex_.corners(face), complex_.points(face)) >= options_.angle;
  }

  // Joins faces across edges that do not touch the surface. A set becomes a sheet if it has a face away from the
  // surface.
  void number_sheets(Index edges) {
    const Index faces = complex_.face_count();
    std::vector<std::uint8_t> counted(faces), opens(faces, 0);
    for (Index face = 0; face < faces; ++face) counted[face] = counts(face) ? 1 : 0;
    DisjointSets sets(faces);
    std::vector<Index> at;
    for (Index edge = 0; edge < edges; ++edge) {
      const auto [a, b] = complex_.edges()[edge];
      if (touches(a) || touches(b)) continue;
      at.clear();
      for (const Index face : complex_.faces_at(edge)) {
        if (counted[face]) at.push_back(face);
      }
      if (at.size() == 2) sets.unite(at[0], at[1]);
    }
    for (Index face = 0; face < faces; ++face) {
      const auto corners = complex_.corners(face);
      const bool away = std::none_of(corners.begin(), corners.end(), [&](Index corner) { return touches(corner); });
      if (counted[face] && away) opens[sets.root(face)] = 1;
    }
    std::vector<Index> number(faces, kNone);
    for (Index face = 0; face < faces; ++face) {
      const Index first = sets.root(face);  // the lowest, so numbered already
      if (!counted[face] || !opens[first]) continue;
      number[face] = first == face ? open(true) : number[first];
    }
    hand_out_the_rest(number);
    for (Index face = 0; face < faces; ++face) {
      ++result_.segments[number[face]].cells;
      (face < axis_.faces.size() ? result_.of_face : result_.of_topology_face).push_back(number[face]);
    }
  }

  // Adds the other faces to sheets, in rings around the numbered faces. Faces that no ring reaches become sheets of
  // their own.
  void hand_out_the_rest(std::vector<Index>& number) {
    std::vector<Index> open_faces;
    for (Index face = 0; face < number.size(); ++face) {
      if (number[face] != kNone) open_faces.push_back(face);
    }
    Index next = 0;
    for (std::size_t i = 0;; ++i) {
      if (i == open_faces.size()) {
        while (next < number.size() && number[next] != kNone) ++next;
        if (next == number.size()) return;
        number[next] = open(true);
        open_faces.push_back(next);
      }
      for (const Index edge : complex_.sides(open_faces[i])) {
        for (const Index face : complex_.faces_at(edge)) {
          if (number[face] != kNone) continue;
          number[face] = number[open_faces[i]];
          open_faces.push_back(face);
        }
      }
    }
  }

  // Joins edges without faces at vertices where two of them and no other cells meet.
  void number_curves(Index edges) {
    DisjointSets sets(edges);
    const auto alone = [&](Index edge) { return complex_.faces_at(edge).empty(); };
    for (Index vertex = 0; vertex < axis_.size(); ++vertex) {
      const auto at = complex_.edges_at(vertex);
      if (at.size() == 2 && alone(at[0]) && alone(at[1])) sets.unite(at[0], at[1]);
    }
    for (Index edge = 0; edge < edges; ++edge) {
      if (!alone(edge)) continue;
      const Index first = sets.root(edge);
      result_.of_edge[edge] = first == edge ? open(false) : result_.of_edge[first];
      ++result_.segments[result_.of_edge[edge]].cells;
    }
  }

  Index open(bool has_faces) {
    result_.segments.push_back({.has_faces = has_faces,
                                .trunk = false,
                                .cells = 0,
                                .min_radius = std::numeric_limits<double>::infinity(),
                                .max_radius = 0});
    return static_cast<Index>(result_.segments.size() - 1);
  }

  Index segment_of_face(Index face) const {
    return face < axis_.faces.size() ? result_.of_face[face] : result_.of_topology_face[face - axis_.faces.size()];
  }

  void measure() {
    const auto add = [&](Index segment, Index vertex) {
      MedialSegments::Segment& s = result_.segments[segment];
      s.min_radius = std::min(s.min_radius, axis_.radii[vertex]);
      s.max_radius = std::max(s.max_radius, axis_.radii[vertex]);
    };
    for (Index face = 0; face < complex_.face_count(); ++face) {
      for (const Index corner : complex_.corners(face)) add(segment_of_face(face), corner);
    }
    for (Index edge = 0; edge < result_.of_edge.size(); ++edge) {
      if (result_.of_edge[edge] == kNone) continue;
      for (const Index vertex : complex_.edges()[edge]) add(result_.of_edge[edge], vertex);
    }
    for (auto& segment : result_.segments) segment.trunk = segment.min_radius > options_.touching;
  }

  void label_vertices() {
    std::vector<Index> at;
    for (Index vertex = 0; vertex < axis_.size(); ++vertex) {
      at.clear();
      for (const Index edge : complex_.edges_at(vertex)) {
        if (result_.of_edge[edge] != kNone) at.push_back(result_.of_edge[edge]);
        for (const Index face : complex_.faces_at(edge)) at.push_back(segment_of_face(face));
      }
      std::sort(at.begin(), at.end());
      Index best = kNone;
      std::ptrdiff_t max = 0;
      for (auto run = at.begin(); run != at.end();) {
        const auto end = std::upper_bound(run, at.end(), *run);
        if (end - run > max) {
          max = end - run;
          best = *run;
        }
        run = end;
      }
      result_.of_vertex.push_back(best);
    }
  }

  const MedialAxis& axis_;
  const SegmentOptions& options_;
  detail::AxisComplex complex_;
  MedialSegments result_;
};

}  // namespace

MedialSegments medial_segments(const MedialAxis& axis, const SegmentOptions& options) {
  return Segmenter(axis, options).run();
}

}  // namespace orchard
