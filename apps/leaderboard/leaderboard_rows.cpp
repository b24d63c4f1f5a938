#include "leaderboard/leaderboard_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <optional>
#include <set>
#include <tuple>

#include "medial/medial_measures.h"
#include "medial/medial_table.h"
#include "medial/medial_tuning.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/medial/build.h"
#include "orchard/medial/read_axis.h"
#include "orchard/medial/simplify.h"
#include "orchard/medial/structure.h"
#include "output/provenance.h"
#ifdef ORCHARD_HAS_VIZ
#include "orchard/viz/medial_writer.h"
#include "orchard/viz/vtk_writer.h"
#endif

namespace orchard::apps {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr int kCloser = 3;  // times that the errors allowed are halved: more takes long and gains little

std::optional<json> read_json(const fs::path& file) {
  std::ifstream in(file);
  if (!in) return std::nullopt;
  json value = json::parse(in, nullptr, false);
  if (value.is_discarded()) return std::nullopt;
  return value;
}

// The rows of one model, whose mesh is read only if one of them is missing.
class Model {
 public:
  Model(const fs::path& mesh, std::string name, const LeaderboardOptions& options, const fs::path& folder)
      : mesh_(mesh), name_(std::move(name)), options_(options), folder_(folder), checksum_(checksum_of(mesh)) {}

  LeaderboardRow measure(const LeaderboardEntry& entry, bool own) {
    const std::string key = key_of({checksum_of(entry.file), options_.connect});
    const fs::path kept = folder_ / "rows" / (entry.file.filename().string() + ".json");
    if (std::optional<json> known = read_json(kept); known && known->value("key", "") == key) {
      LeaderboardRow row = row_from(*known);
      if (has_views(row)) return row;
    }
    LeaderboardRow row{.model = name_, .system = entry.system, .file = entry.file.filename().string(), .own = own};
    try {
      fill(entry, row);
    } catch (const InputError& error) {
      row.refused = std::string(error.what());
      const std::string prefix = entry.file.string() + ": ";
      if (row.refused.starts_with(prefix)) row.refused.erase(0, prefix.size());
    }
    row.asked = entry.asked.value_or(row.balls);
    if (!entry.note.empty()) row.notes.push_back(entry.note);
    json value = to_json(row);
    value["key"] = key;
    write_file(kept, value.dump(1) + "\n");
    return row;
  }

  // Orchard's axes at these numbers of balls, which are descending, measured.
  std::vector<LeaderboardRow> build(const std::string& builder, const std::vector<Index>& counts) {
    const std::string system = builder == "refined" ? "orchard" : "orchard-" + builder;
    const std::string key = key_of({builder, counts, options_.samples});
    const fs::path list = folder_ / "axes" / (name_ + "-" + system + ".json");
    const std::optional<json> known = read_json(list);
    if (!known || known->value("key", "") != key) {
      const json made = build_axes(builder, system, counts);
      write_file(list, json{{"key", key}, {"counts", made}}.dump(1) + "\n");
    }
    std::vector<LeaderboardRow> rows;
    const json made = read_json(list)->at("counts");
    for (const Index count : counts) {
      const LeaderboardEntry entry{.mesh = mesh_,
                                   .file = axis_file(system, count),
                                   .model = name_,
                                   .system = system,
                                   .asked = count,
                                   .note = {}};
      if (std::find(made.begin(), made.end(), json(count)) != made.end()) {
        rows.push_back(measure(entry, true));
      } else {
        rows.push_back({.model = name_,
                        .system = system,
                        .file = {},
                        .asked = count,
                        .own = true,
                        .refused = "the topology of the solid needs more balls"});
      }
    }
    return rows;
  }

 private:
  // What a row or an axis is made of, in one word.
  std::string key_of(const json& more) const {
    return json{ORCHARD_VERSION, checksum_, options_.quality_samples, options_.seed, more}.dump();
  }
  fs::path axis_file(const std::string& system, Index count) const {
    return folder_ / "axes" / fmt::format("{}-{}-{}.ma", name_, system, count);
  }
  const SolidMesh& solid() {
    if (!solid_) solid_.emplace(load_solid(mesh_, {}));
    return *solid_;
  }

  void fill(const LeaderboardEntry& entry, LeaderboardRow& row) {
    const Surface& surface = solid().surface;
    const PlacedAxis axis = place_axis(surface, read_axis(entry.file), {.connect = options_.connect});
    row.notes = axis.notes;
    row.balls = axis.mesh.size();
    row.edges = static_cast<Index>(axis.mesh.edges.size());
    row.triangles = static_cast<Index>(axis.mesh.triangles.size());
    const QualityOptions quality{.surface_samples = options_.quality_samples,
                                 .contact_cells = options_.quality_samples / 10,
                                 .economy_candidates = options_.quality_samples / 10,
                                 .economy_samples = options_.quality_samples / 10,
                                 .seed = options_.seed};
    const MedialJudgement judgement = judge_mesh(surface, axis.mesh, quality);
    row.measures = to_json(judgement);
    std::vector<ReportedPlace> places;
    for (const WorstPlace& place : judgement.quality.worst) places.push_back({place, {}});
    row.worst = to_json(places);
    for (json& place : row.worst) place.erase("advice");
    write_views(row, axis.mesh, judgement.quality.worst);
  }

  // What leaderboard_states.h shows.
#ifdef ORCHARD_HAS_VIZ
  bool has_views(const LeaderboardRow& row) const {
    if (!row.refused.empty()) return true;
    const WorstFiles files = worst_files(row);
    return fs::exists(folder_ / files.mesh) && fs::exists(folder_ / files.ball) && fs::exists(folder_ / files.axis) &&
           fs::exists(folder_ / files.places);
  }
  void write_views(const LeaderboardRow& row, const MedialMesh& axis, const std::vector<WorstPlace>& worst) {
    const WorstFiles files = worst_files(row);
    const Surface& surface = solid().surface;
    const Sphere& ball = surface.bounding_ball();
    write_worst_places(folder_ / files.places, worst);
    write_medial_mesh(folder_ / files.axis, axis);
    write_mesh(folder_ / files.mesh, surface);
    write_file(folder_ / files.ball,
               json{ball.center.x(), ball.center.y(), ball.center.z(), ball.radius}.dump() + "\n");
  }
#else
  bool has_views(const LeaderboardRow&) const { return true; }
  void write_views(const LeaderboardRow&, const MedialMesh&, const std::vector<WorstPlace>&) {}
#endif

  // The refined axis is built more closely until it has enough balls for the largest number that is asked for.
  MedialMesh whole_axis(const std::string& builder, Index most) {
    const Surface& surface = solid().surface;
    MedialTuning tuning;
    tuning.refine = builder == "refined";
    tuning.samples = options_.samples;
    tuning.options.sampling.seed = options_.seed;
    MedialMesh axis = medial_mesh(build_medial_axis(surface, build_options(tuning)).axis);
    for (int closer = 0; tuning.refine && closer < kCloser && axis.size() < most; ++closer) {
      *tuning.samples *= 2;
      tuning.refinement.border_loss /= 2;
      tuning.refinement.tolerance /= 2;
      tuning.refinement.feature_loss /= 2;
      axis = medial_mesh(build_medial_axis(surface, build_options(tuning)).axis);
    }
    return axis;
  }

  // Returns the numbers of balls that there are axes for.
  json build_axes(const std::string& builder, const std::string& system, const std::vector<Index>& counts) {
    const Surface& surface = solid().surface;
    const MedialMesh axis = whole_axis(builder, counts.empty() ? 0 : counts.front());
    std::vector<Index> fewer;
    json made = json::array();
    for (const Index count : counts) {
      if (count < axis.size()) {
        fewer.push_back(count);
      } else {
        write(system, count, axis);
        made.push_back(count);
      }
    }
    if (fewer.empty()) return made;
    const std::vector<SimplifiedMedialMesh> few = simplify_to_each(surface, axis, fewer, {.seed = options_.seed});
    for (std::size_t i = 0; i < few.size(); ++i) {
      write(system, fewer[i], few[i].mesh);
      made.push_back(fewer[i]);
    }
    return made;
  }
  void write(const std::string& system, Index count, const MedialMesh& mesh) const {
    write_file(axis_file(system, count), to_ma(mesh) + to_structure_section(medial_structure(mesh)));
  }

  fs::path mesh_;
  std::string name_;
  const LeaderboardOptions& options_;
  const fs::path& folder_;
  std::string checksum_;
  std::optional<SolidMesh> solid_;
};

}  // namespace

double LeaderboardRow::value(const char* measure) const {
  const auto at = measures.find(measure);
  return at == measures.end() || !at->is_number() ? std::nan("") : at->get<double>();
}

WorstFiles worst_files(const LeaderboardRow& row) {
  const fs::path folder = "worst";
  return {.mesh = folder / (row.model + "-mesh.vtp"),
          .axis = folder / (row.file + "-axis.vtp"),
          .places = folder / (row.file + ".vtp"),
          .ball = folder / (row.model + "-ball.json")};
}

json to_json(const LeaderboardRow& row) {
  return {{"model", row.model},     {"system", row.system}, {"file", row.file},         {"asked", row.asked},
          {"balls", row.balls},     {"edges", row.edges},   {"own", row.own},           {"triangles", row.triangles},
          {"refused", row.refused}, {"notes", row.notes},   {"measures", row.measures}, {"worst", row.worst}};
}

LeaderboardRow row_from(const json& json) {
  LeaderboardRow row;
  json.at("model").get_to(row.model), json.at("system").get_to(row.system), json.at("file").get_to(row.file);
  json.at("asked").get_to(row.asked), json.at("balls").get_to(row.balls), json.at("edges").get_to(row.edges);
  json.at("triangles").get_to(row.triangles), json.at("own").get_to(row.own);
  json.at("refused").get_to(row.refused), json.at("notes").get_to(row.notes);
  row.measures = json.at("measures");
  row.worst = json.at("worst");
  return row;
}

std::vector<LeaderboardRow> measure_entries(const LeaderboardFolder& found, const LeaderboardOptions& options,
                                            const std::filesystem::path& folder, const Progress& progress) {
  fs::create_directories(folder / "rows");
  fs::create_directories(folder / "axes");
  fs::create_directories(folder / "worst");
  std::vector<LeaderboardRow> rows;
  const double all = static_cast<double>(std::max<std::size_t>(found.entries.size(), 1));
  for (std::size_t i = 0; i < found.entries.size();) {
    Model model(found.entries[i].mesh, found.entries[i].model, options, folder);
    std::set<Index, std::greater<>> counts(options.vertices.begin(), options.vertices.end());
    const std::string name = found.entries[i].model;
    for (; i < found.entries.size() && found.entries[i].model == name; ++i) {
      report_progress(progress, "leaderboard: " + found.entries[i].file.filename().string(),
                      static_cast<double>(i) / all);
      rows.push_back(model.measure(found.entries[i], false));
      if (rows.back().refused.empty()) counts.insert(rows.back().asked);
    }
    for (const std::string& builder : options.builders) {
      report_progress(progress, "leaderboard: orchard on " + name, static_cast<double>(i) / all);
      try {
        for (LeaderboardRow& row : model.build(builder, {counts.begin(), counts.end()})) rows.push_back(std::move(row));
      } catch (const InputError& error) {
        rows.push_back({.model = name, .system = "orchard", .file = {}, .own = true, .refused = error.what()});
      }
    }
  }
  std::sort(rows.begin(), rows.end(), [](const LeaderboardRow& a, const LeaderboardRow& b) {
    return std::tie(a.model, a.asked, a.own, a.system, a.file) < std::tie(b.model, b.asked, b.own, b.system, b.file);
  });
  return rows;
}

}  // namespace orchard::apps
