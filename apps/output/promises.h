#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command_line/exit_code.h"
#include "medial/medial_simplify.h"
#include "orchard/medial/promise.h"
#include "orchard/spheretree/build.h"

// What a command promises about its results. If a promise is broken, everything is written nevertheless, and the last
// line, the report and the exit code say so.
namespace orchard::apps {

// Promises that are not known to hold, each as a part of a sentence with numbers. A promise that could neither be
// proven nor disproved counts as broken.
struct Broken {
  std::vector<std::string> what;
  std::string remedy;  // what may help; may be empty

  bool none() const { return what.empty(); }
  void add(const Broken& others);
};

Broken broken(const PromiseCheck& check);
nlohmann::json to_json(const PromiseCheck& check);

// Of the simplified axis: no more balls than were asked for, no farther off than was asked for, and the topology
// `wanted`.
Broken broken(const FewBalls& few, const SimplifyOptions& options, const Topology& wanted);

// Of a tree: where a node without children is looser than --error or --region allow. Lengths in mesh units.
Broken broken(const SphereTreeBuild& build, const Refinement& refinement);

// The last line of a command that broke a promise, without its newline; empty if none is broken.
std::string in_one_line(const Broken& broken);
// kPromiseNotKept if something is broken and that was not accepted beforehand (--accept).
ExitCode exit_code(const Broken& broken, bool accepted);

}  // namespace orchard::apps
