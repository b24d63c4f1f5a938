#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "command_line/exit_code.h"
#include "input/axis_source.h"
#include "input/load_solid.h"
#include "medial/medial_tuning.h"
#include "orchard/medial/curve_skeleton.h"
#include "orchard/medial/offset.h"
#include "orchard/medial/surface_parts.h"
#include "orchard/medial/thickness.h"
#include "orchard/spheretree/build.h"
#include "orchard/spheretree/sphere_set.h"
#include "orchard/voronoi/algorithms.h"
#include "output/provenance.h"
#include "robot/bodies.h"
#include "robot/command/robot_reading.h"
#include "robot/formats.h"
#include "trees/tree_request.h"

// The options of each command, and the functions that run the commands, each of which is in a file of its own. On
// failure they throw, and main() turns that into an exit code and one line on stderr.
namespace orchard::apps {

struct Output {
  bool quiet = false;  // no progress, no table
  bool json = false;   // a JSON report on stdout instead of a table; no progress
  bool force = false;  // replace the files of another input
  Invocation run;      // how the report states that it was made
};

struct BuildCommand {
  std::filesystem::path mesh, folder;
  MeshOptions reading;
  TreeRequest tree;
  std::optional<double> seconds;  // stop after this time with the best tree so far
  MedialTuning tuning;
  AxisSource source;
  bool views = true;                  // ParaView files, if the program was built with VTK
  bool picture = false;               // a .png as well
  bool page = false;                  // an .html page with pictures, tables and plots
  bool cost = false;                  // print the expected cost, and build nothing
  std::vector<std::string> exports;   // sph (always written), json, urdf, npz, csv
  std::optional<Index> export_level;  // the level of the urdf; the default is the last one
  std::string up = "y";               // the mesh's axis that points up in the picture
  std::vector<std::string> given;     // the options on the command line, by their long names, without dashes
  bool accept = false;                // a broken promise does not change the exit code
  Output output;
};
ExitCode build(const BuildCommand& command);
// Throws InputError for options that are invalid for every mesh, as do the functions of this name below.
void check_options(const BuildCommand& command);

struct CollideCommand {
  std::filesystem::path a, b;
  std::string pose_a, pose;  // "tx ty tz qw qx qy qz" of a and b; empty: identity
  Output output;
};
void collide(const CollideCommand& command);

struct VerifyCommand {
  std::filesystem::path tree, mesh;
  MeshInput input;             // as in MeshOptions, and in the commands below
  std::optional<double> join;  // likewise
  bool box_centered = false;   // whether a text tree is relative to the centre of the mesh's bounding box
  Output output;
};
bool verify(const VerifyCommand& command);  // false: something is not proven

struct AuditCommand {
  std::filesystem::path spheres, mesh;
  std::filesystem::path folder;  // for the views and the report; empty: none
  MeshInput input;
  std::string link;              // the link, if the file has several; empty if it has one
  std::optional<double> buffer;  // added to every radius, in place of the file's own buffer
  std::optional<double> join;
  bool picture = false;
  bool report = false;             // a page
  std::string up = "z";            // the mesh's axis that points up in the picture
  RobotReading reading;            // for a URDF as `mesh`: the whole robot is audited
  bool wrap = false;               // for a URDF: wrap links that are no solids
  std::vector<std::string> given;  // as of BuildCommand
  Output output;
};
ExitCode audit(const AuditCommand& command);
ExitCode audit_robot(const AuditCommand& command);  // which audit() calls

struct RobotCommand {
  std::filesystem::path urdf, folder;
  std::filesystem::path from;  // a file of existing spheres; empty to make them
  RobotReading reading;
  bool wrap = true;  // wrap links that are no solids
  Index spheres = 60;
  std::string fit = "cover";
  std::vector<std::string> links, link_fits;  // "NAME=NUMBER", "NAME=FIT"
  Effort effort = Effort::standard;
  double padding = 0, buffer = 0;  // metres
  double density = robot::kUsualDensity;
  Index states = robot::SelfCollisionOptions{}.states;
  std::uint64_t seed = 1;
  std::vector<std::string> exports;      // of robot::formats(); empty: kUsualFormats
  std::vector<std::string> tool_frames;  // names of links
  std::optional<double> acceleration, jerk;
  Index resolution = robot::FormatOptions{}.resolution;
  std::vector<std::string> joints;   // "NAME=VALUE": the pose in which the robot rests and is drawn
  std::filesystem::path trajectory;  // further poses to draw; empty for none
  bool trees = false, views = true, picture = true, report = false;
  std::string up = "z";
  std::vector<std::string> given;  // as of BuildCommand
  bool accept = false;             // likewise
  Output output;
};
ExitCode robot(const RobotCommand& command);

struct SpheresCommand {
  std::filesystem::path mesh, folder;
  MeshOptions reading;
  SphereSetOptions options;
  double error = 0, volume_error = 0;  // percent
  double overlap = 0, center_error = 100 * ParticleOptions{}.center_error,
         inertia_error = 100 * ParticleOptions{}.inertia_error;  // of particles, percent
  std::vector<double> clip;              // normal and offset of the half-space that is kept; empty: all
  std::filesystem::path vertex_weights;  // a number for each vertex; empty: none
  std::vector<Index> error_curve;        // numbers of spheres for which the error is written, too
  std::vector<std::string> exports;      // json, csv, npz, urdf, yaml; x y z r as text always
  std::string link;                      // the name in robots' files; empty: the mesh's
  bool tree = false;  // also write an .orchard file over the spheres, even if they were read from a file
  bool views = true, picture = false, report = false;
  std::string up = "z";
  std::vector<std::string> given;  // as of BuildCommand
  bool accept = false;             // likewise
  Output output;
};
ExitCode spheres(const SpheresCommand& command);
void check_options(const SpheresCommand& command);

struct SampleCommand {
  std::filesystem::path mesh, folder;
  MeshInput input;
  Index samples = 5000;               // in all
  std::optional<Index> edge_samples;  // the number of these on edges; a fifth by default
  std::optional<double> join;
  int iterations = SamplingOptions{}.iterations;
  std::uint64_t seed = 1;
  Relaxation relaxation = Relaxation::automatic;
  std::optional<double> cluster_degrees;
  std::optional<double> crease_degrees;
  bool views = true;    // ParaView files, if the program was built with VTK
  bool report = false;  // an .html page
  Output output;
};
void sample(const SampleCommand& command);
// Throws InputError if options contradict each other, or if one makes another ineffective.
void check_sampling(const SampleCommand& command);
// Returns the command's options for a surface.
SamplingOptions sampling_options(const SampleCommand& command, const Surface& surface);

struct VoronoiCommand {
  std::filesystem::path input, folder;  // points or a mesh; no folder: write nothing
  SampleCommand sampling;               // for a mesh; its members mesh, folder and output are not used
  VoronoiAlgorithm algorithm = VoronoiAlgorithm::highest_first;
  bool compare = false;                     // run all algorithms
  std::vector<Index> cells;                 // to write; empty: all
  std::vector<double> box;                  // that cells are clipped to: x y z of two corners; empty: around the points
  std::vector<std::string> sampling_given;  // the options of `sampling` on the command line, as of BuildCommand
  bool report = false;                      // an .html page
  Output output;
};
void voronoi(const VoronoiCommand& command);

// An option that a sweep varies, and its values.
struct SweptOption {
  std::string name;
  std::vector<std::string> values;
};

struct MedialCommand {
  // What is read and how the axis is built.
  std::filesystem::path mesh, folder;
  MeshOptions reading;
  MedialTuning tuning;
  AxisSource source;
  bool outside = false;            // build the axis of the space between the solid and a sphere around it
  double outside_radius = 2;       // the radius of that sphere, in bounding radii of the mesh
  std::filesystem::path features;  // an .obj file of edges that sheets reach to; empty: they are found by their loss

  // An axis that is read from a file and judged. Nothing is built then.
  std::filesystem::path axis;  // empty: build one
  bool connect = false;        // connect the balls of a file without cells by their power diagram

  // What is computed from the axis.
  std::vector<std::string> importance;  // the measures to add as arrays, one value for each ball
  std::string prune_curve;   // the measure whose values are written with error and size of the pruned axis; or empty
  bool error_curve = false;  // simplify to fewer and fewer vertices, and write the error of each step
  Index few_vertices = 0;    // simplify to this many vertices; 0: until few_error is reached
  double few_error = 0;      // the largest error of the simplified axis in percent of the diagonal; 0: not requested
  std::string few_kind = "medial";  // "medial": balls of the axis only; "free": balls of any center and radius
  std::filesystem::path envelope;   // an .obj file for the surface of the union that the axis represents; or empty
  double envelope_cell = 0.5;       // the grid's spacing for that surface in percent of the diagonal

  // How the axis is judged.
  Index quality_samples = 100'000;            // the number of surface points at which it is measured
  bool report = false;                        // write a page with measures and plots
  std::vector<std::filesystem::path> beside;  // files of other axes to judge by the same measures, in the same table

  // A sweep builds an axis for each combination of values.
  std::vector<std::string> sweep;      // "NAME=VALUE,VALUE,..", as on the command line
  std::vector<SweptOption> swept;      // the same, parsed
  std::vector<MedialCommand> runs;     // the command of each combination; the last option varies fastest
  std::vector<std::string> choice;     // in such a run: its values of the swept options
  bool keep = false;                   // write the axis of each run as well
  std::string best = "hausdorff_max";  // the measure that the table is sorted by, best first
  std::optional<TreeRequest> tree;     // a tree to build from each axis

  // What is written.
  std::vector<std::string> exports;  // formats of the axis: ma, ply, obj, graphml, vtp, npz, csv
  bool views = true;                 // write ParaView files, if the program was built with VTK
  Index light_balls = 20'000;        // the number of spheres in a light file, if the axis has more; 0: no such file
  bool picture = false;              // draw the places where the judged axis has its largest errors
  std::string up = "y";              // the mesh's axis that points up in the picture
  std::vector<std::string> given;    // as of BuildCommand
  bool accept = false;               // as of BuildCommand
  Output output;
};
bool given(const MedialCommand& command, const char* option);  // on the command line
ExitCode medial(const MedialCommand& command);
void check_options(const MedialCommand& command);

struct LeaderboardCommand {
  std::filesystem::path input, folder;  // of meshes and axes; for the table
  std::vector<std::string> builders;    // of orchard: refined, raw; empty: both
  std::vector<Index> vertices;          // numbers of balls in addition to those of the axes
  bool connect = false;                 // as of MedialCommand
  Index quality_samples = 20'000;       // surface points of each judgement
  Index samples = kStandardSamples;     // surface points of orchard's axes
  std::uint64_t seed = 1;
  bool report = false;  // a page
  Output output;
};
void leaderboard(const LeaderboardCommand& command);

struct CompareCommand {
  std::filesystem::path mesh;
  std::vector<std::filesystem::path> files;  // trees (.orchard, .sph, or .json lists of spheres), or axes
  MeshOptions reading;
  std::filesystem::path plot;        // .svg; empty: none
  std::filesystem::path folder;      // for the report, its page and of axes also table and picture; empty: none
  bool report = false;               // a page
  Index vertices = 0;                // of axes: to simplify each to at most this many balls; 0: to none
  std::filesystem::path csv;         // of axes: a table to which the rows of this mesh are added; empty: none
  Index quality_samples = 100'000;   // of axes: surface points at which to measure
  Index samples = kStandardSamples;  // of axes: surface points of orchard's own
  std::uint64_t seed = 1;            // of axes
  bool connect = false;              // of axes, as of MedialCommand
  std::string up = "y";              // of axes: the mesh's axis that points up in the picture
  std::vector<std::string> given;    // as of BuildCommand
  Output output;
};
void compare(const CompareCommand& command);
void compare_axes(const CompareCommand& command);  // which compare() calls for axes

struct ProfileCommand {
  std::filesystem::path a, b;    // .orchard files; b empty: two copies of a
  unsigned flights = 300;        // the number of flights of b past a
  std::uint64_t seed = 1;        // of the flights
  std::filesystem::path plot;    // .svg; empty: none
  std::filesystem::path csv;     // every pose and level; empty: none
  std::filesystem::path folder;  // for the report and its page; empty: none
  bool report = false;           // a page
  Output output;
};
void profile(const ProfileCommand& command);

struct SimulateCommand {
  std::string scene;
  std::filesystem::path tree;         // the tree of the bodies; empty for that of a small ship
  std::size_t bodies = 0;             // 0 for the scene's own number
  std::optional<std::size_t> frames;  // the default is 100, or the number that was recorded
  std::string budget;                 // of each frame, as a number of sphere tests or a time; empty for none
  std::uint64_t seed = 1;
  std::filesystem::path record, replay;  // files of the input from outside; empty for none
  std::filesystem::path folder;          // for the traces; empty: none
  bool report = false;                   // a page
  bool views = true;                     // frames for ParaView
  Output output;
};
void simulate(const SimulateCommand& command);

struct ThicknessCommand {
  std::filesystem::path mesh, folder;
  MeshOptions reading;
  ThicknessOptions options;
  std::optional<double> below;       // in mesh units: report where the solid is thinner
  std::optional<double> fail_below;  // the same, and the exit code is kTooThin if it is thinner anywhere
  Index bins = 50;                   // of the histogram
  bool report = false;               // a page
  bool views = true;                 // ParaView files, if the program was built with VTK
  Output output;
};
ExitCode thickness(const ThicknessCommand& command);

// The axis' command has the mesh, how the axis is tuned, and where files go; what it could write itself does not count.
struct SkeletonCommand {
  MedialCommand axis;
  SkeletonOptions options;
};
ExitCode skeleton(const SkeletonCommand& command);
void check_options(const SkeletonCommand& command);

struct SegmentCommand {
  MedialCommand axis;  // likewise
  PartOptions options;
  bool meshes = false;  // each part as a mesh of its own, too
};
ExitCode segment(const SegmentCommand& command);
void check_options(const SegmentCommand& command);

struct OffsetCommand {
  std::filesystem::path mesh, folder;
  MeshOptions reading;
  std::optional<double> distance;  // mesh units
  OffsetSide side = OffsetSide::outside;
  std::optional<double> hollow;                        // thickness of the wall, in place of the distance
  double tolerance = 100 * OffsetOptions{}.tolerance;  // percent of the diagonal
  bool views = true;                                   // ParaView files, if the program was built with VTK
  bool report = false;                                 // an .html page
  bool accept = false;                                 // as of BuildCommand
  Output output;
};
ExitCode offset(const OffsetCommand& command);
void check_options(const OffsetCommand& command);

struct BatchCommand {
  std::vector<std::string> sources;  // a folder of meshes or a manifest; or "merge" and folders of batches
  std::filesystem::path folder;
  std::string shard = "1/1";
  int jobs = 0;              // meshes at a time; 0: as many as there are processors
  double timeout = 0;        // seconds for each mesh; 0: none
  std::uint64_t memory = 0;  // MiB of each mesh; 0: no limit
  bool resume = false, cost = false;
  std::vector<std::string> worker;  // the command for each mesh: the arguments after --
  std::vector<std::string> faults;  // KIND=MESH, for tests
  std::vector<std::string> given;   // as of BuildCommand
  Output output;
};
ExitCode batch(const BatchCommand& command);

struct InspectCommand {
  std::filesystem::path file;
  MeshInput input;  // its unit is used for files of other kinds, too
  std::optional<double> join;
  bool full = false;  // count self-intersections of large meshes too
  Output output;
};
void inspect(const InspectCommand& command);

struct ReportCommand {
  std::vector<std::filesystem::path> reports;  // .json files of any commands
  std::filesystem::path page;                  // .html
  bool quiet = false;
};
void report(const ReportCommand& command);

struct ViewCommand {
  std::vector<std::filesystem::path> files;  // trees, axes, diagrams, meshes, points: all in one picture
  MeshInput input;                           // of the meshes
  std::filesystem::path picture;             // .png, .svg or .pdf; in a window, the key s saves to it
  std::vector<Index> levels;                 // of the trees, a panel for each; empty: the deepest
  std::string camera, size;                  // "azimuth,elevation" in degrees, "widthxheight" in pixels; empty: as fits
  std::string up = "y";
  double opacity = 0.16;        // of meshes next to other things
  std::string color, range;     // an array; "a,b"
  std::string map = "viridis";  // the colours of that array
  std::string look_at, clip;    // "x,y,z"; "a,b,c,d"
  std::optional<double> width;  // of what is seen around look_at, in mesh units
  std::string layout = "over";  // or beside
  bool edges = false, balls = false, captions = false, transparent = false;
  Index turn = 0;     // frames of a turntable; 0: one picture
  Index frame = 0;    // the time step of series (.pvd), from 1; 0: the last one
  bool play = false;  // draw a picture for each time step
  bool window = false, quiet = false;
  Invocation run;  // recorded in the picture
};
void view(const ViewCommand& command);

}  // namespace orchard::apps
