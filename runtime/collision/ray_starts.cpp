#include "collision/ray_walk.h"
#include "simd/machine.h"

namespace orchard::runtime::detail {
namespace {

ORCHARD_INLINE void make_all(const Frame& given, const Ball& ball, RayStarts& starts) noexcept {
  const Frame frame = given;  // copies, with which the rows cannot overlap
  const Ball around = ball;
  for (std::size_t i = 0; i < RayStarts::kCount; ++i) {
    const RayStart start = start_of(frame, around, {starts.origin[0][i], starts.origin[1][i], starts.origin[2][i]},
                                    {starts.way[0][i], starts.way[1][i], starts.way[2][i]}, starts.steps[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      starts.from[k][i] = start.from[k], starts.to[k][i] = start.to[k], starts.step[k][i] = start.step[k];
      starts.lines.origin[k][i] = start.line.ray.origin[k], starts.lines.direction[k][i] = start.line.ray.direction[k];
    }
    starts.speed[i] = start.speed, starts.slowness[i] = start.slowness, starts.end[i] = start.end;
    starts.lines.at[i] = start.line.at, starts.lines.margin[i] = start.line.ray.margin;
    starts.lines.begin[i] = start.line.begin, starts.lines.end[i] = start.line.end;
    starts.lines.misses[i] = start.line.misses ? 1.0f : 0.0f,
    starts.lines.in_float[i] = start.line.in_float ? 1.0f : 0.0f;
  }
}

}  // namespace

void find_starts(const Frame& frame, const Ball& ball, RayStarts& starts) noexcept {
  PerMachine<make_all>::call(frame, ball, starts);
}

}  // namespace orchard::runtime::detail
