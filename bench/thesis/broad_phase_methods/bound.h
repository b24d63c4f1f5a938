#pragma once
#include "space_time_bound.h"

namespace orchard::broad_phase_methods::detail {

using runtime::kMotionSlack;

// The first t in [0, duration] at which the cubes meet: of hypertrapezoids, and of quadratic bounds. No cutting planes.
double trapezoid_contact(const SpaceTimeBound& a, const SpaceTimeBound& b, double duration) noexcept;
double quadratic_contact(const SpaceTimeBound& a, const SpaceTimeBound& b, double duration) noexcept;

// The first t in [first, duration] at which a face or the plane of one meets the plane of the other within both bounds
// (4.2.6, 4.2.7), where `first` is when the hypertrapezoids meet, in a part that the planes cut off.
double plane_contact(const SpaceTimeBound& a, const SpaceTimeBound& b, double first, double duration) noexcept;

bool cubes_meet_at_start(const SpaceTimeBound& a, const SpaceTimeBound& b) noexcept;

// Room for rounding at time t, relative to the coordinates there.
double contact_slack(const SpaceTimeBound& a, const SpaceTimeBound& b, double t) noexcept;

}  // namespace orchard::broad_phase_methods::detail
