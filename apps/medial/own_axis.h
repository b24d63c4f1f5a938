#pragma once
#include "medial/medial_tuning.h"
#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/medial_mesh.h"

namespace orchard::apps {

// The axis of orchard with at least `least` balls, where that is possible: a refined one is built again with twice the
// samples and half the errors, three times at most. Costs up to twenty times one axis.
MedialMesh axis_with_balls(const Surface& surface, MedialTuning tuning, Index least, const Progress& progress = {});

}  // namespace orchard::apps
