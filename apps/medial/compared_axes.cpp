#include "medial/compared_axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <sstream>

#include "medial/own_axis.h"
#include "orchard/geometry/error.h"
#include "orchard/medial/simplify.h"
#include "output/picture.h"
#ifdef ORCHARD_HAS_VIZ
#include "orchard/viz/view.h"
#endif

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;

QualityOptions quality_of(const CompareCommand& command) {
  const Index tenth = std::max(Index{1}, command.quality_samples / 10);
  return {.surface_samples = command.quality_samples,
          .contact_cells = tenth,
          .economy_candidates = tenth,
          .economy_samples = tenth,
          .seed = command.seed};
}

ComparedAxis foreign_axis(const CompareCommand& command, const Surface& surface, const fs::path& file, ForeignAxis read,
                          const Progress& progress) {
  PlacedAxis placed = place_axis(surface, std::move(read), {.connect = command.connect});
  ComparedAxis axis{.name = file.filename().string(), .mesh = std::move(placed.mesh), .notes = std::move(placed.notes)};
  axis.whole = axis.mesh.size();
  if (command.vertices == 0 || axis.whole <= command.vertices) return axis;
  try {
    const SimplifyOptions options{.vertices = command.vertices, .seed = command.seed};
    axis.mesh = simplify_medial_mesh(surface, axis.mesh, options, progress).mesh;
    axis.simplified = true;
  } catch (const InputError& error) {
    axis.notes.push_back(fmt::format("cannot be simplified to {} balls, so it is measured as it is: {}",
                                     command.vertices, error.what()));
  }
  return axis;
}

// Orchard's axes by their numbers of balls; those that the topology does not allow are missing.
std::map<Index, MedialMesh> own_axes(const CompareCommand& command, const Surface& surface,
                                     const std::set<Index, std::greater<>>& sizes, const Progress& progress) {
  MedialTuning tuning;
  tuning.samples = command.samples;
  tuning.options.sampling.seed = command.seed;
  const MedialMesh whole = axis_with_balls(surface, tuning, *sizes.begin(), progress);
  std::map<Index, MedialMesh> axes;
  std::vector<Index> fewer;
  for (const Index size : sizes) {
    if (size < whole.size()) {
      fewer.push_back(size);
    } else {
      axes.emplace(size, whole);
    }
  }
  if (fewer.empty()) return axes;
  const auto few = simplify_to_each(surface, whole, fewer, {.seed = command.seed}, progress);
  for (std::size_t i = 0; i < few.size(); ++i) axes.emplace(fewer[i], few[i].mesh);
  return axes;
}

// Whether a measure is known of every axis and is no column already.
bool in_table(const MedialMeasure& measure) {
  const std::string_view name = measure.name;
  return name != "balls" && !name.starts_with("distance_") && !name.starts_with("stability_");
}

std::string csv_head() {
  std::string head = "model,axis,balls,balls_of_file,edges,triangles";
  for (const MedialMeasure& measure : medial_measures())
    if (in_table(measure)) head += std::string(",") + measure.name;
  return head;
}

// A cell whose text may have commas.
std::string csv_word(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

std::vector<ComparedAxis> compared_axes(const CompareCommand& command, const Surface& surface,
                                        std::vector<ForeignAxis> files, const Progress& progress) {
  std::vector<ComparedAxis> foreign;
  std::set<Index, std::greater<>> sizes;
  for (std::size_t i = 0; i < files.size(); ++i) {
    foreign.push_back(foreign_axis(command, surface, command.files[i], std::move(files[i]), progress));
    sizes.insert(foreign.back().mesh.size());
  }
  std::map<Index, MedialMesh> own = own_axes(command, surface, sizes, progress);
  std::vector<ComparedAxis> all;
  for (ComparedAxis& axis : foreign) {
    axis.judgement = judge_mesh(surface, axis.mesh, quality_of(command), progress);
    const Index size = axis.mesh.size();
    all.push_back(std::move(axis));
    const auto mine = own.find(size);
    if (mine == own.end()) {
      const auto measured = [&](const ComparedAxis& one) { return one.own && one.whole == size; };
      if (std::none_of(all.begin(), all.end(), measured))
        all.back().notes.push_back(
            fmt::format("orchard has no axis of {} balls: the topology of the solid needs more", size));
      continue;
    }
    // Simplified to different numbers, an axis may have the same number of balls.
    const auto same = [&](const ComparedAxis& one) { return one.own && one.mesh.size() == mine->second.size(); };
    if (std::any_of(all.begin(), all.end(), same)) continue;
    ComparedAxis& added =
        all.emplace_back(ComparedAxis{.name = "orchard", .own = true, .mesh = std::move(mine->second)});
    added.whole = size;
    added.judgement = judge_mesh(surface, added.mesh, quality_of(command), progress);
    own.erase(mine);
  }
  std::stable_sort(all.begin(), all.end(), [](const ComparedAxis& a, const ComparedAxis& b) {
    const Index x = a.own ? a.whole : a.mesh.size(), y = b.own ? b.whole : b.mesh.size();
    return x < y || (x == y && a.own < b.own);
  });
  return all;
}

std::string compared_csv(const std::vector<ComparedAxis>& axes, const std::string& model) {
  std::string text = csv_head() + "\n";
  for (const ComparedAxis& axis : axes) {
    text += fmt::format("{},{},{},{},{},{}", csv_word(model), csv_word(axis.name), axis.mesh.size(),
                        axis.own ? std::string() : std::to_string(axis.whole), axis.mesh.edges.size(),
                        axis.mesh.triangles.size());
    for (const MedialMeasure& measure : medial_measures()) {
      if (!in_table(measure)) continue;
      const double value = measure.get(axis.judgement);
      text += std::isnan(value) ? std::string(",") : fmt::format(",{:.9g}", value);
    }
    text += '\n';
  }
  return text;
}

std::vector<std::string> rows_of_others(const fs::path& file, const std::string& model) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return {};
  std::ifstream in(file);
  std::vector<std::string> rows;
  std::string line;
  if (!std::getline(in, line) || line != csv_head())
    throw InputError(file.string() +
                     ", line 1: compare of this version did not write this table, so no rows can be added; choose "
                     "another name for --csv");
  const std::string own = csv_word(model) + ",";
  while (std::getline(in, line))
    if (!line.empty() && !line.starts_with('#') && !line.starts_with(own)) rows.push_back(line);
  return rows;
}

std::string with_other_rows(const std::string& table, std::vector<std::string> others) {
  std::istringstream in(table);
  std::string head, line;
  std::getline(in, head);
  while (std::getline(in, line)) others.push_back(line);
  std::stable_sort(others.begin(), others.end(), [](const std::string& a, const std::string& b) {
    return a.substr(0, a.find(',')) < b.substr(0, b.find(','));
  });
  std::string text = head + "\n";
  for (const std::string& row : others) text += row + "\n";
  return text;
}

#ifdef ORCHARD_HAS_VIZ
void draw_compared(const std::string& name, const std::string& up, const Surface& surface,
                   const std::vector<ComparedAxis>& axes, Outputs& outputs) {
  Scene scene;
  scene.meshes.push_back({"mesh", Surface(surface.mesh())});
  for (const ComparedAxis& axis : axes)
    scene.axes.push_back(
        {fmt::format("{}: {} balls, {:.2f} %", axis.name, axis.mesh.size(), 100 * axis.judgement.quality.hausdorff.max),
         axis.mesh});
  scene.figure.beside = true;
  scene.figure.edges = true;
  PipelinePicture picture;
  picture.title = name.substr(0, name.rfind('.'));
  picture.up = parse_up(up);
  picture.progress = cancelled_by_interrupts();
  if (is_drawn(draw_view(outputs.staged(name), scene, picture)))
    outputs.add(name, "the axes side by side in the solid");
}
#else
void draw_compared(const std::string&, const std::string&, const Surface&, const std::vector<ComparedAxis>&, Outputs&) {
}
#endif

}  // namespace orchard::apps
