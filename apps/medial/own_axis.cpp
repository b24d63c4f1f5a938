#include "medial/own_axis.h"

#include "orchard/medial/build.h"

namespace orchard::apps {
namespace {

constexpr int kCloser = 3;  // times that the errors allowed are halved: more takes long and gains little

}  // namespace

MedialMesh axis_with_balls(const Surface& surface, MedialTuning tuning, Index least, const Progress& progress) {
  MedialMesh axis = medial_mesh(build_medial_axis(surface, build_options(tuning), progress).axis);
  for (int closer = 0; tuning.refine && closer < kCloser && axis.size() < least; ++closer) {
    tuning.samples = 2 * tuning.samples.value_or(kStandardSamples);
    tuning.refinement.border_loss /= 2;
    tuning.refinement.tolerance /= 2;
    tuning.refinement.feature_loss /= 2;
    axis = medial_mesh(build_medial_axis(surface, build_options(tuning), progress).axis);
  }
  return axis;
}

}  // namespace orchard::apps
