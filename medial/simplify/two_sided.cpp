#include "two_sided.h"

#include <algorithm>
#include <vector>

#include "../quality/quality_parts.h"
#include "fit_samples.h"

namespace orchard::detail {

void measure_two_sided(const Surface& surface, const MedialMesh& mesh, std::span<const Sphere> inscribed,
                       const SimplifyOptions& options, SimplifyReport& report) {
  std::vector<SurfaceSample> samples;
  for (const FitSample& sample : fit_samples(surface, options.check, options.seed + 1))
    samples.push_back({sample.position, sample.normal});
  MedialQuality quality;
  const double diagonal = quality.diagonal = surface.bounding_box().diagonal().norm();
  measure_reconstruction(surface, mesh, samples, quality_balls(mesh, QualityOptions{}.cells),
                         {.search = options.search, .worst_places = 0}, quality, inscribed);
  report.coverage = {quality.coverage_upper / diagonal, quality.coverage.mean / diagonal};
  report.protrusion = {quality.protrusion.max / diagonal, quality.protrusion.mean / diagonal};
  report.dent_upper = quality.dent_upper / diagonal;
  report.hausdorff = {std::max(quality.hausdorff.max, quality.coverage_upper) / diagonal,
                      quality.hausdorff.mean / diagonal};
}

}  // namespace orchard::detail
