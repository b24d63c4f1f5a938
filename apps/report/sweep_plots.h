#pragma once
#include <nlohmann/json.hpp>
#include <vector>

#include "svg_plot.h"

namespace orchard::apps {

// What a sweep's runs give for what they cost: distances against balls, length of borders and seconds. A line leads
// through the values of the first option that was swept, with a line for each combination of the others. Plots of
// measures that are the same in all runs are left out. `report` is that of `orchard medial --sweep`.
std::vector<plot::Plot> trade_off_plots(const nlohmann::json& report);

}  // namespace orchard::apps
