#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

// What lies below the surface along its normals, in parts (see shell_dents.h).
namespace orchard::detail {

// A place of the surface, a normal there that points into the solid (no longer than 1), and how many times the normal
// from it on another place of the surface is as near.
struct NormalColumn {
  Point foot = Point::Zero();
  Vector inward = Vector::Zero();
  double top = 0;
};

// Part of the places below a face (three columns with one normal), an edge (two ends times two normals) or a vertex
// (three normals at one foot).
struct ShellPiece {
  std::array<NormalColumn, 4> columns;
  std::size_t count = 0;
  double from = 0, to = 0;  // depths: of these columns, as far as they go
  double slack = 0;         // places are off by less, normals being rounded
  Index vertex = kNone;     // of the surface, if below one
  Index cell = 0;           // of the reconstruction, that was nearest to the piece that this is a half of

  bool one_normal() const { return count == 3 && vertex == kNone; }
  std::span<const NormalColumn> in_use() const { return {columns.data(), count}; }
};

// A normal in the middle of those of a piece, and the least cosine to it.
struct MeanNormal {
  Vector direction;
  double cosine;
};

MeanNormal mean_normal(std::span<const NormalColumn> columns);

// Sets the tops of columns: how many times its normal from its foot the place `other` of the surface is as near. False,
// and what tops there are is of no use, if that is not bounded for all.
bool cut_at(std::span<NormalColumn> columns, const Point& other);

// The corners of the convex cone of normals, in turn around a direction that all of them are near to.
std::vector<Vector> hull_of(std::span<const NormalColumn> columns, const Vector& direction);

constexpr std::size_t kMaxShellCorners = 96;

// The corners of what is in the hull of columns, between their feet and tops, from piece.from to piece.to. Depth along
// normals is linear there; corners at either are on ways from what is deeper to what is not. At most kMaxShellCorners;
// returns how many.
std::size_t corners_of(const ShellPiece& piece, Point* corners);

// Halves of what is longest: the depth, a side, or the angle between normals.
std::array<ShellPiece, 2> halves_of(const ShellPiece& piece);

// The largest depth that columns of a piece go to.
double max_depth(const ShellPiece& piece);

}  // namespace orchard::detail
