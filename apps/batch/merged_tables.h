#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "batch/merged_rows.h"
#include "svg_plot.h"

namespace orchard::apps {

// The rows as one table: a column for each figure that any mesh has, in the order in which they first appear; repairs
// and notes in a column each. Texts with commas, quotes or line ends are quoted (RFC 4180).
std::string rows_csv(const MergedRows& rows);

// mesh, seconds, peak_bytes.
std::string costs_csv(const MergedRows& rows);

// How many meshes were solid, repaired, wrapped and failed, and why; what was repaired; how tight the results are. It
// holds no times, so that it depends on the rows alone.
nlohmann::json summary_of(const MergedRows& rows);

// Seconds against triangles, of 5,000 meshes at most (then the title says so), and the histogram of the tightness;
// either is left out where no mesh has a value.
std::vector<plot::Plot> plots_of(const MergedRows& rows);

}  // namespace orchard::apps
