#pragma once
#include <array>
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

// What a response to a contact would use of all contacts that a library finds.
struct ContactResponse {
  std::size_t count = 0;
  double depth = 0;                                  // the deepest one's
  std::array<double, 3> deepest_normal{}, normal{};  // the deepest one's, and the mean of all; of length 1 or 0
};

class PairRival {
 public:
  virtual ~PairRival() = default;
  virtual std::string name() const = 0;
  virtual void place(const std::vector<Query>& queries) = 0;  // poses in its own form, before any clock runs
  virtual bool collide(std::size_t query) = 0;
  virtual bool measures_distance() const { return false; }
  virtual double distance(std::size_t) { return 0; }  // exact: FCL does not heed its relative error
  virtual bool finds_contacts() const { return false; }
  virtual std::size_t contacts(std::size_t) { return 0; }  // all of them, with normals and depths; how many
  virtual ContactResponse response(std::size_t) { return {}; }
  virtual bool moves() const { return false; }
  // From pose `a` at rest, `b` to `to` in a unit of time, by conservative advancement.
  virtual double time_of_impact(std::size_t, const runtime::Pose& /*to*/, double /*tolerance*/) { return 1; }
  virtual bool casts_rays() const { return false; }
  // Against the first body as it is, from a point to another; the fraction of the way, or 1.
  virtual double cast_ray(const std::array<double, 3>&, const std::array<double, 3>&) { return 1; }
};

// Of contacts one after another.
class ResponseSum {
 public:
  void add(const std::array<double, 3>& normal, double depth);
  ContactResponse result() const;

 private:
  ContactResponse sum_;
};

// Each made of the triangles that the trees store. Null where the library is not installed.
std::unique_ptr<PairRival> fcl_float(const runtime::TreeView& a, const runtime::TreeView& b);
std::unique_ptr<PairRival> fcl_double(const runtime::TreeView& a, const runtime::TreeView& b);
std::unique_ptr<PairRival> bullet(const runtime::TreeView& a, const runtime::TreeView& b);
std::unique_ptr<PairRival> cgal(const runtime::TreeView& a, const runtime::TreeView& b);
enum class BspHeuristic { fewest_splits, balanced };
std::unique_ptr<PairRival> bsp_trees(const runtime::TreeView& a, const runtime::TreeView& b,
                                     BspHeuristic heuristic = BspHeuristic::fewest_splits);
std::unique_ptr<PairRival> octree(const runtime::TreeView& a, const runtime::TreeView& b);

}  // namespace orchard::bench
