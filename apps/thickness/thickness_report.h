#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "orchard/medial/thickness.h"

// What `orchard thickness` says about a solid, for people and for programs.
namespace orchard::apps {

struct ThicknessReport {
  const LocalThickness& thickness;
  const ThicknessOptions& options;
  std::string unit;             // empty: mesh units
  std::optional<double> below;  // the limit that regions are thinner than
  ThinRegions thin;             // than that, or than nothing
  ThicknessHistogram histogram;
};

nlohmann::json to_json(const ThicknessReport& report);
void print(const ThicknessReport& report);

// The histogram: a line "from,to,thickness_area,ball_diameter_area" and a line for each bin.
std::string to_csv(const ThicknessReport& report);
void write_plot(const std::filesystem::path& svg, const ThicknessReport& report);

}  // namespace orchard::apps
