#pragma once
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "arrays.h"
#include "orchard/runtime/collide.h"
#include "orchard/runtime/packed_tree.h"
#include "watch.h"

namespace orchard::python {

using runtime::Pose;
using Vec = std::array<double, 3>;

// A tree that any number of threads may ask, and its nodes in breadth-first order.
struct Tree {
  explicit Tree(runtime::PackedSphereTree tree);

  runtime::PackedSphereTree packed;
  runtime::PreparedTree prepared;
  std::vector<std::array<double, 4>> spheres;  // x y z r in the mesh's frame
  std::vector<std::int64_t> parents;           // -1 of the root
  std::vector<std::int32_t> levels;
  std::vector<double> errors, depths;  // infinite where unknown
  std::vector<std::uint8_t> leaves;
};
using TreePointer = std::shared_ptr<Tree>;

// One pose of Python's, as (16,) row-major matrix entries or (7,) translation and quaternion; `wxyz` is the order of
// the latter. Throws ValueError naming the pose.
Pose to_pose(const double* numbers, std::size_t count, bool wxyz, std::size_t number);

// The rows of a (k, 16) or (k, 7) array, which is read in place: a pose is made when it is asked for, also without the
// GIL.
class PoseRows {
 public:
  PoseRows(const py::buffer& rows, bool wxyz);
  std::size_t size() const { return input_.size(); }
  Pose operator[](std::size_t i) const { return to_pose(input_.row(i), columns_, wxyz_, i); }

 private:
  std::size_t columns_;
  Input<double> input_;
  bool wxyz_;
};

// The pose of an array of one row.
Pose to_single_pose(const py::buffer& row, bool wxyz);

inline Vec to_vec(const double* numbers) { return {numbers[0], numbers[1], numbers[2]}; }

// A budget of Python's: work of 0 and seconds of infinity are no limits.
runtime::Budget to_budget(std::uint64_t work, double seconds);

// Answers of many questions, in chunks between which Ctrl-C is noticed: work(i) for each i below `count`.
template <class Work>
void for_each(std::size_t count, const Work& work) {
  constexpr std::size_t kChunk = 256;
  Watch watch(py::none{});
  bool stopped = false;
  {
    const py::gil_scoped_release release;
    for (std::size_t begin = 0; begin < count && !stopped; begin += kChunk) {
      const std::size_t end = std::min(count, begin + kChunk);
      for (std::size_t i = begin; i < end; ++i) work(i);
      stopped = !watch.poll();
    }
  }
  if (stopped) watch.rethrow();
}

// Set while a call runs without the GIL on an object that belongs to one thread at a time. Read and set with the GIL.
class Busy {
 public:
  explicit Busy(bool& busy) : busy_(busy) { busy_ = true; }
  ~Busy() { busy_ = false; }
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;

 private:
  bool& busy_;
};
inline void require_free(bool busy) {
  if (busy) throw std::runtime_error("another thread is using this object; give each thread its own");
}

void bind_trees(py::module_& module);
void bind_pair_queries(py::module_& module);
void bind_shape_queries(py::module_& module);
void bind_broad_phase(py::module_& module);
void bind_detector(py::module_& module);

}  // namespace orchard::python
