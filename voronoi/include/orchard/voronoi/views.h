#pragma once
#include <cstddef>
#include <iterator>

#include "orchard/voronoi/diagram.h"

// Ranges over the edges, faces and cells of a diagram. They need no memory except one table of indices for the cells. A
// view refers to its diagram, which must outlive the view and be consistent (validate()). All views are input ranges:
//   for (const VoronoiFace& face : faces(diagram)) for (Index vertex : face) ...
namespace orchard {

// An edge of a diagram: two neighbouring vertices, and the three points whose cells meet along the edge.
struct VoronoiEdge {
  std::array<Index, 2> vertices;  // The lower index comes first.
  // If both vertices are at infinity, one of the points is kInfinitePoint.
  std::array<Index, 3> points;
};

// The polygon between the cells of two points. Iteration visits each vertex once, in order, counter-clockwise seen from
// the second point. An unbounded face contains two neighbouring vertices at infinity.
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
    unsigned leave_ = 0;  // The neighbour that comes next.
    unsigned pivot_ = 0;  // The forming point around which it is reached.
  };

  VoronoiFace() = default;
  // Constructs the face between the cells of two forming points of a vertex. `first` and `second` are their positions
  // in VoronoiVertex::forming_points, 0..3.
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

// A range that visits every edge once. Takes O(n) for all edges.
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
// Returns the edges of a diagram.
inline VoronoiEdges edges(const VoronoiDiagram& diagram) { return VoronoiEdges(diagram); }

// A range of faces, each of which is visited once, at its lowest vertex. The range contains all faces of a diagram, or
// the faces of one cell; then the cell's point is the first point of each face.
class VoronoiFaceRange {
  struct Source {
    const VoronoiDiagram* diagram = nullptr;
    const Index* vertices = nullptr;  // Null stands for all vertices.
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
// Returns the faces of a diagram, in the order of their lowest vertices. Takes O(n) for all. voronoi_faces() returns
// the same faces as arrays.
inline VoronoiFaceRange faces(const VoronoiDiagram& diagram) { return VoronoiFaceRange(diagram); }

// The cells of a diagram. The constructor takes O(n) and allocates one table of 4 + 4 * (vertices of the cell) bytes
// for each point; the other functions allocate no memory.
class VoronoiCells {
 public:
  explicit VoronoiCells(const VoronoiDiagram& diagram) : diagram_(&diagram), vertices_(vertices_of_points(diagram)) {}
  Index size() const { return vertices_.size(); }
  // Returns the vertices of a point's cell, ascending. There are none if the point was merged with another.
  std::span<const Index> vertices(Index point) const { return vertices_[point]; }
  // Returns the faces of a cell. The first point of each face is `point`, and the second one is that of the adjacent
  // cell.
  VoronoiFaceRange faces(Index point) const { return {*diagram_, point, vertices_[point]}; }
  // Returns whether the cell has no vertex at infinity.
  bool bounded(Index point) const;

 private:
  const VoronoiDiagram* diagram_;
  Rows vertices_;
};

}  // namespace orchard
