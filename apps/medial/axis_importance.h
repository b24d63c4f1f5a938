#pragma once
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/commands.h"
#include "orchard/geometry/stage_times.h"
#include "orchard/medial/build.h"
#include "output/outputs.h"

// What --importance and --prune-curve add to an axis: how much its balls matter, and what pruning by that costs.
namespace orchard::apps {

// The measures by the names that --prune gives them, but for the angle, which every axis has as contact_angle.
std::vector<std::string> importance_names();
// With the angle.
std::vector<std::string> prune_names();

// One value for each vertex: a factor for `scale`, else mesh units; NaN where it is infinite.
struct ImportanceArray {
  std::string name;  // of the array: border_loss, lambda, scale_ratio, erosion_thickness, medial_geodesic
  std::vector<double> values;
};

// The axis pruned at one value. Lengths are in percent of the diagonal.
struct PrunedRow {
  double value = 0;  // in the unit of --prune
  Index vertices = 0, faces = 0;
  double area = 0;  // of the faces, as a fraction of that of the axis
  double hausdorff_max = 0, hausdorff_mean = 0, coverage_max = 0, coverage_mean = 0;
};

struct AxisImportance {
  std::vector<ImportanceArray> arrays;
  std::vector<PrunedRow> curve;
  StageTimes seconds;
};

// Throws InputError where these options have no effect.
void check_importance(const MedialCommand& command);
// The files of --prune-curve.
std::vector<std::string> importance_file_names(const MedialCommand& command);
AxisImportance measure_importance(const MedialCommand& command, const Surface& surface, const MedialAxis& axis,
                                  const Progress& progress);
// Writes the files of --prune-curve, fills "prune_curve" and "importance_seconds" of the report, and prints the curve.
void write_importance(const MedialCommand& command, const AxisImportance& importance, nlohmann::json& report,
                      Outputs& outputs);

}  // namespace orchard::apps
