#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"

// What the benchmark and the check need of another library: the same pair of bodies at the same poses.
namespace orchard::bench {

struct Query {
  runtime::Pose a, b;
  int pose_class;
};

class Rival {
 public:
  virtual ~Rival() = default;
  virtual std::string name() const = 0;
  virtual void place(const std::vector<Query>& queries) = 0;  // poses in its own form, before any clock runs
  virtual bool collide(std::size_t query) = 0;
  virtual bool measures_distance() const { return false; }
  virtual double distance(std::size_t) { return 0; }  // to 1 %
};

// Each made of the triangles that the trees store. Null where the library is not installed.
std::unique_ptr<Rival> fcl_float(const runtime::TreeView& a, const runtime::TreeView& b);
std::unique_ptr<Rival> fcl_double(const runtime::TreeView& a, const runtime::TreeView& b);
std::unique_ptr<Rival> bullet(const runtime::TreeView& a, const runtime::TreeView& b);
std::unique_ptr<Rival> cgal(const runtime::TreeView& a, const runtime::TreeView& b);
std::unique_ptr<Rival> bsp_trees(const runtime::TreeView& a, const runtime::TreeView& b);

}  // namespace orchard::bench
