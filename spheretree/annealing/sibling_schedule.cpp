#include "sibling_schedule.h"

#include <algorithm>
#include <cmath>

#include "orchard/geometry/sphere_distance.h"
#include "random_direction.h"

namespace orchard::detail {
namespace {

constexpr std::uint64_t kScheduleStage = 400;  // the stream of random numbers
// The smallest radius, over the parent's. Without a limit, a child that has become redundant would shrink forever.
constexpr double kMinRadius = 1e-3;  // of its parent's radius

}  // namespace

SiblingSchedule::SiblingSchedule(SphereTree& tree, Index parent, const Surface& surface,
                                 const AnnealingOptions& options, IncrementalCover& cover, AnnealingReport& report)
    : tree_(tree),
      parent_(tree.nodes[parent]),
      surface_(surface),
      options_(options),
      cover_(cover),
      report_(report),
      random_(options.seed, kScheduleStage + parent_.level, parent) {
  for (Index k = 0; k < parent_.child_count; ++k) energies_.push_back(energy_of(child(k).sphere));
  energy_ = energy_of_set();
}

void SiblingSchedule::run(int iterations, KeepBest keep) {
  if (keep == KeepBest::yes) note_best();
  double temperature = first_temperature();
  for (int i = 0; i < iterations && temperature > 0; ++i, temperature *= options_.cooling) run_at(temperature);
  if (keep == KeepBest::yes) restore_best();
}

void SiblingSchedule::run_at(double temperature) {
  int accepted = 0, rejected = 0, uncovering = 0;
  while (accepted < options_.max_accepted && rejected < options_.max_rejected && uncovering < options_.max_uncovering) {
    switch (try_change(temperature)) {
      case Outcome::accepted:
        ++accepted;
        break;
      case Outcome::rejected:
        ++rejected;
        break;
      case Outcome::uncovering:
        ++uncovering;
        break;
    }
  }
}

double SiblingSchedule::energy_of(const Sphere& ball) const {
  switch (options_.distance) {
    case SphereEnergy::samples:
      return sampled_sphere_distance(surface_, ball);
    case SphereEnergy::corrected_samples:
      return corrected_sphere_distance(surface_, ball);
    case SphereEnergy::lemma:
      break;
  }
  return std::max(0.0, convex_sphere_distance(surface_, ball));
}

double SiblingSchedule::energy_of_set() const {
  double energy = 0;
  for (const double e : energies_) energy = options_.energy == SetEnergy::sum ? energy + e : std::max(energy, e);
  return energy;
}

Sphere SiblingSchedule::changed(const Sphere& ball) {
  Sphere next = ball;
  next.center += random_.uniform() * options_.move * parent_.sphere.radius * random_direction(random_);
  next.radius *= random_.uniform(options_.min_scale, options_.max_scale);
  next.radius = std::max(next.radius, kMinRadius * parent_.sphere.radius);
  return next;
}

// Returns the temperature at which a change with the mean rise of some trial changes is accepted with the wanted
// probability.
double SiblingSchedule::first_temperature() {
  double sum = 0;
  for (int i = 0; i < options_.first_trials; ++i) {
    const auto k = static_cast<Index>(random_.below(parent_.child_count));
    const double before = energies_[k];
    energies_[k] = energy_of(changed(child(k).sphere));
    sum += std::abs(energy_of_set() - energy_);
    energies_[k] = before;
  }
  return -sum / options_.first_trials / std::log(options_.first_acceptance);
}

// As the dissertation has it, the cover is checked first, even for changes that would not be accepted. Changes that
// uncover the surface are tried again, and must not count as rejected.
SiblingSchedule::Outcome SiblingSchedule::try_change(double temperature) {
  ++report_.changes;
  const auto k = static_cast<Index>(random_.below(parent_.child_count));
  const Index node = parent_.first_child + k;
  const Sphere next = changed(child(k).sphere);
  if (!cover_.try_change(node, next)) {
    ++report_.uncovering;
    return Outcome::uncovering;
  }
  const double before = energies_[k];
  energies_[k] = energy_of(next);
  const double energy = energy_of_set(), rise = energy - energy_;
  if (rise > 0 && random_.uniform() >= std::exp(-rise / temperature)) {
    energies_[k] = before;
    cover_.change(node, child(k).sphere);
    return Outcome::rejected;
  }
  ++report_.accepted;
  child(k).sphere = next;
  energy_ = energy;
  if (!best_.empty() && energy_ < best_energy_) note_best();
  return Outcome::accepted;
}

void SiblingSchedule::note_best() {
  best_energy_ = energy_;
  best_.clear();
  for (Index k = 0; k < parent_.child_count; ++k) best_.push_back(child(k).sphere);
}

// The best state covered its part of the surface when it was stored, and no other balls there have changed since.
void SiblingSchedule::restore_best() {
  for (Index k = 0; k < parent_.child_count; ++k) {
    child(k).sphere = best_[k];
    cover_.change(parent_.first_child + k, best_[k]);
  }
}

}  // namespace orchard::detail
