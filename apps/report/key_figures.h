#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace orchard::apps {

// A number that a reader looks for first.
struct KeyFigure {
  std::string title;
  nlohmann::json value;
};

// Those of a report, by the name of kind_of(). What the report does not have is left out.
std::vector<KeyFigure> key_figures(const std::string& kind, const nlohmann::json& report);

}  // namespace orchard::apps
