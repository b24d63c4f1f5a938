#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace orchard::apps {

// Returns the figures of a row, by name: first those of every command (triangles, volume, ..), then those of this
// command (for a build `level_2_mean_inaccuracy_over_radius`, ..). `tightness` is how far the result is from the
// surface: the mean inaccuracy of a tree's last level over the bounding radius; of an axis the larger of its two proven
// distances over the diagonal; of a sphere set the mean two-sided distance over the diagonal. A figure that a report
// lacks is left out.
nlohmann::ordered_json figures_of(const nlohmann::json& report, const std::string& command);

}  // namespace orchard::apps
