#include "climb.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace orchard::detail {
namespace {

constexpr int kHalvings = 3;         // lengths of the step, each half of the one before
constexpr int kStepsOfLength = 2;    // at most of each length
constexpr double kOnePlace = 0.125;  // of the first step: places so near to each other are one

class Climber {
 public:
  Climber(const Surface& surface, const ContractibleMesh& mesh) : surface_(surface), finder_(mesh) {}

  void climb(FitSample& sample, double step) const {
    Foot foot = finder_.find(sample.position);
    for (int halving = 0; halving < kHalvings; ++halving, step /= 2) {
      for (int k = 0; k < kStepsOfLength && climb_once(sample, foot, step); ++k) continue;
    }
  }

 private:
  // Moves the sample to the best of four places around it. Returns false if none is better than where it is.
  bool climb_once(FitSample& sample, Foot& foot, double step) const {
    const Vector side = sample.normal.unitOrthogonal(), other = sample.normal.cross(side);
    const FitSample from = sample;
    const double before = std::abs(foot.value);
    for (const Vector& way : {side, other, Vector(-side), Vector(-other)}) {
      const ClosestPoint place = surface_.closest(from.position + step * way);
      const Foot there = finder_.find(place.position, &foot);
      if (std::abs(there.value) <= std::abs(foot.value)) continue;
      foot = there;
      sample.position = place.position;
      sample.normal = surface_.pseudonormal(place.triangle, place.feature);
    }
    return std::abs(foot.value) > before;
  }

  const Surface& surface_;
  const FootFinder finder_;
};

}  // namespace

void climb(const Surface& surface, const ContractibleMesh& mesh, double reach, std::vector<FitSample>& samples) {
  const Climber climber(surface, mesh);
  tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) { climber.climb(samples[i], reach / 2); });
  std::vector<FitSample> apart;
  for (const FitSample& sample : samples) {
    const bool known = std::any_of(apart.begin(), apart.end(), [&](const FitSample& other) {
      return (other.position - sample.position).norm() < kOnePlace * reach;
    });
    if (!known) apart.push_back(sample);
  }
  samples = std::move(apart);
}

}  // namespace orchard::detail
