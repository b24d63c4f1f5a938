#include "medial/medial_views.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "command_line/interrupt.h"
#include "medial/light_balls.h"
#include "output/picture.h"

#ifdef ORCHARD_HAS_VIZ
#include "orchard/medial/structure.h"
#include "orchard/viz/light_writer.h"
#include "orchard/viz/medial_script.h"
#include "orchard/viz/medial_writer.h"
#include "orchard/viz/paraview_state.h"
#include "orchard/viz/render.h"
#include "orchard/viz/vtk_writer.h"
#endif

namespace orchard::apps {
namespace {

void to_percent(std::vector<double>& values) {
  for (double& value : values) value *= 100;
}

BallErrors in_percent(BallErrors errors) {
  to_percent(errors.radius_error);
  to_percent(errors.protrusion);
  return errors;
}

SurfaceErrors in_percent(SurfaceErrors errors) {
  to_percent(errors.coverage);
  to_percent(errors.protrusion);
  return errors;
}

std::vector<Sphere> balls_of(const MedialMesh& mesh) {
  std::vector<Sphere> balls;
  for (Index i = 0; i < mesh.size(); ++i) balls.push_back({mesh.centers[i], mesh.radii[i]});
  return balls;
}

void add_middles(const MedialAxis& axis, const Rows& faces, std::vector<Sphere>& balls) {
  for (Index face = 0; face < faces.size(); ++face) {
    const auto corners = faces[face];
    Sphere& ball = balls.emplace_back(Sphere{Point::Zero(), 0});
    for (const Index corner : corners) {
      ball.center += axis.centers[corner] / static_cast<double>(corners.size());
      ball.radius += axis.radii[corner] / static_cast<double>(corners.size());
    }
  }
}

SurfaceErrors errors_at(const Surface& surface, const MedialMesh& mesh, const SurfaceSampling& sampling) {
  std::vector<Vector> normals;
  for (Index i = 0; i < sampling.size(); ++i)
    normals.push_back(surface.pseudonormal(sampling.triangles[i], sampling.features[i]));
  return in_percent(surface_errors(surface, mesh, sampling.points, normals));
}

SurfaceErrors errors_at_vertices(const Surface& surface, const MedialMesh& mesh) {
  const std::vector<Point>& vertices = surface.mesh().vertices;
  std::vector<Vector> normals;
  for (Index v = 0; v < vertices.size(); ++v) {
    const auto around = surface.triangles_around(v);
    Vector normal = Vector::Zero();
    for (std::size_t k = 0; !around.empty() && k < 3; ++k) {
      if (surface.mesh().triangles[around[0]][k] == v)
        normal = surface.pseudonormal(around[0],
                                      static_cast<Feature>(static_cast<int>(Feature::vertex0) + static_cast<int>(k)));
    }
    normals.push_back(normal);
  }
  return in_percent(surface_errors(surface, mesh, vertices, normals));
}

}  // namespace

MedialErrors medial_errors(const Surface& surface, const MedialBuild& build, const MedialMesh& mesh,
                           const QualityOptions& options) {
  std::vector<Sphere> middles;
  add_middles(build.axis, build.axis.faces, middles);
  add_middles(build.axis, build.axis.topology_faces, middles);
  QualityOptions no_contacts = options;
  no_contacts.contact_cells = 0;
  return {.vertices = in_percent(ball_errors(surface, balls_of(mesh), options)),
          .faces = in_percent(ball_errors(surface, middles, no_contacts)),
          .points = errors_at(surface, mesh, build.sampling),
          .mesh = errors_at_vertices(surface, mesh)};
}

std::vector<std::string> view_names(const std::filesystem::path& model) {
  std::vector<std::string> names;
  for (const char* ending : {"-medial.vtu", "-medial.vtm", "-medial-parts.vtm", "-medial.pvsm", "-medial-view.py",
                             "-medial-outline.vtp", "-medial-light.vtp", "-medial-vertices.vtp", "-medial-edges.vtp",
                             "-medial-faces.vtp", "-medial-contacts.vtp", "-medial-mesh.vtp", "-medial-points.vtp",
                             "-medial-thickness.vtp", "-medial-structure.vtp", "-medial-worst.vtp", "-medial.png"})
    names.push_back(named(model, ending));
  return names;
}

#ifdef ORCHARD_HAS_VIZ
namespace {

// At each vertex the most of its own ball's and of those at the middles of its edges and triangles.
std::vector<double> protrusion_around(const Surface& surface, const MedialMesh& mesh) {
  std::vector<Sphere> balls = balls_of(mesh);
  const auto add = [&](const auto& corners) {
    Sphere ball{Point::Zero(), 0};
    for (const Index corner : corners) {
      ball.center += mesh.centers[corner] / static_cast<double>(corners.size());
      ball.radius += mesh.radii[corner] / static_cast<double>(corners.size());
    }
    balls.push_back(ball);
  };
  for (const auto& edge : mesh.edges) add(edge);
  for (const auto& triangle : mesh.triangles) add(triangle);
  const std::vector<double> all = ball_protrusions(surface, balls);
  std::vector<double> max(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(mesh.size()));
  std::size_t at = mesh.size();
  const auto take = [&](const auto& corners) {
    for (const Index corner : corners) max[corner] = std::max(max[corner], all[at]);
    ++at;
  };
  for (const auto& edge : mesh.edges) take(edge);
  for (const auto& triangle : mesh.triangles) take(triangle);
  to_percent(max);
  return max;
}

ViewArrays arrays_of(const BallErrors& errors) {
  ViewArrays arrays{{"radius_error", errors.radius_error}, {"protrusion", errors.protrusion}};
  if (!errors.centredness.empty()) arrays.push_back({"centredness", errors.centredness});
  return arrays;
}

ViewArrays arrays_of(const SurfaceErrors& errors) {
  return {{"coverage", errors.coverage}, {"protrusion", errors.protrusion}};
}

constexpr double kWorstPlaceMark = 0.015;  // of the bounding radius: the balls at worst places

// The axis by radius in its transparent solid, with the lines where sheets end and meet. Its sheets in colours of their
// own are in ParaView's list.
StateScene state_of(const MedialCommand& command, const MedialViews& views) {
  const auto file = [&](const char* ending) { return named(command.mesh, std::string("-medial") + ending); };
  const std::vector<double>& radii = views.build.axis.radii;
  const Sphere& ball = views.surface.bounding_ball();
  const auto parts = static_cast<double>(medial_structure(views.mesh).parts.size());
  const auto [least, largest] = std::minmax_element(radii.begin(), radii.end());
  StateScene scene{
      .layers =
          {{.name = "mesh", .file = file("-mesh.vtp"), .opacity = 0.15},
           {.name = "axis by radius", .file = file(".vtu"), .array = "radius"},
           {.name = "borders and seams", .file = file("-structure.vtp"), .width = 2, .color = {0.13, 0.16, 0.20}},
           {.name = "axis by sheet", .file = file(".vtu"), .array = "structure", .of_cells = true, .categories = true}},
      .ranges = {{"radius", {least == radii.end() ? 0 : *least, largest == radii.end() ? 1 : *largest}, "radius"},
                 {"structure", {0, parts}, ""}},
      .views = {{.layers = {0, 1, 2}}},
      .center = ball.center,
      .radius = ball.radius,
      .up = parse_up(command.up)};
  if (views.errors == nullptr) return scene;
  scene.layers.push_back({.name = "worst places",
                          .file = file("-worst.vtp"),
                          .look = StateLayer::Look::spheres,
                          .sphere_radius = kWorstPlaceMark * ball.radius,
                          .color = {0.70, 0.07, 0.11}});
  scene.views.front().layers.push_back(4);
  return scene;
}

// What a sphere takes to be drawn as a glyph in ParaView without a graphics card: 100,000 took 14 s of two cores' time.
constexpr double kSecondsPerGlyph = 7e-5;

// The balls for spheres where they are many. Returns their number, 0 if there is no such file.
Index write_light_balls(const MedialCommand& command, const MedialAxis& axis, Outputs& outputs) {
  if (command.light_balls == 0 || axis.size() <= command.light_balls) return 0;
  std::vector<Sphere> all, kept;
  for (Index i = 0; i < axis.size(); ++i) all.push_back({axis.centers[i], axis.radii[i]});
  const std::vector<Index> vertices = light_balls(all, command.light_balls);
  for (const Index vertex : vertices) kept.push_back(all[vertex]);
  const std::string what = fmt::format(
      "{} of its {} balls, the largest of each region (--light); all of them as spheres take about {:.1f} s to draw "
      "without a graphics card",
      kept.size(), all.size(), kSecondsPerGlyph * static_cast<double>(all.size()));
  write_balls(outputs.add(named(command.mesh, "-medial-light.vtp"), what), kept, vertices);
  return static_cast<Index>(kept.size());
}

// The axis between the lines of its solid, which a .vtm cannot show as transparent; and the parts, each whole.
void write_collections(const MedialCommand& command, const std::vector<NamedFile>& parts, Outputs& outputs) {
  std::vector<NamedFile> seen{{"outline of the solid", named(command.mesh, "-medial-outline.vtp")}};
  for (const NamedFile& part : parts)
    if (part.name == "medial faces" || part.name == "structure graph" || part.name == "worst places")
      seen.push_back(part);
  write_multiblock(outputs.add(named(command.mesh, "-medial.vtm"), "the axis between the lines of its solid"), seen);
  write_multiblock(outputs.add(named(command.mesh, "-medial-parts.vtm"),
                               "mesh, points, parts of the axis and structure graph at once"),
                   parts);
}

// The ball of each surface point, where the points are those of the axis.
void add_sample_balls(const MedialAxis& axis, std::size_t points, ViewArrays& of_points) {
  const AxisContacts contacts = axis_contacts(axis);
  if (contacts.sample_balls.size() != points) return;
  ViewArray& balls = of_points.emplace_back(ViewArray{.name = "ball", .values = {}});
  for (const Index ball : contacts.sample_balls)
    balls.values.push_back(ball == kNone ? std::numeric_limits<double>::quiet_NaN() : ball);
}

}  // namespace

void write_views(const MedialCommand& command, const MedialViews& views, Outputs& outputs) {
  if (!command.views) return;
  std::vector<NamedFile> shown;
  const auto add = [&](const std::string& ending, const char* block, const char* what = "") {
    const std::string name = named(command.mesh, "-medial" + ending);
    if (*block != '\0') shown.push_back({block, name});
    return outputs.add(name, what);
  };
  ViewArrays of_vertices, of_faces, of_points, of_mesh;
  if (views.errors != nullptr) {
    of_vertices = arrays_of(views.errors->vertices);
    of_faces = arrays_of(views.errors->faces);
    of_points = arrays_of(views.errors->points);
    of_mesh = arrays_of(views.errors->mesh);
  }
  for (const auto& [name, values] : views.importance) of_vertices.push_back({name, values});
  ViewArray& passes = of_points.emplace_back(ViewArray{.name = "repair_pass", .values = {}});
  for (const int pass : repair_passes(views.build))  // of which pass a point is may not be known
    passes.values.push_back(pass < 0 ? std::numeric_limits<double>::quiet_NaN() : pass);
  const MedialAxis& axis = views.build.axis;
  add_sample_balls(axis, views.build.sampling.size(), of_points);
  write_medial_grid(add(".vtu", "", "the axis with radius, angle, segment, component; open it in ParaView"), axis,
                    views.segments, of_vertices, of_faces);
  write_mesh(add("-mesh.vtp", "mesh"), views.surface);
  write_outline(add("-outline.vtp", ""), views.surface);
  write_points(add("-points.vtp", "surface points", "the surface points, and which of them repair added"),
               views.build.sampling, of_points);
  add("-vertices.vtp", "medial vertices");
  add("-edges.vtp", "medial edges");
  add("-faces.vtp", "medial faces", "its faces; edges and vertices likewise");
  add("-contacts.vtp", "", "the contacts that its forming points count");
  write_medial_axis(outputs.staged(named(command.mesh, "-medial")), axis, of_vertices, of_faces);
  write_thickness(add("-thickness.vtp", "", "the mesh with its local thickness"), views.surface,
                  medial_radii_at_surface(views.surface, views.mesh), of_mesh);
  write_structure_graph(add("-structure.vtp", "structure graph", "the lines where sheets end and meet"), axis,
                        views.graph);
  if (views.errors != nullptr)
    write_worst_places(add("-worst.vtp", "worst places", "where it is worst, numbered as above"), views.worst);
  const Index light = write_light_balls(command, axis, outputs);
  write_collections(command, shown, outputs);
  write_paraview_state(add(".pvsm", "", "a double click shows the axis in its transparent solid"),
                       state_of(command, views), command.folder);
  write_medial_script(add("-view.py", "", "the same by a script: pvbatch .. --preset NAME -o picture.png"),
                      {.name = named(command.mesh, "-medial"),
                       .ball = views.surface.bounding_ball(),
                       .up = parse_up(command.up),
                       .balls = axis.size(),
                       .light_balls = light});
}

std::string write_picture(const MedialCommand& command, const Surface& surface, const std::vector<PicturedAxis>& axes,
                          const SurfaceSampling* sampling, const std::string& name, Outputs& outputs) {
  if (!command.picture && !(command.report && command.views)) return {};
  SurfaceSampling own;
  if (sampling == nullptr) {
    own = sample_surface(surface, build_options(command.tuning).sampling);
    sampling = &own;
  }
  MedialErrorsPicture errors{.surface = &surface, .sampling = sampling, .axes = {}};
  for (const PicturedAxis& axis : axes)
    errors.axes.push_back({.name = axis.name,
                           .mesh = axis.mesh,
                           .coverage = errors_at(surface, *axis.mesh, *sampling).coverage,
                           .protrusion = protrusion_around(surface, *axis.mesh),
                           .worst = axis.worst});
  PipelinePicture picture;
  picture.title = name.substr(0, name.rfind('.'));
  picture.up = parse_up(command.up);
  picture.progress = cancelled_by_interrupts();
  if (!is_drawn(draw_medial_errors(outputs.staged(name), errors, picture))) return {};
  outputs.add(name, "where it is worst, in a picture, numbered as above");
  return outputs.take(name, command.picture);
}
#else
void write_views(const MedialCommand&, const MedialViews&, Outputs&) {}

std::string write_picture(const MedialCommand& command, const Surface&, const std::vector<PicturedAxis>&,
                          const SurfaceSampling*, const std::string&, Outputs&) {
  if (command.picture) fmt::print(stderr, "orchard: no picture was made: this program was built without VTK\n");
  return {};
}
#endif

}  // namespace orchard::apps
