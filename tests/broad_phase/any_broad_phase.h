#pragma once
#include <utility>

#include "broad_phase_methods/sleeping_broad_phase.h"

// A broad phase that finds what happens next in any of the ways there are, so that all go through the same tests.
namespace orchard::runtime::test {

enum class AnyMethod : std::uint8_t { events, all_pairs, projection, subdivision, hybrid, quadratic, horns };
inline constexpr AnyMethod kMethods[] = {AnyMethod::events,      AnyMethod::all_pairs, AnyMethod::projection,
                                         AnyMethod::subdivision, AnyMethod::hybrid,    AnyMethod::quadratic,
                                         AnyMethod::horns};

using broad_phase_methods::Rebuild;

struct AnyOptions {
  AnyMethod method = AnyMethod::events;
  Rebuild rebuild = Rebuild::what_intersected;  // without meaning for `events`
  BroadPhaseOptions common{};
};

inline BroadPhase make_broad_phase(MotionSource source, const AnyOptions& options) {
  using broad_phase_methods::SleepingMethod;
  const auto sleeping = [&](SleepingMethod method) {
    return broad_phase_methods::make_sleeping_broad_phase(std::move(source), {method, options.rebuild, options.common});
  };
  switch (options.method) {
    case AnyMethod::events:
      break;
    case AnyMethod::all_pairs:
      return sleeping(SleepingMethod::all_pairs);
    case AnyMethod::projection:
      return sleeping(SleepingMethod::projection);
    case AnyMethod::subdivision:
      return sleeping(SleepingMethod::subdivision);
    case AnyMethod::hybrid:
      return sleeping(SleepingMethod::hybrid);
    case AnyMethod::quadratic:
      return sleeping(SleepingMethod::quadratic);
    case AnyMethod::horns:
      return sleeping(SleepingMethod::horns);
  }
  return BroadPhase(std::move(source), options.common);
}

}  // namespace orchard::runtime::test
