#include "method.h"
namespace orchard::runtime::detail {
std::unique_ptr<Method> make_sleeping(Roster& roster, const BroadPhaseOptions& options) {
  return make_events(roster, options);
}
}  // namespace orchard::runtime::detail
