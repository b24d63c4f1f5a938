#pragma once
// GCC 12 takes the vectors that OpenMesh leaves uninitialised on purpose for a mistake, if the sanitizers are on.
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

// OpenMesh in double precision. A heavy header: for .cpp files that walk half-edges.
using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;

// The connectivity of a mesh that check_mesh() found to be manifold, consistently oriented and without repeated
// corners; vertices and faces keep their numbers. OpenMesh would leave out or duplicate elements of any other, so Error
// is thrown if it did. O(n).
HalfEdgeMesh half_edge_mesh(const TriangleMesh& mesh);

// Whether OpenMesh counts the same edges, boundary and components: a second opinion on a report.
bool agrees(const HalfEdgeMesh& half_edges, const MeshReport& report);

}  // namespace orchard
