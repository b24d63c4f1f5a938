#include "output/promises.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "medial/medial_warning.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

std::string percent(double share) { return fmt::format("{:.3g} % of the diagonal", 100 * share); }

json limited(const std::optional<double>& promised, double found, double upper) {
  if (!promised) return nullptr;
  return {
      {"promised", 100 * *promised}, {"found_above", found > 0 ? json(100 * found) : json()}, {"upper", 100 * upper}};
}

}  // namespace

void Broken::add(const Broken& others) {
  what.insert(what.end(), others.what.begin(), others.what.end());
  if (remedy.empty()) remedy = others.remedy;
}

Broken broken(const PromiseCheck& check) {
  Broken result;
  if (!check.keeps_topology())
    result.what.push_back(fmt::format("the axis has {}, the solid {}", in_words(check.found), in_words(check.wanted)));
  if (!check.keeps_open())
    result.what.push_back(fmt::format("the surface is left open by {}, where at most {} was promised",
                                      percent(check.open), percent(*check.promise.open)));
  if (check.keeps_open() && check.promise.open && check.open_upper > *check.promise.open)
    result.what.push_back(fmt::format(
        "it could be proven only that the surface is left open by {} at most, where at most {} was promised",
        percent(check.open_upper), percent(*check.promise.open)));
  if (!check.keeps_protrusion())
    result.what.push_back(fmt::format("the axis sticks out of the solid by {}, where at most {} was promised",
                                      percent(check.protrusion), percent(*check.promise.protrusion)));
  if (check.keeps_protrusion() && check.promise.protrusion && check.protrusion_upper > *check.promise.protrusion)
    result.what.push_back(fmt::format(
        "it could be proven only that the axis sticks out of the solid by {} at most, where at most {} was promised",
        percent(check.protrusion_upper), percent(*check.promise.protrusion)));
  return result;
}

json to_json(const PromiseCheck& check) {
  json topology = nullptr;
  if (check.promise.topology) topology = check.keeps_topology();
  return {{"proven", check.proven()},
          {"open", limited(check.promise.open, check.open, check.open_upper)},
          {"protrusion", limited(check.promise.protrusion, check.protrusion, check.protrusion_upper)},
          {"topology", topology}};
}

Broken broken(const FewBalls& few, const SimplifyOptions& options, const Topology& wanted) {
  Broken result;
  if (!few.simplified) return result;
  const auto& [mesh, report] = *few.simplified;
  if (options.vertices > 0 && mesh.size() > options.vertices)
    result.what.push_back(
        fmt::format("the simplified axis has {} balls, where {} were asked for", mesh.size(), options.vertices));
  if (options.vertices == 0 && report.upper > options.error)
    result.what.push_back(fmt::format("the simplified axis is off by up to {}, where at most {} was asked for",
                                      percent(report.upper), percent(options.error)));
  if (const Topology found = topology(mesh); found != wanted)
    result.what.push_back(
        fmt::format("the simplified axis has {}, where {} was promised", in_words(found), in_words(wanted)));
  return result;
}

Broken broken(const SphereTreeBuild& build, const Refinement& refinement) {
  Index loose = 0, limited_leaves = 0;
  double worst = 0, allowed_there = 0;
  for (const SphereNode& node : build.tree.nodes) {
    const double allowed = refinement.allowed(node.sphere);
    if (node.child_count > 0 || !(allowed > 0)) continue;
    ++limited_leaves;
    if (node.inaccuracy <= allowed) continue;
    ++loose;
    if (node.inaccuracy / allowed > worst) worst = node.inaccuracy / allowed, allowed_there = allowed;
  }
  Broken result;
  if (loose == 0) return result;
  result.what.push_back(fmt::format(
      "{} of {} spheres without children are looser than was asked for, one by up to {:.3g} where {:.3g} was allowed",
      loose, limited_leaves, worst * allowed_there, allowed_there));
  result.remedy = "a higher --depth may help";
  return result;
}

std::string in_one_line(const Broken& broken) {
  if (broken.none()) return {};
  return fmt::format("promise not kept: {}{}{}", fmt::join(broken.what, "; "), broken.remedy.empty() ? "" : "; ",
                     broken.remedy);
}

ExitCode exit_code(const Broken& broken, bool accepted) {
  return broken.none() || accepted ? kSucceeded : kPromiseNotKept;
}

}  // namespace orchard::apps
