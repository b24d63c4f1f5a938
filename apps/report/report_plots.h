#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "svg_plot.h"

// The charts of a report, drawn from what its JSON holds.
namespace orchard::apps {

// `kind` is the name of kind_of(). No plot is empty; kinds without anything to plot have none.
std::vector<plot::Plot> report_plots(const std::string& kind, const nlohmann::json& report);

// The same of one command, for its .svg file.
std::vector<plot::Plot> compare_plots(const nlohmann::json& report);  // of trees
std::vector<plot::Plot> profile_plots(const nlohmann::json& report);

// Whether a plot shows anything: two places at least that differ in x, or a bar that is not 0.
bool shows_something(const plot::Plot& plot);

}  // namespace orchard::apps
