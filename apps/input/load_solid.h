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

// Turns the mesh of a command into a solid.
namespace orchard::apps {

struct MeshOptions {
  MeshInput input;
  bool strict = false;  // accept the mesh as it is, or refuse it
  std::string wrap;     // not empty: build on a wrap with this offset (WrapOptions::offset)
  double wrap_alpha = WrapOptions{}.alpha;
  // Corners up to this far apart are joined, in bounding radii; the default is that of repair.h.
  std::optional<double> join;
  // Holes up to this width are filled, in bounding radii, with any number of edges; the default is that of repair.h.
  std::optional<double> fill_holes;
  std::string noise;   // not empty: smooth away noise, "auto" or its standard deviation in percent of the diagonal
  bool unite = false;  // unite parts that cut each other
  BoundingBall ball = BoundingBall::minimal;

  bool operator==(const MeshOptions&) const = default;
};
inline const std::string kDefaultWrap = "0.002";
// Of MeshOptions::join; with a larger value, corners would be joined that are meant to be apart.
inline constexpr double kMaxJoin = 0.01;

struct WrapResult {
  WrapOptions options;
  SurfaceDistance to_input, from_input;  // wrap to input and input to wrap
  // The largest distance that the wrap adds to any distance from the input, in mesh units.
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
  MeshRepairReport repair;         // without changes if it was wrapped
  RepairDistance repair_distance;  // as above
  std::optional<WrapResult> wrap;  // if it was wrapped; then `surface` is the wrap
  // Pairs of triangles that cut or touch each other. Parts of the surface lie inside there, or protrude inside out. Not
  // counted for a wrap, which has none, and for more than kMaxForSelfIntersections triangles.
  std::optional<std::size_t> self_intersections;
  std::optional<UnionResult> united = {};  // then `surface` is the union
  std::optional<NoiseResult> noise = {};   // if asked for

  bool is_smoothed() const { return noise && noise->rounds > 0; }
  // Whether `surface` differs from the file and is not a wrap.
  bool changed() const { return repair.changed() || united.has_value() || is_smoothed(); }
};

inline constexpr std::size_t kMaxForSelfIntersections = 500'000;  // triangles: a few seconds

// Reads a mesh and makes it a solid. Wraps it if asked for; otherwise makes all safe repairs, and unites parts that cut
// each other if asked for and possible. Throws InputError, which says what to do, if the result is no solid.
SolidMesh load_solid(const std::filesystem::path& file, const MeshOptions& options, const Progress& progress = {});

struct RepairedMesh {
  TriangleMesh mesh;
  MeshReadReport reading;
  MeshRepairReport repair;
  RepairDistance distance;
};

// For commands that accept any triangles: returns the mesh that load_solid() makes with no other option than `join`;
// or, if that cannot be repaired, the mesh as it is in the file, without changes.
RepairedMesh read_repaired(const std::filesystem::path& file, const MeshInput& input, std::optional<double> join);

// Returns the options of repair_mesh().
RepairMeshOptions repair_options(std::optional<double> join);

// Returns a sentence about holes that were too large to fill, and how to have them filled; empty if there are none.
std::string holes_left(const MeshRepairReport& repair, const RepairMeshOptions& limits = {});

// Prints a line for each repair, and one for how far it moved the surface.
void print_repair(const std::filesystem::path& file, const MeshRepairReport& repair, const RepairDistance& distance,
                  double bounding_radius);
void print_solid(const std::filesystem::path& file, const SolidMesh& solid);
// Returns the last line of a build: what the certificate is about, where that is written, and how far it is from the
// input.
std::string certificate(const SolidMesh& solid, const std::filesystem::path& written);
nlohmann::json to_json(const MeshRepairReport& repair, const RepairDistance& distance, double bounding_radius);
// Sets "reading", and either "repair", "noise", "self_intersections" and "union", or "wrap" and "wrap_distance".
void add_solid_json(const SolidMesh& solid, nlohmann::json& report);

}  // namespace orchard::apps
