#pragma once
#include <cstddef>
#include <iterator>

#include "orchard/voronoi/diagram.h"

// The edges, faces and cells of a diagram, walked in place: nothing is allocated but one table of indices for the
// cells. Views refer to the diagram, which must outlive them and be consistent (validate()). All are input ranges:
//   for (const VoronoiFace& face : faces(diagram)) for (Index vertex : face) ...
namespace orchard {

// An edge of the diagram: two neighbouring vertices, at most one of them at infinity, and the three points whose cells
// meet along it.
struct VoronoiEdge {
  std::array<Index, 2> vertices;  // lower index first
  std::array<Index, 3> points;    // kInfinitePoint among them where both vertices are at infinity
};

// A face: the polygon between the cells of two points. Iterating gives its vertices in order, counter-clockwise seen
// from the second point, each once; an unbounded face has two neighbouring ones at infinity.
class VoronoiFace {
 public:
  class Iterator {
   public:
    using value_type = Index;
    using difference_type = std::ptrdiff_t;
    Iterator() = default;
    Index operator*() const { return at_; }
    Iterator& operator++();
    void operator++(int) { ++*this; }
    bool operator==(std::default_sentinel_t) const { return at_ == kNone; }

   private:
    friend class VoronoiFace;
    const VoronoiDiagram* diagram_ = nullptr;
    std::array<Index, 2> points_{};
    Index at_ = kNone, start_ = kNone;
    unsigned leave_ = 0;  // the neighbour that comes next
    unsigned pivot_ = 0;  // the forming point that it is reached around
  };

  VoronoiFace() = default;
  // The face between the cells of two forming points, given by their places in a vertex.
  VoronoiFace(const VoronoiDiagram& diagram, Index vertex, unsigned first, unsigned second);
  Index first_point() const { return points_[0]; }
  Index second_point() const { return points_[1]; }
  Iterator begin() const;
  std::default_sentinel_t end() const { return {}; }
  Index lowest_vertex() const;

 private:
  const VoronoiDiagram* diagram_ = nullptr;
  std::array<Index, 2> points_{};
  Index start_ = kNone;
  unsigned leave_ = 0, pivot_ = 0;
};

// Every edge once. O(n) for all.
class VoronoiEdges {
 public:
  class Iterator {
   public:
    using value_type = VoronoiEdge;
    using difference_type = std::ptrdiff_t;
    Iterator() = default;
    explicit Iterator(const VoronoiDiagram& diagram) : diagram_(&diagram) { settle(); }
    VoronoiEdge operator*() const;
    Iterator& operator++() {
      ++at_;
      settle();
      return *this;
    }
    void operator++(int) { ++*this; }
    bool operator==(std::default_sentinel_t) const { return at_ >= 4 * diagram_->vertices.size(); }

   private:
    void settle();
    const VoronoiDiagram* diagram_ = nullptr;
    std::size_t at_ = 0;  // 4 * vertex + neighbour
  };

  explicit VoronoiEdges(const VoronoiDiagram& diagram) : diagram_(&diagram) {}
  Iterator begin() const { return Iterator(*diagram_); }
  std::default_sentinel_t end() const { return {}; }

 private:
  const VoronoiDiagram* diagram_;
};
inline VoronoiEdges edges(const VoronoiDiagram& diagram) { return VoronoiEdges(diagram); }

// Faces that the given vertices are on, each at its lowest vertex, so that each comes once: of a whole diagram, or of
// one cell, which then is the first point's.
class VoronoiFaceRange {
  struct Source {
    const VoronoiDiagram* diagram = nullptr;
    const Index* vertices = nullptr;  // null: all
    std::size_t size = 0;
    Index point = kNone;
  };

 public:
  class Iterator {
   public:
    using value_type = VoronoiFace;
    using difference_type = std::ptrdiff_t;
    Iterator() = default;
    explicit Iterator(const Source& source) : source_(source) { settle(); }
    const VoronoiFace& operator*() const { return face_; }
    Iterator& operator++() {
      ++at_;
      settle();
      return *this;
    }
    void operator++(int) { ++*this; }
    bool operator==(std::default_sentinel_t) const { return at_ >= 6 * source_.size; }

   private:
    void settle();
    bool settle_here();
    Source source_;
    VoronoiFace face_;
    std::size_t at_ = 0;  // 6 * position in the range + pair of forming points
  };

  explicit VoronoiFaceRange(const VoronoiDiagram& diagram)
      : source_{&diagram, nullptr, diagram.vertices.size(), kNone} {}
  VoronoiFaceRange(const VoronoiDiagram& diagram, Index point, std::span<const Index> vertices)
      : source_{&diagram, vertices.data(), vertices.size(), point} {}
  Iterator begin() const { return Iterator(source_); }
  std::default_sentinel_t end() const { return {}; }

 private:
  Source source_;
};
// Every face once, in the order of its lowest vertex; O(n) for all. voronoi_faces() gives them as arrays.
inline VoronoiFaceRange faces(const VoronoiDiagram& diagram) { return VoronoiFaceRange(diagram); }

// The cells. Made in O(n) with one table of 4 + 4 * (vertices a cell) bytes a point; then nothing is allocated.
class VoronoiCells {
 public:
  explicit VoronoiCells(const VoronoiDiagram& diagram) : diagram_(&diagram), vertices_(vertices_of_points(diagram)) {}
  Index size() const { return vertices_.size(); }
  // Of a point's cell, ascending; none if the point was merged with another.
  std::span<const Index> vertices(Index point) const { return vertices_[point]; }
  // Each is the cell's face towards its second point.
  VoronoiFaceRange faces(Index point) const { return {*diagram_, point, vertices_[point]}; }
  bool bounded(Index point) const;

 private:
  const VoronoiDiagram* diagram_;
  Rows vertices_;
};

}  // namespace orchard
