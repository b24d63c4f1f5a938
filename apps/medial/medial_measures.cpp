#include "medial/medial_measures.h"

#include <algorithm>
#include <cmath>

namespace orchard::apps {
namespace {

using J = MedialJudgement;

constexpr const char* kDiagonal = "% of the diagonal";
constexpr double kMaxUncovered =
    0.01;  // of the surface: a cover that leaves more is none, and has no number of spheres

double percent(double fraction) { return 100 * fraction; }
double number(std::int64_t count) { return static_cast<double>(count); }
double not_defined() { return std::nan(""); }

std::vector<MedialMeasure> reconstruction_measures() {
  return {{"hausdorff_max", "Hausdorff distance, max", kDiagonal, true,
           [](const J& j) { return percent(j.quality.hausdorff.max); }},
          {"hausdorff_mean", "Hausdorff distance, mean", kDiagonal, true,
           [](const J& j) { return percent(j.quality.hausdorff.mean); }},
          {"coverage_max", "coverage error, max", kDiagonal, true,
           [](const J& j) { return percent(j.quality.coverage.max); }},
          {"coverage_mean", "coverage error, mean", kDiagonal, true,
           [](const J& j) { return percent(j.quality.coverage.mean); }},
          {"coverage_upper", "coverage error, proven to be at most", kDiagonal, true,
           [](const J& j) { return percent(j.quality.coverage_upper); }},
          {"inner_coverage_max", "coverage error not at borders, max", kDiagonal, true,
           [](const J& j) { return percent(j.quality.inner_coverage.max); }},
          {"inner_coverage_mean", "coverage error not at borders, mean", kDiagonal, true,
           [](const J& j) { return percent(j.quality.inner_coverage.mean); }},
          {"protrusion_max", "protrusion, max", kDiagonal, true,
           [](const J& j) { return percent(j.quality.protrusion.max); }},
          {"protrusion_mean", "protrusion, mean", kDiagonal, true,
           [](const J& j) { return percent(j.quality.protrusion.mean); }},
          {"protrusion_upper", "protrusion, proven to be at most", kDiagonal, true,
           [](const J& j) { return percent(j.quality.protrusion_upper); }},
          {"dent_upper", "dents, proven to be at most", kDiagonal, true,
           [](const J& j) { return percent(j.quality.dent_upper); }}};
}

std::vector<MedialMeasure> ball_measures() {
  return {
      {"radius_error_max", "radius error, max", kDiagonal, true,
       [](const J& j) { return percent(j.quality.radius_error.max); }},
      {"radius_error_mean", "radius error, mean", kDiagonal, true,
       [](const J& j) { return percent(j.quality.radius_error.mean); }},
      {"centredness_max", "centredness, max", "of the radius", true,
       [](const J& j) { return j.quality.centredness.max; }},
      {"centredness_mean", "centredness, mean", "of the radius", true,
       [](const J& j) { return j.quality.centredness.mean; }},
      {"outside_vertices", "vertices outside", "fraction", true, [](const J& j) { return j.quality.outside_vertices; }},
      {"outside_edges", "middles of edges outside", "fraction", true,
       [](const J& j) { return j.quality.outside_edges; }},
      {"outside_triangles", "middles of triangles outside", "fraction", true,
       [](const J& j) { return j.quality.outside_triangles; }}};
}

std::vector<MedialMeasure> topology_measures() {
  return {{"topology_right", "topology is the solid's: 1 yes, 0 no", "", false,
           [](const J& j) { return j.quality.found == j.quality.wanted ? 1.0 : 0.0; }},
          {"components", "components", "", false, [](const J& j) { return number(j.quality.found.components); }},
          {"loops", "loops", "", false, [](const J& j) { return number(j.quality.found.loops); }},
          {"cavities", "cavities", "", false, [](const J& j) { return number(j.quality.found.cavities); }},
          {"euler_characteristic", "Euler characteristic", "", false,
           [](const J& j) { return number(j.quality.found.euler_characteristic()); }}};
}

std::vector<MedialMeasure> form_measures() {
  return {{"balls", "balls", "", true, [](const J& j) { return number(j.quality.balls); }},
          {"border_length", "length of borders", "diagonals", true, [](const J& j) { return j.quality.border_length; }},
          {"face_components", "components of faces", "", true,
           [](const J& j) { return number(j.quality.pieces.face_components); }},
          {"curve_components", "components of curves", "", true,
           [](const J& j) { return number(j.quality.pieces.curve_components); }},
          {"small_pieces", "flakes and spikes of these", "", true,
           [](const J& j) { return number(j.quality.pieces.small); }}};
}

std::vector<MedialMeasure> making_measures() {
  return {{"triangle_quality_mean", "triangle quality, mean", "1: equilateral", false,
           [](const J& j) { return j.shape.quality_mean; }},
          {"triangle_quality_5", "triangle quality, 5th percentile", "1: equilateral", false,
           [](const J& j) { return j.shape.quality_5; }},
          {"triangle_quality_below", "triangles of quality below .1", "fraction", true,
           [](const J& j) { return j.shape.quality_below; }},
          {"edge_spread", "edges, 90th over 10th percentile", "ratio", true,
           [](const J& j) { return j.shape.edge_spread; }},
          {"sheet_count", "sheets", "", true, [](const J& j) { return number(j.shape.sheets); }},
          {"small_sheets", "sheets smaller than their balls", "", true,
           [](const J& j) { return number(j.shape.small_sheets); }},
          {"tiny_sheets", "sheets of 3 triangles or fewer", "", true,
           [](const J& j) { return number(j.shape.tiny_sheets); }},
          {"seam_length", "length of seams", "diagonals", false, [](const J& j) { return j.shape.seam_length; }},
          {"curve_length", "length of curves", "diagonals", false, [](const J& j) { return j.shape.curve_length; }},
          {"border_turns", "border turns by more than 60", "fraction", true,
           [](const J& j) { return j.shape.border_turns; }},
          {"border_roughness", "border roughness", "ratio", true, [](const J& j) { return j.shape.border_roughness; }},
          {"flaps", "flaps at borders", "", true, [](const J& j) { return number(j.shape.flaps); }},
          {"forked_borders", "vertices where borders fork", "", true,
           [](const J& j) { return number(j.shape.forked_borders); }}};
}

std::vector<MedialMeasure> paper_measures_of() {
  return {
      {"chamfer", "Chamfer distance, sampled", kDiagonal, true, [](const J& j) { return percent(j.paper.chamfer); }},
      {"sampled_hausdorff", "Hausdorff distance, sampled", kDiagonal, true,
       [](const J& j) { return percent(j.paper.sampled_hausdorff); }},
      {"covered", "covered by balls dilated by .02", "fraction", false, [](const J& j) { return j.paper.covered; }},
      {"dilation_needed", "dilation that covers all", "of the side", true,
       [](const J& j) { return j.paper.dilation_needed; }},
      {"wrong_structure", "wrong seam and junction balls", "fraction", true,
       [](const J& j) { return j.paper.wrong_structure; }},
      {"structure_balls", "seam and junction balls", "", false,
       [](const J& j) { return number(j.paper.structure_balls); }}};
}

std::vector<MedialMeasure> use_measures() {
  return {{"stability_max", "stability, max", "times the noise", true,
           [](const J& j) { return j.stability ? j.stability->hausdorff : not_defined(); }},
          {"stability_99", "stability, 99 % of vertices", "times the noise", true,
           [](const J& j) { return j.stability ? j.stability->percentile99 : not_defined(); }},
          {"stability_mean", "stability, mean", "times the noise", true,
           [](const J& j) { return j.stability ? j.stability->mean : not_defined(); }},
          {"economy_spheres", "economy: balls for 1 %", "", true,
           [](const J& j) {
             const Economy& economy = j.quality.economy;
             return economy.uncovered <= kMaxUncovered ? number(economy.spheres) : not_defined();
           }},
          {"economy_uncovered", "economy: surface out of reach", "fraction", true,
           [](const J& j) { return j.quality.economy.uncovered; }}};
}

std::vector<MedialMeasure> distance_measures() {
  return {{"distance_max", "distance from this axis, max", kDiagonal, false,
           [](const J& j) { return j.distance ? percent(j.distance->max) : not_defined(); }},
          {"distance_mean", "distance from this axis, mean", kDiagonal, false,
           [](const J& j) { return j.distance ? percent(j.distance->mean) : not_defined(); }}};
}

}  // namespace

MedialJudgement judge_mesh(const Surface& surface, const MedialMesh& mesh, const QualityOptions& options,
                           const Progress& progress) {
  MedialJudgement judgement;
  judgement.quality = medial_quality(surface, mesh, options, progress);
  judgement.shape = shape_measures(mesh, judgement.quality.diagonal);
  const PaperOptions paper{.samples = std::min(options.surface_samples, PaperOptions{}.samples), .seed = options.seed};
  judgement.paper = paper_measures(surface, mesh, paper);
  return judgement;
}

const std::vector<MedialMeasure>& medial_measures() {
  static const std::vector<MedialMeasure> measures = [] {
    std::vector<MedialMeasure> all;
    for (const auto& some : {reconstruction_measures(), ball_measures(), topology_measures(), form_measures(),
                             making_measures(), paper_measures_of(), use_measures(), distance_measures()})
      all.insert(all.end(), some.begin(), some.end());
    return all;
  }();
  return measures;
}

}  // namespace orchard::apps
