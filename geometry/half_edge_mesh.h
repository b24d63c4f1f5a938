#pragma once
// With sanitizers on, GCC 12 warns of vectors that OpenMesh leaves uninitialised on purpose.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#pragma GCC diagnostic pop
#else
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#endif

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/mesh_check.h"

namespace orchard {

// OpenMesh in double precision. This header takes long to compile: it is meant for .cpp files that walk half-edges.
using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;

// The connectivity of a mesh; vertices and faces keep their numbers. Precondition: check_mesh() finds the mesh
// manifold, consistently oriented and without repeated corners. OpenMesh leaves out or duplicates elements of other
// meshes: Error is thrown if it did. O(n).
HalfEdgeMesh half_edge_mesh(const TriangleMesh& mesh);

// Whether OpenMesh counts the same edges, boundary and components as a report: an independent check.
bool agrees(const HalfEdgeMesh& half_edges, const MeshReport& report);

}  // namespace orchard
