#include "leaderboard/leaderboard_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "medial/medial_measures.h"
#include "svg_plot.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

// A column of the Markdown table.
struct MeasureColumn {
  const char* title;
  const char* measure;
  int digits;
  int better;  // -1: the least is the best, 1: the largest, 0: neither
};
constexpr MeasureColumn kColumns[] = {{"max", "hausdorff_max", 3, -1},
                                      {"mean", "hausdorff_mean", 4, -1},
                                      {"left open, proven", "coverage_upper", 3, -1},
                                      {"sticks out, proven", "protrusion_upper", 3, -1},
                                      {"Chamfer", "chamfer", 4, -1},
                                      {"radius error", "radius_error_mean", 4, 0},
                                      {"covered", "covered", 4, 0},
                                      {"Q", "triangle_quality_mean", 3, 1},
                                      {"Q < .1", "triangle_quality_below", 3, -1},
                                      {"small sheets", "small_sheets", 0, -1},
                                      {"border turns", "border_turns", 3, -1}};

std::string number(double value, int digits) { return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, digits); }

// Rows of one model at one number of balls follow each other.
bool same_group(const LeaderboardRow& a, const LeaderboardRow& b) { return a.model == b.model && a.asked == b.asked; }

std::string betti(const LeaderboardRow& row) {
  const std::string three =
      fmt::format("{:.0f} {:.0f} {:.0f}", row.value("components"), row.value("loops"), row.value("cavities"));
  return row.topology_right() ? "right" : "**wrong**: " + three;
}

class MarkdownTable {
 public:
  explicit MarkdownTable(const std::vector<LeaderboardRow>& rows) : rows_(rows) {}

  std::string run() {
    text_ = "| mesh | N | system | balls |";
    std::string rule = "|---|--:|---|--:|";
    for (const MeasureColumn& column : kColumns) text_ += fmt::format(" {} |", column.title), rule += "--:|";
    text_ += " topology | notes |\n" + rule + "---|---|\n";
    for (std::size_t i = 0; i < rows_.size();) {
      std::size_t end = i + 1;
      while (end < rows_.size() && same_group(rows_[i], rows_[end])) ++end;
      for (; i < end; ++i) add(rows_[i], begin_of(i), end);
    }
    for (std::size_t i = 0; i < notes_.size(); ++i) text_ += fmt::format("\n{}. {}", i + 1, notes_[i]);
    return text_ + (notes_.empty() ? "" : "\n");
  }

 private:
  std::size_t begin_of(std::size_t i) const {
    while (i > 0 && same_group(rows_[i - 1], rows_[i])) --i;
    return i;
  }
  bool is_best(const LeaderboardRow& row, const MeasureColumn& column, std::size_t begin, std::size_t end) const {
    const double own = row.value(column.measure);
    std::size_t others = 0;
    for (std::size_t i = begin; i < end; ++i) {
      if (&rows_[i] == &row || !rows_[i].comparable()) continue;
      const double other = rows_[i].value(column.measure);
      if (std::isnan(other)) continue;
      ++others;
      if (column.better * (other - own) > 0) return false;
    }
    return column.better != 0 && others > 0 && row.comparable() && !std::isnan(own);
  }
  std::string note(const std::string& words) {
    auto at = std::find(notes_.begin(), notes_.end(), words);
    if (at == notes_.end()) at = notes_.insert(notes_.end(), words);
    return fmt::format("{}", at - notes_.begin() + 1);
  }
  void add(const LeaderboardRow& row, std::size_t begin, std::size_t end) {
    text_ += fmt::format("| {} | {} | {} | {} |", row.model, row.asked, row.system, row.balls);
    std::string numbers;
    for (const std::string& words : row.notes) numbers += (numbers.empty() ? "" : ", ") + note(words);
    if (!row.refused.empty()) {
      for (std::size_t i = 0; i < std::size(kColumns); ++i) text_ += " - |";
      text_ += " - | " + note("not measured: " + row.refused) + " |\n";
      return;
    }
    for (const MeasureColumn& column : kColumns) {
      const std::string value = number(row.value(column.measure), column.digits);
      text_ += is_best(row, column, begin, end) ? fmt::format(" **{}** |", value) : fmt::format(" {} |", value);
    }
    text_ += fmt::format(" {} | {} |\n", betti(row), numbers);
  }

  const std::vector<LeaderboardRow>& rows_;
  std::vector<std::string> notes_;
  std::string text_;
};

std::string percent(std::size_t part, std::size_t all) {
  return all == 0 ? "-"
                  : fmt::format("{} of {} ({:.0f} %)", part, all,
                                100.0 * static_cast<double>(part) / static_cast<double>(all));
}

}  // namespace

LeaderboardScore score(const std::vector<LeaderboardRow>& rows) {
  LeaderboardScore score;
  for (const LeaderboardRow& row : rows) {
    if (row.own || !row.comparable()) continue;
    const LeaderboardRow* best = nullptr;
    for (const LeaderboardRow& own : rows) {
      if (!own.own || !same_group(own, row) || !own.comparable() || own.balls > std::max(row.balls, row.asked))
        continue;
      if (best == nullptr || own.value("hausdorff_max") < best->value("hausdorff_max")) best = &own;
    }
    if (best == nullptr) continue;
    ++score.pairs;
    const bool max = best->value("hausdorff_max") < row.value("hausdorff_max");
    const bool mean = best->value("hausdorff_mean") < row.value("hausdorff_mean");
    score.lower_max += max, score.lower_mean += mean, score.right += best->topology_right();
    if (max && mean) continue;
    score.behind.push_back(fmt::format("{} at {}: {} has {:.3f} / {:.4f}, {} {:.3f} / {:.4f}", row.model, row.asked,
                                       row.system, row.value("hausdorff_max"), row.value("hausdorff_mean"),
                                       best->system, best->value("hausdorff_max"), best->value("hausdorff_mean")));
  }
  return score;
}

std::string to_markdown(const std::vector<LeaderboardRow>& rows, const std::vector<std::string>& skipped,
                        const std::vector<std::pair<std::string, std::string>>& plots) {
  const LeaderboardScore all = score(rows);
  std::string text = fmt::format(
      "Of {} pairs of an axis of another system and orchard's best at the same number of balls or fewer, orchard's "
      "two-sided maximum is "
      "lower in {}, its mean in {}, and its topology is the solid's in {}.\n\n"
      "Lengths are in % of the diagonal of the mesh's box. Max and mean: two-sided distance of the surface and the "
      "boundary of the axis' "
      "balls. N is the number of balls that was asked for. In bold: the best of its mesh and N, among those that are "
      "comparable. "
      "medial-measures.md defines each column.\n\n",
      all.pairs, percent(all.lower_max, all.pairs), percent(all.lower_mean, all.pairs), percent(all.right, all.pairs));
  text += MarkdownTable(rows).run();
  if (!all.behind.empty()) text += "\nWhere orchard is not lower in both (max / mean):\n\n";
  for (const std::string& words : all.behind) text += "- " + words + "\n";
  std::string apart;
  for (const LeaderboardRow& row : rows) {
    if (row.refused.empty() && !row.comparable())
      apart += fmt::format("- {} ({}): balls without cells\n", row.file, row.system);
  }
  if (!apart.empty())
    text +=
        "\nNot compared: what lies between balls is not in these files, so that their distances are those of another "
        "thing.\n\n" +
        apart;
  if (!skipped.empty()) text += "\nFiles that are no entry:\n\n";
  for (const std::string& words : skipped) text += "- " + words + "\n";
  if (!plots.empty()) text += "\n";
  for (const auto& [model, file] : plots)
    text += fmt::format("![distance against the number of balls, {}]({})\n", model, file);
  return text;
}

std::string to_csv(const std::vector<LeaderboardRow>& rows) {
  std::string text = "model,asked,system,own,balls,edges,triangles,comparable,file";
  for (const MedialMeasure& measure : medial_measures()) text += std::string(",") + measure.name;
  text += '\n';
  for (const LeaderboardRow& row : rows) {
    text += fmt::format("{},{},{},{},{},{},{},{},{}", row.model, row.asked, row.system, static_cast<int>(row.own),
                        row.balls, row.edges, row.triangles, static_cast<int>(row.comparable()), row.file);
    for (const MedialMeasure& measure : medial_measures()) {
      const double value = row.value(measure.name);
      text += std::isnan(value) ? std::string(",") : fmt::format(",{:.9g}", value);
    }
    text += '\n';
  }
  return text;
}

json to_json(const std::vector<LeaderboardRow>& rows, const std::vector<std::string>& skipped) {
  const LeaderboardScore all = score(rows);
  json units = json::object();
  for (const MedialMeasure& measure : medial_measures()) units[measure.name] = measure.unit;
  json list = json::array();
  for (const LeaderboardRow& row : rows) {
    json own = to_json(row);
    own["comparable"] = row.comparable();
    list.push_back(std::move(own));
  }
  return {{"schema", "orchard-leaderboard-1"},
          {"units", units},
          {"rows", list},
          {"skipped", skipped},
          {"score",
           {{"pairs", all.pairs},
            {"lower_max", all.lower_max},
            {"lower_mean", all.lower_mean},
            {"topology_right", all.right},
            {"behind", all.behind}}}};
}

std::string to_svg(const std::vector<LeaderboardRow>& rows, const std::string& model) {
  std::vector<plot::Plot> plots;
  for (const auto& [measure, title] :
       {std::pair{"hausdorff_max", "largest distance"}, {"hausdorff_mean", "mean distance"}}) {
    plot::Plot plot;
    plot.title = fmt::format("{}: {}", model, title);
    plot.x_label = "balls";
    plot.y_label = "% of the diagonal";
    plot.log_x = plot.log_y = true;
    std::map<std::string, plot::Series> series;
    for (const LeaderboardRow& row : rows) {
      if (row.model != model || !row.comparable()) continue;
      plot::Series& own = series[row.system];
      own.name = row.system;
      own.kind = plot::Series::Kind::line;
      own.x.push_back(row.balls);
      own.y.push_back(row.value(measure));
    }
    for (auto& [system, own] : series) plot.series.push_back(std::move(own));
    plots.push_back(std::move(plot));
  }
  return plot::to_svg(plots, 2);
}

}  // namespace orchard::apps
