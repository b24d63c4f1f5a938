#include "orchard/runtime/collide.h"

#include <cmath>

#include "collision/distance_search.h"
#include "collision/pair_query.h"
#include "collision/workspace_scratch.h"

namespace orchard::runtime {

Workspace::Workspace(std::size_t room) noexcept : narrow(room) {}
Workspace::~Workspace() = default;
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;

Workspace::Scratch* Workspace::scratch() noexcept {
  if (!scratch_) scratch_.reset(new (std::nothrow) Scratch);
  return scratch_.get();
}

Verdict collide(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b, const Budget& budget,
                Order order) noexcept {
  PairQuery& query = query_of(workspace.narrow);
  query.bind(pair.a(), pair.b());
  return collide(query, a, b, budget, order);
}

Answer closer_than(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b, double margin,
                   const Budget& budget) noexcept {
  if (!(margin >= 0)) return Answer::maybe;
  if (margin == 0) {
    PairQuery& query = query_of(workspace.narrow);
    query.bind(pair.a(), pair.b());
    return collide(query, a, b, budget).answer;
  }
  DistanceSearch& query = search_of(workspace.distance);
  query.bind(pair.a(), pair.b());
  query.start_within(a, b, margin);
  query.refine(budget);
  if (query.lower() > margin) return Answer::no;
  return query.upper() <= margin && std::isfinite(query.upper()) ? Answer::yes : Answer::maybe;
}

Distance distance(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b,
                  const DistanceQuery::Tolerance& tolerance) noexcept {
  DistanceSearch& query = search_of(workspace.distance);
  query.bind(pair.a(), pair.b());
  query.start(a, b, tolerance);
  query.refine();
  return {query.lower(), query.upper(), query.points()};
}

Closeness closer_with_points(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b,
                             double margin) noexcept {
  constexpr double kFirst = 0.01, kClosest = 1e-9;  // relative tolerances: the second one if the first leaves doubt
  Closeness result;
  result.answer = closer_than(workspace, pair, a, b, margin);
  if (result.answer != Answer::yes) return result;
  result.distance = distance(workspace, pair, a, b, {.relative = kFirst, .absolute = 0});
  if (result.distance.upper > margin) {
    result.distance = distance(workspace, pair, a, b, {.relative = kClosest, .absolute = 0});
  }
  return result;
}

}  // namespace orchard::runtime
