// The broad phase for Python: it keeps what is known of each body and flies it straight on until it is told otherwise.
#include <optional>

#include "orchard/runtime/broad_queries.h"
#include "runtime_types.h"

namespace orchard::python {
namespace {

using runtime::BodyId;
using runtime::BodyIndex;
using runtime::Motion;

class Bodies {
 public:
  explicit Bodies(double time_step, double start)
      : options_{.time_step = time_step, .start = start}, now_(start), world_(source(), options_), queries_(world_) {
    if (!runtime::is_valid(options_))
      throw py::value_error("time_step: expected a number above 0, and start: a finite number");
  }
  Bodies(const Bodies&) = delete;
  Bodies& operator=(const Bodies&) = delete;

  // A body for each row: x y z, vx vy vz, radius, acceleration, drift, expiry in seconds from now.
  std::vector<BodyIndex> add(const py::buffer& rows, bool fixed, const runtime::BodyFilter& filter) {
    const Input<double> input(rows, kColumns);
    std::vector<BodyIndex> added;
    for (std::size_t i = 0; i < input.size(); ++i) {
      const Motion motion = to_motion(input.row(i), i);
      const BodyId id = fixed ? world().add_static(motion, 0, filter) : world().add(0, filter);
      if (id == runtime::kNoBody) throw py::value_error("bodies: there are too many");
      if (states_.size() <= id.index) states_.resize(id.index + 1);
      states_[id.index] = {motion, now_, id, fixed};
      added.push_back(id.index);
    }
    return added;
  }

  void update(const py::buffer& bodies, const py::buffer& rows, bool keeps_bounds) {
    const Input<std::uint32_t> indices(bodies, 0);
    const Input<double> input(rows, kColumns);
    if (indices.size() != input.size()) throw py::value_error("bodies: expected as many as positions");
    for (std::size_t i = 0; i < indices.size(); ++i) {
      State& state = known(indices[i]);
      const Motion motion = to_motion(input.row(i), i);
      state.motion = motion;
      state.time = now_;
      if (state.fixed) {
        world().move_static(state.id, motion);
      } else if (!keeps_bounds) {
        world().cancel(state.id);
      }
    }
  }

  void remove(const py::buffer& bodies) {
    const Input<std::uint32_t> indices(bodies, 0);
    for (std::size_t i = 0; i < indices.size(); ++i) {
      State& state = known(indices[i]);
      world().remove(state.id);
      state.id = runtime::kNoBody;
    }
  }

  // Until the first step with pairs, up to `time`.
  py::dict advance(double time) {
    if (!(time >= now_)) throw py::value_error("time: expected a finite number that is not below the present time");
    runtime::Advance found{};
    {
      runtime::BroadPhase& world = this->world();
      const Busy busy(busy_);
      const py::gil_scoped_release release;
      found = world.advance(time);
    }
    if (found.time_refused) throw py::value_error("time: too many steps from 0");
    now_ = std::max(now_, std::min(time, found.pairs.empty() ? time : found.time));
    std::vector<std::array<std::uint32_t, 2>> pairs;
    pairs.reserve(found.pairs.size());
    for (const runtime::BodyPair& pair : found.pairs) pairs.push_back({pair.a, pair.b});
    py::dict result;
    result["time"] = found.time;
    result["pairs"] = own_rows<std::uint32_t>(std::move(pairs));
    result["refused"] = own(std::vector<std::uint32_t>(found.refused.begin(), found.refused.end()));
    return result;
  }

  std::optional<std::pair<BodyIndex, double>> cast_ray(const Vec& origin, const Vec& direction, double longest) {
    const auto hit = queries().first_hit({origin, direction, longest});
    if (queries().refused()) throw py::value_error("a ray needs finite numbers and a direction other than 0");
    if (!hit) return std::nullopt;
    return std::pair{hit->body, hit->along};
  }
  Array touching_sphere(const Vec& center, double radius) {
    const auto found = queries().touching_sphere(center, radius);
    if (queries().refused()) throw py::value_error("a sphere needs finite numbers and no negative radius");
    return own(std::vector<std::uint32_t>(found.begin(), found.end()));
  }
  Array touching_box(const Vec& lower, const Vec& upper) {
    const auto found = queries().touching_box(lower, upper);
    if (queries().refused()) throw py::value_error("a box needs finite numbers and lower corners below upper ones");
    return own(std::vector<std::uint32_t>(found.begin(), found.end()));
  }
  std::vector<std::pair<BodyIndex, double>> nearest(const Vec& point, std::size_t k) {
    std::vector<std::pair<BodyIndex, double>> result;
    for (const runtime::NearBody& near : queries().nearest(point, k)) result.emplace_back(near.body, near.distance);
    return result;
  }

  std::size_t size() const { return world().size(); }
  double now() const { return now_; }

 private:
  static constexpr py::ssize_t kColumns = 10;
  struct State {
    Motion motion;
    double time = 0;  // that the motion is of
    BodyId id;
    bool fixed = false;
  };

  // What another thread is asking is left alone: its advance() runs without the GIL.
  runtime::BroadPhase& world() {
    require_free(busy_);
    return world_;
  }
  const runtime::BroadPhase& world() const {
    require_free(busy_);
    return world_;
  }
  runtime::BodyQueries& queries() {
    require_free(busy_);
    return queries_;
  }

  // The motion of a body goes straight on from when it was given.
  runtime::MotionSource source() {
    return [this](double time, std::span<const BodyIndex> bodies, std::span<Motion> motions) {
      for (std::size_t i = 0; i < bodies.size(); ++i) {
        const State& state = states_[bodies[i]];
        motions[i] = state.motion;
        motions[i].position = state.motion.position + (time - state.time) * state.motion.velocity;
        motions[i].expiry = std::max(state.motion.expiry, time);
      }
    };
  }

  Motion to_motion(const double* row, std::size_t number) const {
    const Motion motion{.position = to_vec(row),
                        .velocity = to_vec(row + 3),
                        .radius = row[6],
                        .acceleration = row[7],
                        .drift = row[8],
                        .expiry = now_ + row[9]};
    if (!runtime::is_valid(motion))
      throw py::value_error("body " + std::to_string(number) +
                            ": positions and velocities are finite, radii and bounds not negative");
    return motion;
  }

  State& known(BodyIndex index) {
    if (index >= states_.size() || !world().contains(states_[index].id))
      throw py::value_error("there is no body " + std::to_string(index));
    return states_[index];
  }

  runtime::BroadPhaseOptions options_;
  double now_;
  std::vector<State> states_;
  runtime::BroadPhase world_;
  runtime::BodyQueries queries_;
  bool busy_ = false;
};

}  // namespace

void bind_broad_phase(py::module_& module) {
  py::class_<Bodies>(module, "BroadPhase")
      .def(py::init<double, double>())
      .def("add",
           [](Bodies& bodies, const py::buffer& rows, bool fixed, std::uint32_t category, std::uint32_t mask,
              std::int32_t group) {
             return own(bodies.add(rows, fixed, {.category = category, .mask = mask, .group = group}));
           })
      .def("update", &Bodies::update)
      .def("remove", &Bodies::remove)
      .def("advance", &Bodies::advance)
      .def("cast_ray", &Bodies::cast_ray)
      .def("touching_sphere", &Bodies::touching_sphere)
      .def("touching_box", &Bodies::touching_box)
      .def("nearest", &Bodies::nearest)
      .def("size", &Bodies::size)
      .def("now", &Bodies::now);
}

}  // namespace orchard::python
