#include "orchard/spheretree/annealing.h"

#include <algorithm>
#include <cmath>

#include "octants.h"
#include "orchard/covering/incremental_cover.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/spheretree/redundancy.h"
#include "random_direction.h"

namespace orchard {
namespace {

constexpr std::uint64_t kStage = 400;  // of the random numbers
// A child that has become redundant would shrink for ever.
constexpr double kSmallest = 1e-3;  // of its parent's radius

// Anneals the children of one node.
class Schedule {
 public:
  Schedule(SphereTree& tree, Index parent, const Surface& surface, const AnnealingOptions& options,
           IncrementalCover& cover, AnnealingReport& report)
      : tree_(tree),
        parent_(tree.nodes[parent]),
        surface_(surface),
        options_(options),
        cover_(cover),
        report_(report),
        random_(options.seed, kStage + parent_.level, parent) {
    for (Index k = 0; k < parent_.child_count; ++k) energies_.push_back(energy_of(child(k).sphere));
    energy_ = energy_of_set();
  }

  void run(int iterations) {
    double temperature = first_temperature();
    for (int i = 0; i < iterations && temperature > 0; ++i, temperature *= options_.cooling) {
      int accepted = 0, rejected = 0;
      while (accepted < options_.most_accepted && rejected < options_.most_rejected)
        (try_change(temperature) ? accepted : rejected) += 1;
    }
  }

 private:
  SphereNode& child(Index k) { return tree_.nodes[parent_.first_child + k]; }
  double energy_of(const Sphere& ball) const {
    return std::max(0.0, ball.radius + surface_.signed_distance(ball.center));
  }
  double energy_of_set() const {
    double energy = 0;
    for (const double e : energies_) energy = options_.energy == SetEnergy::sum ? energy + e : std::max(energy, e);
    return energy;
  }

  Sphere changed(const Sphere& ball) {
    Sphere next = ball;
    next.center += random_.uniform() * options_.move * parent_.sphere.radius * random_direction(random_);
    next.radius *= random_.uniform(options_.least_scale, options_.greatest_scale);
    next.radius = std::max(next.radius, kSmallest * parent_.sphere.radius);
    return next;
  }

  // The temperature at which the mean rise over some changes would pass with the wanted probability.
  double first_temperature() {
    double sum = 0;
    for (int i = 0; i < options_.first_trials; ++i) {
      const auto k = static_cast<Index>(random_.below(parent_.child_count));
      const double before = energies_[k];
      energies_[k] = energy_of(changed(child(k).sphere));
      sum += std::abs(energy_of_set() - energy_);
      energies_[k] = before;
    }
    return options_.first_trials > 0 ? -sum / options_.first_trials / std::log(options_.first_acceptance) : 0;
  }

  // The energy costs less than the cover, so it is asked first.
  bool try_change(double temperature) {
    ++report_.changes;
    const auto k = static_cast<Index>(random_.below(parent_.child_count));
    const Sphere next = changed(child(k).sphere);
    const double before = energies_[k];
    energies_[k] = energy_of(next);
    const double energy = energy_of_set(), rise = energy - energy_;
    const bool wanted = rise <= 0 || random_.uniform() < std::exp(-rise / temperature);
    const bool covers = wanted && cover_.try_change(parent_.first_child + k, next);
    report_.uncovering += wanted && !covers;
    if (!covers) {
      energies_[k] = before;
      return false;
    }
    ++report_.accepted;
    child(k).sphere = next;
    energy_ = energy;
    return true;
  }

  SphereTree& tree_;
  const SphereNode parent_;
  const Surface& surface_;
  const AnnealingOptions& options_;
  IncrementalCover& cover_;
  AnnealingReport& report_;
  Random random_;
  std::vector<double> energies_;
  double energy_ = 0;
};

class Annealer {
 public:
  Annealer(const Surface& surface, const AnnealingOptions& options, AnnealingReport& report)
      : surface_(surface),
        options_(options),
        report_(report),
        margin_(tolerance::kCoverMargin * surface.bounding_radius()) {}

  SphereTree run(const Progress& progress) {
    tree_.branching = 8;
    tree_.nodes.push_back({.sphere = surface_.bounding_ball()});
    tree_.nodes[0].sphere.radius += margin_;
    for (Index level = 1; level <= options_.depth; ++level) {
      const auto above = static_cast<Index>(tree_.nodes.size());
      for (Index node = 0; node < above; ++node)
        if (tree_.nodes[node].level + 1 == level && wants_children(options_.refinement, surface_, ball(node)))
          add_children(node);
      if (tree_.nodes.size() == above) break;
      anneal_level(level, progress);
      report_.redundant += remove_redundant(tree_, surface_, Selection::acyclic).removed;
    }
    return std::move(tree_);
  }

 private:
  const Sphere& ball(Index node) const { return tree_.nodes[node].sphere; }

  // The octants of the bounding box, or of the cube around the parent, that meet triangles inside the balls above.
  void add_children(Index parent) {
    Octant whole{surface_.bounding_box(), triangles_on_path(parent), parent};
    if (parent != 0) {
      const Vector half = Vector::Constant(ball(parent).radius);
      whole.box = Box(ball(parent).center - half, ball(parent).center + half);
    }
    const auto octants = occupied_children(surface_, whole);
    tree_.nodes[parent].first_child = static_cast<Index>(tree_.nodes.size());
    tree_.nodes[parent].child_count = static_cast<Index>(octants.size());
    const Index level = tree_.nodes[parent].level + 1;
    for (const Octant& octant : octants)
      tree_.nodes.push_back({.sphere = {octant.box.center(), octant.box.diagonal().norm() / 2 + margin_},
                             .parent = parent,
                             .level = level});
    if (octants.empty()) tree_.nodes[parent].first_child = kNone;
  }

  std::vector<Index> triangles_on_path(Index node) const {
    std::vector<Index> triangles;
    surface_.triangles_near(ball(node), triangles);
    for (Index above = tree_.nodes[node].parent; above != kNone; above = tree_.nodes[above].parent)
      std::erase_if(triangles, [&](Index triangle) {
        const auto [a, b, c] = surface_.corners(triangle);
        return closest_point_of_triangle(ball(above).center, a, b, c).distance > ball(above).radius;
      });
    return triangles;
  }

  void anneal_level(Index level, const Progress& progress) {
    IncrementalCover cover(surface_, path_balls(tree_));
    std::vector<Index> parents;
    for (Index node = 0; node < tree_.nodes.size(); ++node)
      if (tree_.nodes[node].level + 1 == level && tree_.nodes[node].child_count > 0) parents.push_back(node);
    for (std::size_t i = 0; i < parents.size(); ++i) {
      const double done = static_cast<double>(i) / static_cast<double>(parents.size());
      report_progress(progress, "annealing", (level - 1 + done) / options_.depth);
      Schedule(tree_, parents[i], surface_, options_, cover, report_)
          .run(level == 1 ? options_.iterations_first : options_.iterations);
    }
  }

  const Surface& surface_;
  const AnnealingOptions& options_;
  AnnealingReport& report_;
  const double margin_;
  SphereTree tree_;
};

void check(const AnnealingOptions& o) {
  if (!(o.least_scale > 0) || !(o.least_scale <= o.greatest_scale) || !(o.move >= 0))
    throw InputError("annealing: moves and scales must be positive, the least scale first");
  if (!(o.cooling > 0) || !(o.cooling < 1) || !(o.first_acceptance > 0) || !(o.first_acceptance < 1))
    throw InputError("annealing: the cooling and the first acceptance must lie between 0 and 1");
  if (o.most_accepted < 1 || o.most_rejected < 1)
    throw InputError("annealing: at least one change at each temperature");
}

}  // namespace

SphereTree annealed_tree(const Surface& surface, const AnnealingOptions& options, const Progress& progress,
                         AnnealingReport* report) {
  check(options);
  AnnealingReport unused;
  return Annealer(surface, options, report ? *report : unused).run(progress);
}

}  // namespace orchard
