#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "orchard/runtime/orchard.h"
#include "orchard/runtime/orchard_detector.h"

// The WebAssembly module is the C interface of the run-time with flat arguments: numbers, and arrays of doubles for
// everything that is a struct in C. src/ reads and writes these arrays, so it need not know how a compiler lays out a
// struct. An integer of up to 53 bits is exact in a double. The functions for rows below write one number after
// another and return the place behind the last one.
#define ORCHARD_EXPORT(name) extern "C" __attribute__((export_name(#name)))

namespace orchard::web {

// orchard_pose and orchard_motion are rows of doubles already.
inline constexpr std::size_t kPoseRow = 13, kMotionRow = 13, kStateRow = 23, kVerdictRow = 16, kDistanceRow = 10;
static_assert(sizeof(orchard_pose) == kPoseRow * sizeof(double));
static_assert(sizeof(orchard_motion) == kMotionRow * sizeof(double));

inline const orchard_pose& pose_at(const double* row, std::size_t index = 0) {
  return reinterpret_cast<const orchard_pose*>(row)[index];
}

// Any double as a limit: what is not below 2^64 is none.
inline std::uint64_t limit_of(double value) {
  return value >= 0x1p64 || std::isnan(value) ? ORCHARD_NO_LIMIT : static_cast<std::uint64_t>(std::max(value, 0.0));
}

inline orchard_budget budget_of(double tests, double microseconds) {
  return {limit_of(tests), limit_of(microseconds * 1000)};
}

inline double* put(double* to, const double* from, std::size_t count) { return std::copy_n(from, count, to); }

inline double* put(double* to, const orchard_verdict& v) {
  *to++ = v.answer;
  *to++ = v.separation_bound;
  *to++ = v.lower_bound;
  to = put(to, v.contact_center, 3);
  *to++ = v.contact_radius;
  to = put(to, v.contact_normal, 3);
  for (const std::uint32_t number : {v.triangle_a, v.triangle_b, v.level}) *to++ = number;
  *to++ = v.finished;
  *to++ = v.refused;
  *to++ = static_cast<double>(v.work);
  return to;
}

inline double* put(double* to, const orchard_distance& d) {
  *to++ = d.lower;
  *to++ = d.upper;
  to = put(to, d.on_a, 3);
  to = put(to, d.on_b, 3);
  *to++ = d.triangle_a;
  *to++ = d.triangle_b;
  return to;
}

// 8 numbers, and 6 for each of up to four points.
inline double* put(double* to, const orchard_manifold& m) {
  *to++ = m.answer;
  *to++ = m.count;
  to = put(to, m.normal, 3);
  *to++ = m.depth;
  *to++ = m.error;
  *to++ = m.complete;
  for (std::uint32_t i = 0; i < m.count; ++i) {
    to = put(to, m.points[i].place, 3);
    *to++ = m.points[i].triangle_a;
    *to++ = m.points[i].triangle_b;
    *to++ = m.points[i].depth;
  }
  return to;
}

inline double* put(double* to, const orchard_body& body) {
  *to++ = body.index;
  *to++ = body.generation;
  return to;
}

}  // namespace orchard::web
