#pragma once

// Every tolerance of the construction pipeline. Unless the name says otherwise, a tolerance is a fraction of the
// bounding radius R of the mesh, so that scaling a mesh by a power of two scales every result exactly.
namespace orchard::tolerance {

// Radians between the normals of neighbouring triangles that count as coplanar. Six decimals in a mesh file turn a
// small triangle's normal by about this much.
inline constexpr double kCoplanarAngle = 1e-4;

// A triangle whose two shorter edges span less than this times the product of their lengths is degenerate: such an area
// is nothing but the rounding of the cross product, about 5e-16.
inline constexpr double kNoArea = 1e-15;

// Corners of open edges that lie no farther apart than this are one corner: a program that writes each facet by itself
// writes the same place in different roundings, which differ by 1e-16 of the coordinates in doubles, by 1e-7 in floats
// (binary STL) and by up to 1e-5 in each coordinate in six digits. Nothing that is meant in a mesh is as small, and
// what is nearest is joined first.
inline constexpr double kJoin = 5e-5;

// Corners that are nearer than this differ by the rounding of doubles alone, whichever of them are nearest.
inline constexpr double kRounding = 1e-14;

// A filled hole that moves the surface by more than this is worth a warning: as much as the spheres of a first level
// are off, and more than a scan's gaps are deep.
inline constexpr double kFarFill = 0.02;

// A closed surface that encloses less than this times its area times R is flat: above the rounding of the sum over a
// hundred million triangles, below any solid's wall.
inline constexpr double kNoVolume = 1e-12;

// Two surface points nearer than this are one point: below it the Voronoi vertices between them mean nothing.
inline constexpr double kCoincidentPoints = 1e-7;

// How deep a point may lie in the sphere of a Voronoi vertex, or beyond a facet of the hull: a Voronoi diagram that is
// wrong by less cannot be told from a right one by anything that follows, and one on spheres and planes that rounding
// has bent is wrong by 1e-16 to 1e-12.
inline constexpr double kVoronoiIntrusion = 1e-9;

// Two Voronoi vertices nearer than this, and connected, are one medial vertex (dissertation 6.2.1). Round-off leaves
// degenerate vertices about 1e-9 apart on relaxed points; real neighbours are about a point spacing (1e-2) apart.
inline constexpr double kCoalesce = 1e-7;

// A medial ball's radius and its centre's distance to the surface are the same up to this: files have six to nine
// digits.
inline constexpr double kSameRadius = 1e-5;

// Of the diagonal: balls of which half are off the surface by more than this, as their distance to it less their
// radius, are in another frame or of another solid: the coarsest published axes are off by a tenth of that.
inline constexpr double kFrameError = 0.05;

// What a step from one vertex to the next takes off a proven distance to the surface: a thousand roundings.
inline constexpr double kClearance = 1e-12;

// Cosine of the angle between two neighbouring triangles above which the edge between them is no border of anything:
// 20 degrees, more than a scan's noise, less than a designed edge.
inline constexpr double kFlatEdgeCosine = 0.94;

// A Voronoi face that meets the surface along less than this only touches it: positions of Voronoi cells are no better.
inline constexpr double kTouch = 1e-9;

// How far a Voronoi face is moved, for the question where it meets the surface, to bring symmetric samples into general
// position: well above kTouch, far below any spacing of points.
inline constexpr double kGeneralPosition = 1e-8;

// How far a surface point may lie from the triangle that it names: a few roundings.
inline constexpr double kOnTriangle = 1e-12;

// What builders leave between a ball and what it must hold, so that the certificate's strict test passes: two balls
// that fit exactly are tangent, and tangent reads as uncovered.
inline constexpr double kCoverMargin = 1e-7;

// Spheres that leave a gap no wider than this where they meet are called tangent: text files with six decimals leave
// about as much between spheres that were computed to touch.
inline constexpr double kTangent = 1e-7;

// Width of the bounds on a sphere's inaccuracy: finer than any use of it, coarse enough to be fast.
inline constexpr double kInaccuracy = 1e-4;

}  // namespace orchard::tolerance
