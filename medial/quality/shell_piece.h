#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

// Pieces of the space below the surface along its normals (see shell_dents.h).
namespace orchard::detail {

// A place of the surface and a normal there that points into the solid (no longer than 1). `top` is the number of
// normals, from the place on, at which another place of the surface becomes as near.
struct NormalColumn {
  Point foot = Point::Zero();
  Vector inward = Vector::Zero();
  double top = 0;
};

// A part of the places below a face (three columns with one normal), an edge (two ends with two normals each) or a
// vertex (three normals at one foot).
struct ShellPiece {
  std::array<NormalColumn, 4> columns;
  std::size_t count = 0;
  double from = 0, to = 0;  // the range of depths
  double slack = 0;         // places are off by less than this because normals are rounded
  Index vertex = kNone;     // the vertex of the surface that it is below, if it is below one
  Index cell = 0;           // the cell of the reconstruction that was nearest to the piece from which this half was cut

  bool one_normal() const { return count == 3 && vertex == kNone; }
  std::span<const NormalColumn> in_use() const { return {columns.data(), count}; }
};

// The mean direction of the normals of a piece, and the smallest cosine between it and one of them.
struct MeanNormal {
  Vector direction;
  double cosine;
};

MeanNormal mean_normal(std::span<const NormalColumn> columns);

// Sets the tops of the columns from the place `other` of the surface: the multiple of the normal at which `other` is as
// near as the foot. Returns false if that is not bounded for all columns; the tops are then meaningless.
bool cut_at(std::span<NormalColumn> columns, const Point& other);

// Returns the corners of the convex cone of the normals, in order around a direction that all of them are near to.
std::vector<Vector> hull_of(std::span<const NormalColumn> columns, const Vector& direction);

constexpr std::size_t kMaxShellCorners = 96;

// Finds the corners of the part of the columns' hull that lies between their feet and tops and from piece.from to
// piece.to. Depth along the normals is linear there, and corners at either depth lie on lines from deeper to less deep
// ones. Returns their number, at most kMaxShellCorners.
std::size_t corners_of(const ShellPiece& piece, Point* corners);

// Halves a piece along its longest extent: the range of depths, a side, or the angle between normals.
std::array<ShellPiece, 2> halves_of(const ShellPiece& piece);

// Returns the largest depth of the columns of a piece.
double max_depth(const ShellPiece& piece);

}  // namespace orchard::detail
