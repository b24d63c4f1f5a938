// Questions about pairs of trees at many poses.
#include "orchard/runtime/contacts.h"
#include "orchard/runtime/time_of_impact.h"
#include "runtime_types.h"

namespace orchard::python {
namespace {

using runtime::Answer;

// A vector of results, field by field, as views that share it.
template <class Item>
std::shared_ptr<const std::vector<Item>> shared(std::vector<Item> items) {
  return std::make_shared<const std::vector<Item>>(std::move(items));
}

// A field of a field: `inner` of the member `outer` of each item.
template <class T, class Item, class Middle, class Field>
Array field_of(const std::shared_ptr<const std::vector<Item>>& items, Middle Item::*outer, Field Middle::*inner) {
  constexpr py::ssize_t columns = kColumns<T, Field>;
  const auto count = static_cast<py::ssize_t>(items->size());
  const T* data = items->empty() ? nullptr : reinterpret_cast<const T*>(&((items->front().*outer).*inner));
  if constexpr (columns == 1) return view(items, data, {count}, {sizeof(Item)});
  return view(items, data, {count, columns}, {sizeof(Item), sizeof(T)});
}

// Both bodies' poses of each question; one pose of a stands for all.
struct Placements {
  PoseRows a, b;
  Pose only_a = {};  // if there is but one
  std::size_t size() const { return b.size(); }
  Pose of_a(std::size_t i) const { return a.size() == 1 ? only_a : a[i]; }
};

Placements placements(const py::buffer& poses_a, const py::buffer& poses_b, bool wxyz) {
  Placements all{PoseRows(poses_a, wxyz), PoseRows(poses_b, wxyz)};
  if (all.a.size() != 1 && all.a.size() != all.b.size())
    throw py::value_error("poses_a: expected one pose, or as many as poses: " + std::to_string(all.b.size()));
  if (all.a.size() == 1) all.only_a = all.a[0];
  return all;
}

py::dict collide(const TreePointer& a, const TreePointer& b, const py::buffer& poses_a, const py::buffer& poses_b,
                 bool wxyz, std::uint64_t work, double seconds, bool level_by_level) {
  const Placements poses = placements(poses_a, poses_b, wxyz);
  const runtime::Budget budget = to_budget(work, seconds);
  const auto order = level_by_level ? runtime::Order::level_by_level : runtime::Order::exact_first;
  runtime::Workspace workspace;
  const runtime::TreePair pair(a->prepared, b->prepared);
  std::vector<runtime::Verdict> verdicts(poses.size());
  for_each(poses.size(), [&](std::size_t i) {
    verdicts[i] = runtime::collide(workspace, pair, poses.of_a(i), poses.b[i], budget, order);
  });
  const auto items = shared(std::move(verdicts));
  using V = runtime::Verdict;
  using C = runtime::Contact;
  py::dict result;
  result["answers"] = field<std::uint8_t>(items, &V::answer);
  result["separation_bounds"] = field<double>(items, &V::separation_bound);
  result["lower_bounds"] = field<double>(items, &V::lower_bound);
  result["points"] = field_of<double>(items, &V::contact, &C::center);
  result["normals"] = field_of<double>(items, &V::contact, &C::normal);
  result["triangles_a"] = field_of<std::uint32_t>(items, &V::contact, &C::triangle_a);
  result["triangles_b"] = field_of<std::uint32_t>(items, &V::contact, &C::triangle_b);
  result["levels"] = field<std::uint32_t>(items, &V::level);
  result["work"] = field<std::uint64_t>(items, &V::work);
  return result;
}

py::dict distance(const TreePointer& a, const TreePointer& b, const py::buffer& poses_a, const py::buffer& poses_b,
                  bool wxyz, double relative, double absolute) {
  const Placements poses = placements(poses_a, poses_b, wxyz);
  runtime::Workspace workspace;
  const runtime::TreePair pair(a->prepared, b->prepared);
  std::vector<runtime::Distance> distances(poses.size());
  for_each(poses.size(), [&](std::size_t i) {
    distances[i] =
        runtime::distance(workspace, pair, poses.of_a(i), poses.b[i], {.relative = relative, .absolute = absolute});
  });
  const auto items = shared(std::move(distances));
  using D = runtime::Distance;
  using P = runtime::DistanceQuery::Points;
  py::dict result;
  result["lower"] = field<double>(items, &D::lower);
  result["upper"] = field<double>(items, &D::upper);
  result["points_a"] = field_of<double>(items, &D::points, &P::on_a);
  result["points_b"] = field_of<double>(items, &D::points, &P::on_b);
  result["triangles_a"] = field_of<std::uint32_t>(items, &D::points, &P::triangle_a);
  result["triangles_b"] = field_of<std::uint32_t>(items, &D::points, &P::triangle_b);
  return result;
}

Array closer_than(const TreePointer& a, const TreePointer& b, const py::buffer& poses_a, const py::buffer& poses_b,
                  bool wxyz, double margin) {
  const Placements poses = placements(poses_a, poses_b, wxyz);
  runtime::Workspace workspace;
  const runtime::TreePair pair(a->prepared, b->prepared);
  std::vector<std::uint8_t> answers(poses.size());
  for_each(poses.size(), [&](std::size_t i) {
    answers[i] = static_cast<std::uint8_t>(runtime::closer_than(workspace, pair, poses.of_a(i), poses.b[i], margin));
  });
  return own(std::move(answers));
}

py::dict contacts(const TreePointer& a, const TreePointer& b, const py::buffer& poses_a, const py::buffer& poses_b,
                  bool wxyz, double margin, bool depth, std::uint32_t refinements) {
  const Placements poses = placements(poses_a, poses_b, wxyz);
  runtime::Workspace workspace;
  const runtime::TreePair pair(a->prepared, b->prepared);
  std::vector<runtime::Manifold> manifolds(poses.size());
  for_each(poses.size(), [&](std::size_t i) {
    manifolds[i] = runtime::contacts(workspace, pair, poses.of_a(i), poses.b[i],
                                     {.refinements = refinements, .depth = depth, .margin = margin});
  });
  const auto items = shared(std::move(manifolds));
  using M = runtime::Manifold;
  const M* first = items->data();
  const auto count = static_cast<py::ssize_t>(items->size());
  constexpr py::ssize_t points = runtime::kMaxContactPoints, point = sizeof(runtime::ContactPoint);
  py::dict result;
  result["answers"] = field<std::uint8_t>(items, &M::answer);
  result["counts"] = field<std::uint32_t>(items, &M::count);
  result["normals"] = field<double>(items, &M::normal);
  result["depths"] = field<double>(items, &M::depth);
  result["errors"] = field<double>(items, &M::error);
  result["complete"] = view(items, items->empty() ? nullptr : reinterpret_cast<const std::uint8_t*>(&first->complete),
                            {count}, {sizeof(M)});
  result["points"] = view(items, items->empty() ? nullptr : first->points[0].place.data(), {count, points, 3},
                          {sizeof(M), point, sizeof(double)});
  result["point_depths"] =
      view(items, items->empty() ? nullptr : &first->points[0].depth, {count, points}, {sizeof(M), point});
  return result;
}

py::dict time_of_impact(const TreePointer& a, const TreePointer& b, const py::buffer& from_a, const py::buffer& to_a,
                        const py::buffer& from_b, const py::buffer& to_b, bool wxyz, double tolerance, double margin,
                        std::uint64_t work) {
  const Placements from = placements(from_a, from_b, wxyz), to = placements(to_a, to_b, wxyz);
  if (from.a.size() != to.a.size() || from.size() != to.size())
    throw py::value_error("poses at the end: expected as many as at the beginning");
  const runtime::ImpactOptions options{.tolerance = tolerance, .margin = margin, .budget = to_budget(work, INFINITY)};
  runtime::Workspace workspace;
  const runtime::TreePair pair(a->prepared, b->prepared);
  std::vector<runtime::Impact> impacts(from.size());
  for_each(from.size(), [&](std::size_t i) {
    impacts[i] =
        runtime::time_of_impact(workspace, pair, runtime::travel_between(from.of_a(i), to.of_a(i), a->prepared.middle),
                                runtime::travel_between(from.b[i], to.b[i], b->prepared.middle), options);
  });
  const auto items = shared(std::move(impacts));
  using I = runtime::Impact;
  py::dict result;
  result["answers"] = field<std::uint8_t>(items, &I::answer);
  result["t0"] = field<double>(items, &I::t0);
  result["t1"] = field<double>(items, &I::t1);
  result["distances"] = field<double>(items, &I::distance);
  result["points_a"] = field<double>(items, &I::on_a);
  result["points_b"] = field<double>(items, &I::on_b);
  return result;
}

}  // namespace

void bind_pair_queries(py::module_& module) {
  module.def("collide", &collide);
  module.def("distance", &distance);
  module.def("closer_than", &closer_than);
  module.def("contacts", &contacts);
  module.def("time_of_impact", &time_of_impact);
}

}  // namespace orchard::python
