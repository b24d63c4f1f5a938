#include "interior.h"

#include <tbb/parallel_for.h>

#include <cmath>

#include "orchard/geometry/tolerance.h"

namespace orchard::detail {
namespace {

constexpr Index kSeedStride = 8;
constexpr std::uint8_t kOutside = 0, kInside = 1, kOpen = 2;

class Classification {
 public:
  Classification(const Surface& surface, const VoronoiDiagram& diagram)
      : surface_(surface),
        diagram_(diagram),
        states_(diagram.vertices.size(), kOpen),
        clearance_(diagram.vertices.size(), 0.0),
        margin_(tolerance::kClearance * surface.bounding_radius()) {}

  std::vector<std::uint8_t> run(const Progress& progress) {
    report_progress(progress, "interior", 0);
    settle_what_needs_no_query();
    const Index size = static_cast<Index>(states_.size());
    std::vector<Index> seeds, rest;
    for (Index i = 0; i < size; i += kSeedStride) {
      if (states_[i] == kOpen) seeds.push_back(i);
    }
    ask(seeds);
    report_progress(progress, "interior", 0.3);
    spread(seeds);
    for (Index i = 0; i < size; ++i) {
      if (states_[i] == kOpen) rest.push_back(i);
    }
    ask(rest);
    report_progress(progress, "interior", 1);
    return std::move(states_);
  }

 private:
  void settle_what_needs_no_query() {
    const Box& box = surface_.bounding_box();
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const VoronoiVertex& vertex = diagram_.vertices[i];
      if (vertex.at_infinity() || !vertex.center.allFinite() || !box.contains(vertex.center)) states_[i] = kOutside;
    }
  }

  void ask(const std::vector<Index>& vertices) {
    tbb::parallel_for(std::size_t{0}, vertices.size(), [&](std::size_t i) {
      const Index vertex = vertices[i];
      const double distance = surface_.signed_distance(diagram_.vertices[vertex].center);
      states_[vertex] = distance < 0 ? kInside : kOutside;
      clearance_[vertex] = std::abs(distance);
    });
  }

  // The distance to the surface is 1-Lipschitz. So a vertex that is nearer to a settled vertex than the clearance of
  // that vertex lies on the same side, with the rest of the clearance. The margin covers the rounding errors of a long
  // chain of such steps.
  void spread(std::vector<Index> settled) {
    while (!settled.empty()) {
      const Index vertex = settled.back();
      settled.pop_back();
      for (const Index next : diagram_.vertices[vertex].neighbors) {
        if (next == kNone || states_[next] != kOpen) continue;
        const double step = (diagram_.vertices[next].center - diagram_.vertices[vertex].center).norm();
        const double left = clearance_[vertex] - step - margin_;
        if (!(left > 0)) continue;
        states_[next] = states_[vertex];
        clearance_[next] = left;
        settled.push_back(next);
      }
    }
  }

  const Surface& surface_;
  const VoronoiDiagram& diagram_;
  std::vector<std::uint8_t> states_;
  std::vector<double> clearance_;  // lower bound on the distance to the surface, for settled vertices
  double margin_;
};

}  // namespace

std::vector<std::uint8_t> interior_vertices(const Surface& surface, const VoronoiDiagram& diagram,
                                            const Progress& progress) {
  if (!surface.solid()) {
    throw InputError("the medial axis needs a solid: " + surface.report().faults() + "; repair the mesh first");
  }
  return Classification(surface, diagram).run(progress);
}

}  // namespace orchard::detail
