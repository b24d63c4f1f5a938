// The module orchard_geometry._construction: from meshes to trees. It links parts of CGAL and is under the GPL.
#include "construction.h"

#include <tbb/global_control.h>

#include "errors.h"
#include "orchard/geometry/error.h"

namespace orchard::python {
namespace {

void translate(std::exception_ptr pointer) {  // NOLINT(performance-unnecessary-value-param): as pybind11 calls it
  try {
    if (pointer) std::rethrow_exception(pointer);
  } catch (const InputError& error) {
    set_error("MeshError", error.what());
  } catch (const Cancelled& error) {
    set_error("Cancelled", error.what());
  } catch (const Error& error) {
    set_error("OrchardError", error.what());
  }
}

// How many threads construction uses at most; 0: as many as there are processors.
void set_threads(std::size_t threads) {
  static std::unique_ptr<tbb::global_control> limit;
  limit.reset();
  if (threads > 0) limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, threads);
}

}  // namespace
}  // namespace orchard::python

PYBIND11_MODULE(_construction, module) {
  using namespace orchard::python;
  module.doc() = "From meshes to medial axes and sphere-trees: orchard's construction, under the GPL.";
  module.attr("version") = ORCHARD_VERSION;
  py::register_local_exception_translator(&translate);
  bind_array(module);
  module.def("set_threads", &set_threads);
  bind_mesh(module);
  bind_thickness(module);
  bind_voronoi(module);
  bind_medial(module);
  bind_spheretree(module);
  bind_sets(module);
  bind_robot(module);
  bind_applications(module);
}
