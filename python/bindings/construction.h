#pragma once
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "arrays.h"
#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/spheretree/sphere_audit.h"
#include "watch.h"

namespace orchard::python {

// Surfaces are immutable, so threads and results share them.
using SurfacePointer = std::shared_ptr<Surface>;

// Tuning options by the names of the command line, and their values as text; apps/medial/medial_tuning.h.
using Tuning = std::map<std::string, std::string>;

// A long call: work(progress) without the GIL. Throws what Ctrl-C or the callback threw, and Cancelled if that said no.
template <class Work>
auto watched(py::object callback, const Work& work) {
  Watch watch(std::move(callback));
  try {
    const py::gil_scoped_release release;
    return work(Progress([&watch](std::string_view stage, double done) { return watch.report(stage, done); }));
  } catch (const Cancelled&) {
    watch.rethrow();
    throw;
  }
}

// A place in a table of names, as "tightened" in {"tightened", "merging"}; ValueError if it is not there.
template <class Value>
Value named(const char* option, const std::string& name, const std::vector<std::pair<const char*, Value>>& names) {
  std::string all;
  for (const auto& [key, value] : names) {
    if (name == key) return value;
    all += (all.empty() ? "" : ", ") + std::string(key);
  }
  throw py::value_error(std::string(option) + ": '" + name + "' is not one of " + all);
}

inline std::vector<Point> to_points(const py::buffer& rows) { return Input<double>(rows, 3).rows<Point>(); }
// Rows of x y z r.
std::vector<std::array<double, 4>> sphere_rows(const std::vector<Sphere>& spheres);
py::dict audit_to_python(const SphereAudit& audit);
inline std::array<double, 3> to_array(const Point& point) { return {point.x(), point.y(), point.z()}; }

void bind_mesh(py::module_& module);
void bind_thickness(py::module_& module);
void bind_voronoi(py::module_& module);
void bind_medial(py::module_& module);
void bind_spheretree(py::module_& module);
void bind_sets(py::module_& module);
void bind_robot(py::module_& module);
void bind_applications(py::module_& module);

}  // namespace orchard::python
