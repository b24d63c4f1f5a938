#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "batch/merged_rows.h"
#include "svg_plot.h"

namespace orchard::apps {

// Returns the rows as one table. It has a column for each figure that any mesh has, in the order in which they first
// appear, one for repairs and one for notes. Texts with commas, quotes or line ends are quoted (RFC 4180).
std::string rows_csv(const MergedRows& rows);

// Returns a table with the columns mesh, seconds and peak_bytes.
std::string costs_csv(const MergedRows& rows);

// Returns how many meshes were solid, repaired, wrapped and failed, and why; what was repaired; and how tight the
// results are. It has no times, so it depends on the rows only.
nlohmann::json summary_of(const MergedRows& rows);

// Returns a plot of seconds against triangles, for 5,000 meshes at most (the title says so if there are more), and the
// histogram of the tightness. Either is left out if no mesh has a value.
std::vector<plot::Plot> plots_of(const MergedRows& rows);

}  // namespace orchard::apps
