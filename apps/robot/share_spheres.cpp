#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>

#include "orchard/covering/inaccuracy.h"
#include "orchard/geometry/error.h"
#include "robot/link_fit.h"

namespace orchard::robot {
namespace {

constexpr double kPower = 0.6;  // by which looseness falls with the number, where one number alone was tried
constexpr int kRounds = 2;      // of sets that are made to find out

// How loose sets of some numbers of spheres are, in metres.
class Looseness {
 public:
  void note(Index spheres, double loose) { tried_[spheres] = std::max(loose, 1e-9); }
  bool knows(Index spheres) const { return tried_.contains(spheres); }

  // Between two numbers that were tried, or beyond them, by the power through the nearest.
  double at(Index spheres) const {
    const auto above = tried_.lower_bound(spheres);
    if (above != tried_.end() && above->first == spheres) return above->second;
    const auto [n, loose] = above == tried_.begin() ? *above : *std::prev(above);
    double power = kPower;
    if (above != tried_.begin() && above != tried_.end())
      power = std::log(loose / above->second) / std::log(static_cast<double>(above->first) / n);
    return loose * std::pow(static_cast<double>(n) / spheres, std::max(power, 0.05));
  }

 private:
  std::map<Index, double> tried_;
};

class Sharer {
 public:
  Sharer(const Robot& robot, const std::vector<LinkShape>& shapes, const FitOptions& options)
      : robot_(robot), shapes_(shapes), options_(options), looseness_(shapes.size()), fixed_(shapes.size(), false) {
    for (std::size_t i = 0; i < shapes.size(); ++i) fixed_[i] = options.spheres_of.contains(shapes[i].link);
  }

  std::vector<Index> run(const Progress& progress) {
    require_enough();
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      const Surface& surface = shapes_[i].surface;
      const Sphere ball = surface.bounding_ball();
      looseness_[i].note(1, surface.solid() ? inaccuracy(surface, ball, {1e-3, 1e-2}).upper : ball.radius);
    }
    std::vector<Index> counts = fill();
    for (int round = 0; round < kRounds; ++round) {
      report_progress(progress, "sharing spheres", static_cast<double>(round) / kRounds);
      tbb::parallel_for(std::size_t{0}, shapes_.size(), [&](std::size_t i) { measure(i, counts[i]); });
      counts = fill();
    }
    return counts;
  }

 private:
  Index fixed_sum() const {
    Index sum = 0;
    for (std::size_t i = 0; i < shapes_.size(); ++i)
      if (fixed_[i]) sum += options_.spheres_of.at(shapes_[i].link);
    return sum;
  }

  void require_enough() const {
    const auto free = static_cast<Index>(std::count(fixed_.begin(), fixed_.end(), false));
    const Index sum = fixed_sum();
    if (free > 0 && options_.spheres < sum + free)
      throw InputError(
          fmt::format("{}: {} spheres are too few: {} link{} with geometry need one each{}; --spheres {} is the least",
                      robot_.file.string(), options_.spheres, free, free == 1 ? "" : "s",
                      sum > 0 ? fmt::format(", beside the {} that --link asks for", sum) : std::string(), sum + free));
  }

  // One each, and the others one by one where they are needed most.
  std::vector<Index> fill() const {
    std::vector<Index> counts(shapes_.size(), 1);
    Index left = options_.spheres;
    bool any_free = false;
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      if (fixed_[i]) counts[i] = options_.spheres_of.at(shapes_[i].link);
      any_free = any_free || !fixed_[i];
      left -= std::min(left, counts[i]);
    }
    for (; any_free && left > 0; --left) {
      std::size_t loosest = shapes_.size();
      for (std::size_t i = 0; i < shapes_.size(); ++i) {
        if (fixed_[i] || counts[i] >= kMaxSetSpheres) continue;
        if (loosest == shapes_.size() || looseness_[i].at(counts[i]) > looseness_[loosest].at(counts[loosest]))
          loosest = i;
      }
      if (loosest == shapes_.size()) break;
      ++counts[loosest];
    }
    return counts;
  }

  void measure(std::size_t i, Index spheres) {
    if (fixed_[i] || looseness_[i].knows(spheres) || !shapes_[i].surface.solid()) return;
    SphereSetOptions own{.fit = SphereFit::cover, .spheres = spheres, .effort = Effort::low, .find_enough = false};
    own.seed = options_.seed;
    own.audit = kQuickAudit;
    looseness_[i].note(spheres, build_sphere_set(shapes_[i].surface, own).audit.beside_solid->protrusion.upper);
  }

  const Robot& robot_;
  const std::vector<LinkShape>& shapes_;
  const FitOptions& options_;
  std::vector<Looseness> looseness_;
  std::vector<bool> fixed_;
};

}  // namespace

std::vector<Index> share_spheres(const Robot& robot, const std::vector<LinkShape>& shapes, const FitOptions& options,
                                 const Progress& progress) {
  return Sharer(robot, shapes, options).run(progress);
}

}  // namespace orchard::robot
