// The detector for Python: it keeps the states of bodies, and the trees that they are made of alive.
#include <optional>

#include "orchard/runtime/detector.h"
#include "runtime_types.h"

namespace orchard::python {
namespace {

using runtime::BodyId;
using runtime::PairEvent;

// A body as Python has it: the index and the generation in one number.
std::uint64_t number_of(const BodyId& body) { return std::uint64_t{body.generation} << 32 | body.index; }
BodyId body_of(std::uint64_t number) {
  return {static_cast<runtime::BodyIndex>(number), static_cast<std::uint32_t>(number >> 32)};
}

void require(bool held, const char* what) {
  if (!held) throw py::value_error(what);
}

class World {
 public:
  World(double time_step, double start, std::uint32_t steps_to_end)
      : detector_(runtime::DetectorOptions{.time_step = time_step, .start = start, .steps_to_end = steps_to_end}),
        now_(start) {
    require(detector_.valid(), "time_step: expected a number above 0, start: a finite one, steps_to_end: at least 1");
  }

  std::uint32_t add_tree(const TreePointer& tree) {
    const std::uint32_t shape = detector().add_shape(tree->packed);
    require(shape != runtime::kNoShape, "the tree has a fault");
    trees_.push_back(tree);
    return shape;
  }
  std::uint32_t checked(std::uint32_t shape) const {
    require(shape != runtime::kNoShape, "a shape needs finite numbers and no negative lengths");
    return shape;
  }
  std::uint32_t add_sphere(double radius, const Vec& center) { return checked(detector().add_sphere(radius, center)); }
  std::uint32_t add_capsule(const Vec& p, const Vec& q, double radius) {
    return checked(detector().add_capsule(p, q, radius));
  }
  std::uint32_t add_box(const Vec& half) { return checked(detector().add_box(half)); }

  std::uint64_t add_body(std::uint32_t shape, const py::buffer& pose, bool wxyz, const Vec& velocity,
                         double acceleration, double continuous_speed, const runtime::BodyFilter& filter) {
    runtime::BodyOptions options;
    options.filter = filter;
    options.continuous_speed = continuous_speed;
    return added(detector().add_body(
        shape, {.pose = to_single_pose(pose, wxyz), .velocity = velocity, .acceleration = acceleration}, options));
  }
  std::uint64_t add_static(std::uint32_t shape, const py::buffer& pose, bool wxyz, const runtime::BodyFilter& filter) {
    runtime::BodyOptions options;
    options.filter = filter;
    return added(detector().add_static({{.shape = shape}}, to_single_pose(pose, wxyz), options));
  }
  std::uint64_t add_half_space(const Vec& normal, double offset) {
    return added(detector().add_half_space(normal, offset));
  }

  void remove(std::uint64_t body) { known(detector().remove(body_of(body))); }
  void set_state(std::uint64_t body, const py::buffer& pose, bool wxyz, const Vec& velocity, double acceleration) {
    known(detector().set_state(
        body_of(body), {.pose = to_single_pose(pose, wxyz), .velocity = velocity, .acceleration = acceleration}));
  }
  void set_velocity(std::uint64_t body, const Vec& velocity) {
    known(detector().set_velocity(body_of(body), velocity));
  }
  py::dict state(std::uint64_t body) const {
    known(detector().contains(body_of(body)));
    const runtime::BodyState state = detector().state(body_of(body));
    py::dict result;
    result["rotation"] = state.pose.rotation;
    result["translation"] = state.pose.translation;
    result["velocity"] = std::array<double, 3>(state.velocity);
    return result;
  }

  py::dict step(double time, std::uint64_t work, double seconds) {
    require(time >= now_, "time: it only moves on, and is a number");
    runtime::Frame frame;
    {
      runtime::Detector& detector = this->detector();
      const Busy busy(busy_);
      const py::gil_scoped_release release;
      frame = detector.step(time, to_budget(work, seconds));
    }
    require(!frame.time_refused, "time: too many steps from 0");
    if (frame.out_of_memory) throw std::bad_alloc();
    now_ = time;
    events_.assign(frame.events.begin(), frame.events.end());
    py::dict result = events();
    result["time"] = frame.time;
    result["next_time"] = frame.next_time;
    result["steps"] = frame.steps;
    result["steps_left"] = frame.unfinished.steps_left;
    result["pairs"] = frame.pairs;
    result["certain"] = frame.certain;
    result["work"] = frame.work;
    return result;
  }

  py::dict manifold(std::size_t event) {
    require(event < events_.size(), "event: the last step has not so many");
    const runtime::Manifold found = detector().manifold(events_[event]);
    py::dict result;
    std::vector<Vec> points;
    std::vector<double> depths;
    for (std::uint32_t i = 0; i < found.count; ++i) {
      points.push_back(found.points[i].place);
      depths.push_back(found.points[i].depth);
    }
    result["answer"] = static_cast<int>(found.answer);
    result["points"] = own_rows<double>(std::move(points));
    result["point_depths"] = own(std::move(depths));
    result["normal"] = found.normal;
    result["depth"] = found.depth;
    return result;
  }

  py::object cast_ray(const Vec& origin, const Vec& direction, double longest) {
    return to_python(detector().cast_ray({origin, direction, longest}));
  }
  py::object nearest(const Vec& point, double limit) { return to_python(detector().nearest(point, limit)); }
  std::vector<std::uint64_t> touching_sphere(const Vec& center, double radius) {
    std::vector<std::uint64_t> bodies;
    for (const BodyId& body : detector().touching_sphere(center, radius)) bodies.push_back(number_of(body));
    return bodies;
  }

  std::size_t size() const { return detector().size(); }
  double now() const { return now_; }

 private:
  // What another thread is asking is left alone: its step runs without the GIL.
  runtime::Detector& detector() {
    require_free(busy_);
    return detector_;
  }
  const runtime::Detector& detector() const {
    require_free(busy_);
    return detector_;
  }

  static std::uint64_t added(const BodyId& body) {
    require(body != runtime::kNoBody, "a body needs a shape of this detector, a rigid pose and finite numbers");
    return number_of(body);
  }
  static void known(bool done) { require(done, "there is no such body, or its state is not valid"); }

  static py::object to_python(const std::optional<runtime::WorldPoint>& found) {
    if (!found) return py::none();
    py::dict result;
    result["body"] = number_of(found->body);
    result["distance"] = found->distance;
    result["point"] = std::array<double, 3>(found->point);
    return result;
  }

  py::dict events() const {
    std::vector<std::uint8_t> changes, answers;
    std::vector<std::uint64_t> a, b;
    std::vector<double> times, bounds, impacts;
    std::vector<Vec> points, normals;
    for (const PairEvent& event : events_) {
      changes.push_back(static_cast<std::uint8_t>(event.change));
      answers.push_back(static_cast<std::uint8_t>(event.verdict.answer));
      a.push_back(number_of(event.a));
      b.push_back(number_of(event.b));
      times.push_back(event.time);
      bounds.push_back(event.verdict.separation_bound);
      impacts.push_back(event.impact_from);
      points.push_back(event.verdict.contact.center);
      normals.push_back(event.verdict.contact.normal);
    }
    py::dict result;
    result["changes"] = own(std::move(changes));
    result["answers"] = own(std::move(answers));
    result["a"] = own(std::move(a));
    result["b"] = own(std::move(b));
    result["times"] = own(std::move(times));
    result["separation_bounds"] = own(std::move(bounds));
    result["impact_times"] = own(std::move(impacts));
    result["points"] = own_rows<double>(std::move(points));
    result["normals"] = own_rows<double>(std::move(normals));
    return result;
  }

  std::vector<TreePointer> trees_;  // before the detector, which refers to them
  runtime::Detector detector_;
  std::vector<PairEvent> events_;
  double now_;
  bool busy_ = false;
};

runtime::BodyFilter to_filter(std::uint32_t category, std::uint32_t mask, std::int32_t group) {
  return {.category = category, .mask = mask, .group = group};
}

}  // namespace

void bind_detector(py::module_& module) {
  py::class_<World>(module, "Detector")
      .def(py::init<double, double, std::uint32_t>())
      .def("add_tree", &World::add_tree)
      .def("add_sphere", &World::add_sphere)
      .def("add_capsule", &World::add_capsule)
      .def("add_box", &World::add_box)
      .def("add_body",
           [](World& world, std::uint32_t shape, const py::buffer& pose, bool wxyz, const Vec& velocity,
              double acceleration, double continuous_speed, std::uint32_t category, std::uint32_t mask,
              std::int32_t group) {
             return world.add_body(shape, pose, wxyz, velocity, acceleration, continuous_speed,
                                   to_filter(category, mask, group));
           })
      .def("add_static",
           [](World& world, std::uint32_t shape, const py::buffer& pose, bool wxyz, std::uint32_t category,
              std::uint32_t mask,
              std::int32_t group) { return world.add_static(shape, pose, wxyz, to_filter(category, mask, group)); })
      .def("add_half_space", &World::add_half_space)
      .def("remove", &World::remove)
      .def("set_state", &World::set_state)
      .def("set_velocity", &World::set_velocity)
      .def("state", &World::state)
      .def("step", &World::step)
      .def("manifold", &World::manifold)
      .def("cast_ray", &World::cast_ray)
      .def("nearest", &World::nearest)
      .def("touching_sphere", &World::touching_sphere)
      .def("size", &World::size)
      .def("now", &World::now);
}

}  // namespace orchard::python
