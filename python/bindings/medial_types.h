#pragma once
#include "construction.h"
#include "orchard/medial/build.h"
#include "orchard/medial/structure.h"

namespace orchard::python {

// A medial axis of a solid: what was built, or what any system made, as a medial mesh.
struct Axis {
  SurfacePointer surface;  // the solid that it is of; of the outside: the space around it
  MedialMesh mesh;
  MedialStructure structure;
  // Of an axis that was built here: everything that led to it. Its own `axis` has the vertices of `mesh` first.
  std::shared_ptr<const MedialBuild> build;
  MedialBuildOptions options;
  std::vector<std::string> notes;  // of one that was read: what was decided or left out

  static std::shared_ptr<Axis> of_mesh(const SurfacePointer& surface, MedialMesh mesh);
};
using AxisPointer = std::shared_ptr<Axis>;

// The options of the command line, by name, as the library has them. Throws ValueError as the program says it.
MedialBuildOptions to_build_options(const Tuning& tuning);

// The same axis without what only a build knows, for functions that take a MedialAxis for its complex alone.
MedialAxis complex_of(const MedialMesh& mesh);

// Points of Python's, moved to the nearest place of the surface.
SurfaceSampling own_sampling(const Surface& surface, const py::buffer& points);

void bind_medial_measures(py::module_& module);

}  // namespace orchard::python
