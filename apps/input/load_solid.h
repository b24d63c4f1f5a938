#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "input/mesh_input.h"
#include "input/repair_distance.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/progress.h"
#include "orchard/geometry/repair.h"
#include "orchard/geometry/surface.h"
#include "orchard/geometry/surface_distance.h"
#include "orchard/geometry/wrap.h"

// What every command that needs a solid does with the mesh that it is given.
namespace orchard::apps {

struct MeshOptions {
  MeshInput input;
  bool strict = false;  // as it is or not at all
  std::string wrap;     // not empty: build on a wrap that lies this far outside, a number of WrapOptions::offset
  double wrap_alpha = WrapOptions{}.alpha;
  std::optional<double> join;        // corners up to this far apart, in bounding radii; else as repair.h says
  std::optional<double> fill_holes;  // up to this width, in bounding radii, whatever their edges; else as repair.h says
  std::string noise;   // not empty: what to smooth away, "auto" or its standard deviation in percent of the diagonal
  bool unite = false;  // parts that cut each other become one
  BoundingBall ball = BoundingBall::minimal;

  bool operator==(const MeshOptions&) const = default;
};
inline const std::string kDefaultWrap = "0.002";
inline constexpr double kMaxJoin = 0.01;  // of MeshOptions::join: beyond it, corners that are meant are near enough

struct WrapResult {
  WrapOptions options;
  SurfaceDistance to_input, from_input;  // wrap to input and input to wrap
  // What the wrap adds, at most, to the distance of anything from the input; in mesh units.
  double distance() const { return to_input.upper; }
};

// The parts of a mesh that were replaced by their union.
struct UnionResult {
  Index parts = 0, cut_before = 0, cut_left = 0;  // as in UnitedMesh
};

// The noise that was smoothed away. Lengths are fractions of the diagonal, as in noise.h.
struct NoiseResult {
  bool estimated = false;
  double deviation = 0;  // standard deviation along the normals, over the diagonal
  int rounds = 0;        // 0: the noise is too low to matter, and the mesh is as it was
  double moved_rms = 0, moved_max = 0;
};
// An estimated deviation up to this is left alone: the borders of axes lose twice as much anyway.
inline constexpr double kNegligibleNoise = 0.0005;

struct SolidMesh {
  Surface surface;
  MeshReadReport reading;
  MeshRepairReport repair;         // nothing done if wrapped
  RepairDistance repair_distance;  // likewise
  std::optional<WrapResult> wrap;  // then `surface` is the wrap
  // Pairs of triangles that cut or touch each other: parts of the surface lie inside there, or stick out inside out.
  // Not counted for a wrap, which has none, and beyond kMaxForSelfIntersections.
  std::optional<std::size_t> self_intersections;
  std::optional<UnionResult> united = {};  // then `surface` is the union
  std::optional<NoiseResult> noise = {};   // if asked for

  bool is_smoothed() const { return noise && noise->rounds > 0; }
  // Whether `surface` is neither the file's nor a wrap.
  bool changed() const { return repair.changed() || united.has_value() || is_smoothed(); }
};

inline constexpr std::size_t kMaxForSelfIntersections = 500'000;  // triangles: a few seconds

// Reads a mesh and makes a solid of it: wraps it if that is asked for, else repairs what is safe to repair, and unites
// parts that cut each other if that is asked for and possible. Throws InputError, with the way out, if that gives no
// solid.
SolidMesh load_solid(const std::filesystem::path& file, const MeshOptions& options, const Progress& progress = {});

struct RepairedMesh {
  TriangleMesh mesh;
  MeshReadReport reading;
  MeshRepairReport repair;
  RepairDistance distance;
};

// For commands that take any triangles: the mesh that load_solid() gives with no other option than `join`, or as it is
// in the file if that cannot be repaired; then nothing was done.
RepairedMesh read_repaired(const std::filesystem::path& file, const MeshInput& input, std::optional<double> join);

// What repair_mesh() is asked for.
RepairMeshOptions repair_options(std::optional<double> join);

// What to say of holes that were too large to fill, and how to have them filled; empty if there are none.
std::string holes_left(const MeshRepairReport& repair, const RepairMeshOptions& limits = {});

// A line for each thing done, and one for how far it moved the surface.
void print_repair(const std::filesystem::path& file, const MeshRepairReport& repair, const RepairDistance& distance,
                  double bounding_radius);
void print_solid(const std::filesystem::path& file, const SolidMesh& solid);
// What a certificate of the solid is about, where it is written to, and how far that is from the input: the line that a
// build ends with.
std::string certificate(const SolidMesh& solid, const std::filesystem::path& written);
nlohmann::json to_json(const MeshRepairReport& repair, const RepairDistance& distance, double bounding_radius);
// Sets "reading", and "repair", "noise", "self_intersections" and "union", or "wrap" and "wrap_distance".
void add_solid_json(const SolidMesh& solid, nlohmann::json& report);

}  // namespace orchard::apps
