#include "input/load_solid.h"

#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "command_line/number_text.h"
#include "input/reading_report.h"
#include "input/standard_input.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/noise.h"
#include "orchard/geometry/unite.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

double parse_offset(const std::string& text) {
  const std::optional<double> offset = finite_number(text);
  if (!offset || !(*offset > 0 && *offset < 1))
    throw InputError("--wrap=" + text + ": expected a fraction of the diagonal between 0 and 1, such as " +
                     kDefaultWrap);
  return *offset;
}

SolidMesh strict(const std::string& name, TriangleMesh mesh, BoundingBall ball) {
  Surface surface(std::move(mesh), ball);
  if (!surface.solid())
    throw InputError(name + ": the mesh is not a closed, consistently oriented manifold: " + surface.report().faults() +
                     "; without --strict, orchard repairs what is safe to repair");
  return {.surface = std::move(surface),
          .reading = {},
          .repair = {.solid = true},
          .repair_distance = {},
          .wrap = {},
          .self_intersections = {}};
}

SolidMesh wrapped(TriangleMesh mesh, const WrapOptions& options, BoundingBall ball, const Progress& progress) {
  report_progress(progress, "wrap", 0);
  SolidMesh solid{.surface = Surface(wrap_mesh(mesh, options), ball),
                  .reading = {},
                  .repair = {.solid = true},
                  .repair_distance = {},
                  .wrap = {},
                  .self_intersections = {}};
  const Surface input(std::move(mesh));
  solid.wrap = WrapResult{.options = options,
                          .to_input = surface_distance(solid.surface, input, {}, progress),
                          .from_input = surface_distance(input, solid.surface, {}, progress)};
  return solid;
}

// Without a number in the message, no note on how triangles are counted is needed.
std::string with_note_on_numbers(const std::string& faults) {
  return faults.find_first_of("0123456789") == std::string::npos ? faults : faults + " (numbers count from 0)";
}

RepairMeshOptions repair_options(const MeshOptions& options) {
  RepairMeshOptions repair = apps::repair_options(options.join);
  if (options.fill_holes) {
    repair.max_hole_diameter = *options.fill_holes;
    repair.max_hole_edges = std::numeric_limits<Index>::max();
  }
  return repair;
}

SolidMesh repaired(const std::string& name, TriangleMesh mesh, const MeshOptions& options, const Progress& progress) {
  TriangleMesh input = mesh;
  const BoundingBall ball = options.ball;
  const RepairMeshOptions limits = repair_options(options);
  MeshRepairReport repair = repair_mesh(mesh, limits);
  if (!repair.solid)
    throw InputError(name +
                     ": the mesh is no closed manifold, even after repair: " + with_note_on_numbers(repair.faults) +
                     holes_left(repair, limits) + "; --wrap builds on a closed skin around it instead");
  SolidMesh solid{.surface = Surface(std::move(mesh), ball),
                  .reading = {},
                  .repair = std::move(repair),
                  .repair_distance = {},
                  .wrap = {},
                  .self_intersections = {}};
  if (solid.repair.changed()) solid.repair_distance = repair_distance(input, solid.surface, progress);
  return solid;
}

// Replaces parts that cut each other by their union, where there is one.
void unite(SolidMesh& solid, BoundingBall ball, const Progress& progress) {
  std::optional<UnitedMesh> united = unite_parts(solid.surface.mesh(), progress);
  if (!united) return;
  solid.united = UnionResult{.parts = united->parts, .cut_before = united->cut_before, .cut_left = united->cut_left};
  solid.self_intersections = united->cut_left;
  solid.surface = Surface(std::move(united->mesh), ball);
}

// Replaces the surface by one without its noise, unless the noise is negligible.
void smooth(SolidMesh& solid, const MeshOptions& options, const Progress& progress) {
  NoiseResult noise{.estimated = options.noise == "auto"};
  const TriangleMesh& mesh = solid.surface.mesh();
  noise.deviation = noise.estimated ? noise_deviation(mesh) : *finite_number(options.noise) / 100;
  if (noise.deviation > kMaxNoise)
    throw InputError(
        fmt::format("the noise was estimated as {:.2g} % of the diagonal, more than the {:.2g} % that can "
                    "be smoothed away; give a smaller percentage to --noise, or take --wrap",
                    100 * noise.deviation, 100 * kMaxNoise));
  if (!noise.estimated || noise.deviation > kNegligibleNoise) {
    DenoisedMesh smoothed = denoise(mesh, {.deviation = noise.deviation}, progress);
    noise.rounds = smoothed.rounds;
    noise.moved_rms = smoothed.moved_rms;
    noise.moved_max = smoothed.moved_max;
    solid.surface = Surface(std::move(smoothed.mesh), options.ball);
    if (!solid.surface.solid())
      throw InputError("without its noise the mesh is no solid any more; give a smaller percentage to --noise");
  }
  solid.noise = noise;
}

json noise_json(const NoiseResult& noise) {
  return {{"estimated", noise.estimated},
          {"deviation_over_diagonal", noise.deviation},
          {"rounds", noise.rounds},
          {"moved_rms_over_diagonal", noise.moved_rms},
          {"moved_max_over_diagonal", noise.moved_max}};
}

std::string in_words(const NoiseResult& noise) {
  std::string text = fmt::format("noise of {:.2g} % of the diagonal{}", 100 * noise.deviation,
                                 noise.estimated ? ", as estimated," : "");
  if (noise.rounds == 0) return text + " was left: it is too low to matter";
  return text + fmt::format(" was smoothed away; no vertex moved by more than {:.2g} % of the diagonal",
                            100 * noise.moved_max);
}

json bounds(const SurfaceDistance& distance) { return {distance.lower, distance.upper}; }

}  // namespace

RepairMeshOptions repair_options(std::optional<double> join) {
  RepairMeshOptions repair;
  if (join) repair.join_distance = *join;
  return repair;
}

std::string holes_left(const MeshRepairReport& repair, const RepairMeshOptions& limits) {
  if (repair.holes_left == 0) return {};
  // The width that suffices, rounded up so that the printed value can be given as it is.
  const double enough = std::ceil(repair.max_hole_left * 100) / 100;
  const std::string of_edges = limits.max_hole_edges == std::numeric_limits<Index>::max()
                                   ? ""
                                   : fmt::format(" or of more than {} edges", limits.max_hole_edges);
  return fmt::format(
      "; {} hole{} left open, {}of {} edges, {:.2g} bounding radii across: holes wider than {:g}{} are; "
      "--fill-holes {:g} fills {}",
      repair.holes_left, repair.holes_left == 1 ? "" : "s", repair.holes_left == 1 ? "" : "the widest ",
      repair.edges_of_hole_left, repair.max_hole_left, limits.max_hole_diameter, of_edges, enough,
      repair.holes_left == 1 ? "it" : "them");
}

SolidMesh load_solid(const std::filesystem::path& file, const MeshOptions& options, const Progress& progress) {
  WrapOptions wrap{.alpha = options.wrap_alpha};
  if (!options.wrap.empty()) wrap.offset = parse_offset(options.wrap);
  auto [mesh, reading] = read_input(file, options.input, progress);
  const std::string name = file.string();
  if (options.strict) require_complete(name, reading);
  if (!options.wrap.empty()) {
    try {
      SolidMesh solid = wrapped(std::move(mesh), wrap, options.ball, progress);
      solid.reading = std::move(reading);
      return solid;
    } catch (const InputError& error) {
      throw InputError(name + ": " + error.what());
    }
  }
  SolidMesh solid =
      options.strict ? strict(name, std::move(mesh), options.ball) : repaired(name, std::move(mesh), options, progress);
  if (!options.noise.empty()) {
    try {
      smooth(solid, options, progress);
    } catch (const InputError& error) {
      throw InputError(name + ": " + error.what());
    }
  }
  if (solid.surface.mesh().triangles.size() <= kMaxForSelfIntersections)
    solid.self_intersections = solid.surface.self_intersections().size();
  if (options.unite && !options.strict && solid.self_intersections.value_or(0) > 0)
    unite(solid, options.ball, progress);
  solid.reading = std::move(reading);
  return solid;
}

RepairedMesh read_repaired(const std::filesystem::path& file, const MeshInput& input, std::optional<double> join) {
  auto [mesh, reading] = read_input(file, input);
  TriangleMesh copy = mesh;
  MeshRepairReport repair = repair_mesh(copy, repair_options(join));
  if (!repair.solid)
    return {
        .mesh = std::move(mesh), .reading = std::move(reading), .repair = {.faults = repair.faults}, .distance = {}};
  RepairDistance distance;
  if (repair.changed()) distance = repair_distance(mesh, Surface(copy));
  return {.mesh = std::move(copy), .reading = std::move(reading), .repair = std::move(repair), .distance = distance};
}

void print_repair(const std::filesystem::path& file, const MeshRepairReport& repair, const RepairDistance& distance,
                  double bounding_radius) {
  for (const std::string& line : repair.lines()) fmt::print("{}: {}\n", shown(file), line);
  if (repair.changed()) fmt::print("{}: repaired: {}\n", shown(file), in_words(distance, bounding_radius));
}

void print_solid(const std::filesystem::path& file, const SolidMesh& solid) {
  print_reading(file, solid.reading);
  print_repair(file, solid.repair, solid.repair_distance, solid.surface.bounding_radius());
  if (solid.noise) fmt::print("{}: {}\n", file.string(), in_words(*solid.noise));
  if (solid.united)
    fmt::print("{}: {} parts that cut each other in {} pairs of triangles were replaced by their union\n", shown(file),
               solid.united->parts, solid.united->cut_before);
  if (solid.self_intersections.value_or(0) > 0)
    fmt::print(
        "{}: {} pair{} of triangles cut or touch each other; inside is what the surface winds around; --wrap makes one "
        "skin of them\n",
        shown(file), *solid.self_intersections, *solid.self_intersections == 1 ? "" : "s");
  if (!solid.wrap) return;
  const double radius = solid.surface.bounding_radius();
  fmt::print(
      "{}: wrapped, with {} triangles; no point of the wrap is farther than {:.6g} ({:.5f} of the bounding "
      "radius) from the input, no point of the input farther than {:.6g} from the wrap\n",
      shown(file), solid.surface.mesh().triangles.size(), solid.wrap->distance(), solid.wrap->distance() / radius,
      solid.wrap->from_input.upper);
}

std::string certificate(const SolidMesh& solid, const std::filesystem::path& written) {
  const double radius = solid.surface.bounding_radius();
  std::string subject = "the surface", distance;
  if (solid.wrap) {
    subject = "the wrap, " + written.string() + ",";
    distance = fmt::format(
        "; no point of the wrap is farther than {:.6g} ({:.5f} of the bounding radius) from the mesh, no point of the "
        "mesh farther than {:.6g} ({:.5f}) from the wrap",
        solid.wrap->to_input.upper, solid.wrap->to_input.upper / radius, solid.wrap->from_input.upper,
        solid.wrap->from_input.upper / radius);
  } else if (solid.changed()) {
    subject = std::string(solid.united ? "the union of the parts, " : "the repaired mesh, ") + written.string() + ",";
    if (solid.repair.changed()) distance = "; " + in_words(solid.repair_distance, radius);
  }
  return "conservative: every point of " + subject + " is certified to lie in all spheres of a root-to-leaf path" +
         distance;
}

json to_json(const MeshRepairReport& repair, const RepairDistance& distance, double bounding_radius) {
  json report{{"vertices_welded", repair.vertices_welded},
              {"vertices_joined", repair.vertices_joined},
              {"max_join", repair.max_join},
              {"max_join_over_radius", repair.max_join / bounding_radius},
              {"unused_vertices_dropped", repair.unused_vertices_dropped},
              {"degenerate_dropped", repair.degenerate_dropped},
              {"neighbors_split", repair.neighbors_split},
              {"duplicates_dropped", repair.duplicates_dropped},
              {"flipped", repair.flipped},
              {"edges_cut", repair.edges_cut},
              {"vertices_split", repair.vertices_split},
              {"cracks_closed", repair.cracks_closed},
              {"cracks_triangles", repair.cracks_triangles},
              {"holes_filled", repair.holes_filled},
              {"triangles_added", repair.triangles_added},
              {"max_hole", repair.max_hole},
              {"parts_turned_outward", repair.parts_turned_outward},
              {"cavities_turned_inward", repair.cavities_turned_inward},
              {"lines", repair.lines()}};
  add_json(distance, bounding_radius, report);
  const std::string warning = hole_warning(repair, distance, bounding_radius);
  report["warning"] = warning.empty() ? json() : json(warning);
  return report;
}

void add_solid_json(const SolidMesh& solid, json& report) {
  report["reading"] = reading_json(solid.reading);
  if (!solid.wrap) {
    report["repair"] = to_json(solid.repair, solid.repair_distance, solid.surface.bounding_radius());
    if (solid.noise) report["noise"] = noise_json(*solid.noise);
    report["self_intersections"] = solid.self_intersections ? json(*solid.self_intersections) : json();
    report["union"] =
        !solid.united ? json()
                      : json{{"parts", solid.united->parts}, {"self_intersections_before", solid.united->cut_before}};
    return;
  }
  report["wrap"] = {{"alpha_over_diagonal", solid.wrap->options.alpha},
                    {"offset_over_diagonal", solid.wrap->options.offset},
                    {"wrap_to_input", bounds(solid.wrap->to_input)},
                    {"input_to_wrap", bounds(solid.wrap->from_input)}};
  report["wrap_distance"] = solid.wrap->distance();
  report["wrap_distance_over_radius"] = solid.wrap->distance() / solid.surface.bounding_radius();
}

}  // namespace orchard::apps
