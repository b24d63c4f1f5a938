// Questions about points and rays beside one placed tree.
#include "orchard/runtime/shape_query.h"
#include "runtime_types.h"

namespace orchard::python {
namespace {

void require_triangles(const Tree& tree) {
  if (tree.packed.triangles.empty())
    throw py::value_error("the tree has no triangles, which rays and points are asked about");
}

py::dict cast_rays(const TreePointer& tree, const py::buffer& origins, const py::buffer& directions, double longest,
                   const py::buffer& pose_row, bool wxyz) {
  require_triangles(*tree);
  const Pose pose = to_single_pose(pose_row, wxyz);
  const Input<double> from(origins, 3), along(directions, 3);
  if (from.size() != along.size()) throw py::value_error("directions: expected as many as origins");
  const std::size_t count = from.size();
  std::vector<double> distances(count, INFINITY);
  std::vector<Vec> points(count, {NAN, NAN, NAN});
  std::vector<std::int64_t> triangles(count, -1);
  for_each(count, [&](std::size_t i) {
    const auto hit = runtime::cast_ray(tree->packed, pose, to_vec(from.row(i)), to_vec(along.row(i)), longest);
    if (!hit || hit->triangle == runtime::kNoTriangle) return;
    distances[i] = hit->along;
    points[i] = hit->point;
    triangles[i] = hit->triangle;
  });
  py::dict result;
  result["along"] = own(std::move(distances));
  result["points"] = own_rows<double>(std::move(points));
  result["triangles"] = own(std::move(triangles));
  return result;
}

py::dict nearest_points(const TreePointer& tree, const py::buffer& centers, double limit, const py::buffer& pose_row,
                        bool wxyz, bool with_sign) {
  require_triangles(*tree);
  const Pose pose = to_single_pose(pose_row, wxyz);
  const Input<double> queries(centers, 3);
  const std::size_t count = queries.size();
  std::vector<double> distances(count);
  std::vector<Vec> points(count, {NAN, NAN, NAN}), normals(with_sign ? count : 0);
  std::vector<std::int64_t> triangles(count, -1);
  for_each(count, [&](std::size_t i) {
    runtime::SurfacePoint point;
    if (with_sign) {
      const runtime::SignedPoint found =
          runtime::signed_nearest_point(tree->packed, pose, to_vec(queries.row(i)), limit);
      point = found.surface;
      normals[i] = found.normal;
    } else {
      point = runtime::nearest_point(tree->packed, pose, to_vec(queries.row(i)), limit);
    }
    distances[i] = point.distance;
    if (point.triangle == runtime::kNoTriangle) return;
    points[i] = point.point;
    triangles[i] = point.triangle;
  });
  py::dict result;
  result["distances"] = own(std::move(distances));
  result["points"] = own_rows<double>(std::move(points));
  result["triangles"] = own(std::move(triangles));
  if (with_sign) result["normals"] = own_rows<double>(std::move(normals));
  return result;
}

Array contains(const TreePointer& tree, const py::buffer& points, const py::buffer& pose_row, bool wxyz) {
  require_triangles(*tree);
  const Pose pose = to_single_pose(pose_row, wxyz);
  const Input<double> queries(points, 3);
  std::vector<std::uint8_t> inside(queries.size());
  for_each(queries.size(),
           [&](std::size_t i) { inside[i] = runtime::contains(tree->packed, pose, to_vec(queries.row(i))) ? 1 : 0; });
  return own(std::move(inside));
}

}  // namespace

void bind_shape_queries(py::module_& module) {
  module.def("cast_rays", &cast_rays);
  module.def("nearest_points", &nearest_points);
  module.def("contains", &contains);
}

}  // namespace orchard::python
