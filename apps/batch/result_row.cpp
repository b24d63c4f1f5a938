#include "batch/result_row.h"

#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <cstring>

#include "batch/mebibyte.h"
#include "batch/result_figures.h"
#include "command_line/exit_code.h"
#include "command_line/text.h"

namespace orchard::apps {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

// Joins the lines of the error output into one, without the program's name and the path of the mesh at their beginning.
std::string message_of(const std::string& err, const std::filesystem::path& mesh, const std::string& name,
                       const std::filesystem::path& folder) {
  std::string text = replaced(err, "orchard: " + mesh.string() + ": ", "");
  text = replaced(replaced(text, mesh.string(), name), folder.string(), "FOLDER");
  text = replaced(text, "orchard: ", "");
  while (text.ends_with('\n')) text.pop_back();
  return replaced(text, "\n", "; ");
}

ordered_json empty_row() {
  return {{"status", "failed"},
          {"why", nullptr},
          {"exit_code", nullptr},
          {"message", ""},
          {"repairs", ordered_json::object()},
          {"notes", ordered_json::array()},
          {"promise_kept", nullptr},
          {"figures", ordered_json::object()}};
}

ordered_json cost_json(double seconds, std::uint64_t peak_bytes, const WorkerLimits& limits) {
  return {{"seconds", seconds},
          {"peak_bytes", peak_bytes},
          {"limit_seconds", limits.seconds},
          {"limit_bytes", limits.bytes}};
}

void add_report(const json& report, const std::string& command, ordered_json& row) {
  const json none = json::object();
  const json& repair = report.contains("repair") ? report["repair"] : none;
  for (const auto& [count, value] : repair.items())
    if (value.is_number_integer() && value != 0) row["repairs"][count] = value;
  for (const char* part : {"reading", "repair", "wrap"}) {
    if (!report.contains(part) || !report[part].is_object()) continue;
    for (const json& line : report[part].value("lines", json::array())) row["notes"].push_back(line.get<std::string>());
  }
  row["status"] = report.contains("wrap")                        ? "wrapped"
                  : repair.value("lines", json::array()).empty() ? "solid"
                                                                 : "repaired";
  if (report.contains("promise")) row["promise_kept"] = report["promise"].value("kept", json());
  row["figures"] = figures_of(report, command);
}

// Returns the reason for an end without a result.
std::string why_of(const WorkerEnd& end) {
  if (end.cause == WorkerEnd::Cause::out_of_time) return "timeout";
  if (end.cause == WorkerEnd::Cause::out_of_memory) return "memory";
  if (end.cause == WorkerEnd::Cause::signalled) return end.number == SIGKILL ? "killed" : "crashed";
  // 128 + a signal after which the worker ended in an orderly way.
  if (end.number > kInterrupted - SIGINT) return "killed";
  return end.number == kBadInput ? "refused" : "error";
}

std::string words_of(const std::string& why, const WorkerEnd& end, const WorkerLimits& limits) {
  if (why == "timeout") return fmt::format("stopped after {:g} s, the limit of --timeout", limits.seconds);
  if (why == "memory")
    return fmt::format("stopped above {:g} MiB, the limit of --memory", static_cast<double>(limits.bytes) / kMebibyte);
  if (end.cause == WorkerEnd::Cause::signalled) return fmt::format("ended by signal {}", sigabbrev_np(end.number));
  return {};
}

}  // namespace

MeshResult result_of(const WorkerEnd& end, const std::string& command, const std::filesystem::path& mesh,
                     const std::string& name, const std::filesystem::path& folder, const WorkerLimits& limits) {
  MeshResult result{.row = empty_row(), .cost = cost_json(end.seconds, end.peak_bytes, limits)};
  ordered_json& row = result.row;
  row["message"] = message_of(end.err, mesh, name, folder);
  const bool exited = end.cause == WorkerEnd::Cause::exited;
  if (exited) row["exit_code"] = end.number;
  if (exited && (end.number == kSucceeded || end.number == kPromiseNotKept)) {
    const json report = end.out_whole ? json::parse(end.out, nullptr, false) : json();
    if (report.is_object()) {
      add_report(report, command, row);
      return result;
    }
    row["message"] = "the command printed no report";
  }
  const std::string why = why_of(end), words = words_of(why, end, limits);
  row["why"] = why;
  if (!words.empty()) row["message"] = words;
  result.lasting = why != "killed" && why != "error";
  return result;
}

MeshResult refused_result(const std::string& message, const WorkerLimits& limits) {
  MeshResult result{.row = empty_row(), .cost = cost_json(0, 0, limits)};
  result.row["why"] = "memory";
  result.row["message"] = message;
  return result;
}

bool outgrown(const MeshResult& earlier, const WorkerLimits& limits) {
  const auto larger = [](double now, double then) { return now == 0 ? then > 0 : now > then && then > 0; };
  if (earlier.row["why"] == "timeout") return larger(limits.seconds, earlier.cost.value("limit_seconds", 0.0));
  if (earlier.row["why"] == "memory")
    return larger(static_cast<double>(limits.bytes), earlier.cost.value("limit_bytes", 0.0));
  return false;
}

}  // namespace orchard::apps
