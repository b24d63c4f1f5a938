#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace orchard::apps {

// What the page of a build shows.
struct BuildPage {
  std::string title, command_line;
  std::string certificate, doubts;  // the lines that the build ends with; doubts may be empty
  nlohmann::json report;            // build_json() and what was added to it
  std::string plot;                 // of the levels, an SVG
  std::string picture;              // of the pipeline, the bytes of a PNG; may be empty
};

// One page of HTML that needs no other file and no network.
std::string to_html(const BuildPage& page);

}  // namespace orchard::apps
