#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "output/outputs.h"

// Pages of HTML that need no other file and no network. All commands with --report and `orchard report` share them.
namespace orchard::apps {

// What one run's part of a page shows.
struct ReportPage {
  nlohmann::json report;                   // with its provenance
  std::vector<std::string> pictures = {};  // the bytes of PNG files
  std::string certificate = {};            // what is proven, in a sentence; may be empty
  std::string doubts = {};                 // what should be looked at, in a sentence; may be empty
};

// With a picture, unless there are no bytes.
ReportPage page_of(const nlohmann::json& report, const std::string& picture);

// A page of one run, or one of several with an overview and a comparison of runs of the same command.
std::string to_html(const std::vector<ReportPage>& pages);

// "MODEL-COMMAND-report.html".
std::string page_name(const std::filesystem::path& model, const std::string& command);

// Writes the page of a run to a folder where its other files are written to. To be called after Outputs::add_report().
void write_report_page(const std::string& name, const ReportPage& page, Outputs& outputs);

}  // namespace orchard::apps
