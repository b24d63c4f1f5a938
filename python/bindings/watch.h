#pragma once
#include <pybind11/pybind11.h>

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

// Long calls: they run without the GIL, report how far they are, and stop when Ctrl-C is pressed.
namespace orchard::python {

namespace py = pybind11;

// What a long call asks from time to time, from the thread that made it and without the GIL.
class Watch {
 public:
  // `callback` is None, or is called with a stage and the fraction of it that is done; False stops the call.
  explicit Watch(py::object callback) : callback_(std::move(callback)) {
    if (!callback_.is_none() && PyCallable_Check(callback_.ptr()) == 0)
      throw py::type_error("progress: expected None or a function of a stage and a fraction");
  }

  // Whether the call may go on. Python is asked at most every 50 ms, and when a stage begins.
  bool report(std::string_view stage, double fraction) {
    const auto now = std::chrono::steady_clock::now();
    const bool begins = !callback_.is_none() && stage != stage_;
    if (!begins && now - last_ < kInterval) return true;
    last_ = now;
    stage_ = stage;
    const py::gil_scoped_acquire acquire;
    return ask(fraction);
  }
  // The same for work without stages.
  bool poll() { return report(stage_, 0); }

  // With the GIL: throws what stopped the call, if Python did.
  void rethrow() {
    if (error_) throw std::exchange(error_, std::nullopt).value();
  }

 private:
  static constexpr std::chrono::milliseconds kInterval{50};

  bool ask(double fraction) {
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (callback_.is_none()) return true;
      return !callback_(stage_, fraction).is(py::bool_(false));
    } catch (py::error_already_set& error) {
      error_.emplace(error);
      return false;
    }
  }

  py::object callback_;
  std::string stage_;
  std::chrono::steady_clock::time_point last_{};
  std::optional<py::error_already_set> error_;
};

}  // namespace orchard::python
