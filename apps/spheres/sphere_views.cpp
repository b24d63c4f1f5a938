#include "spheres/sphere_views.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "orchard/spheretree/ball_tree.h"
#include "orchard/spheretree/sphere_set.h"
#include "output/picture.h"

#ifdef ORCHARD_HAS_VIZ
#include "orchard/medial/medial_mesh.h"
#include "orchard/viz/render.h"
#include "orchard/viz/vtk_writer.h"
#endif

namespace orchard::apps {
namespace {

#ifdef ORCHARD_HAS_VIZ
constexpr Index kViewPoints = 20'000;  // of the surface

// The spheres as a mesh of points of no size, for a picture that colours meshes.
MedialMesh as_triangles(std::span<const Sphere> spheres) {
  constexpr Index kRings = 12, kPerRing = 20;
  using std::numbers::pi;
  MedialMesh mesh;
  for (const Sphere& sphere : spheres) {
    const auto first = static_cast<Index>(mesh.centers.size());
    const auto add = [&](double polar, double turn) {
      const Vector out(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar));
      mesh.centers.push_back(sphere.center + sphere.radius * out);
      mesh.radii.push_back(0);
    };
    add(0, 0);
    add(pi, 0);
    for (Index ring = 0; ring < kRings; ++ring)
      for (Index k = 0; k < kPerRing; ++k) add(pi * (ring + 1) / (kRings + 1), 2 * pi * k / kPerRing);
    const auto at = [&](Index ring, Index k) { return first + 2 + ring * kPerRing + k % kPerRing; };
    for (Index k = 0; k < kPerRing; ++k) {
      mesh.triangles.push_back({first, at(0, k), at(0, k + 1)});
      mesh.triangles.push_back({first + 1, at(kRings - 1, k), at(kRings - 1, k + 1)});
      for (Index ring = 0; ring + 1 < kRings; ++ring) {
        mesh.triangles.push_back({at(ring, k), at(ring, k + 1), at(ring + 1, k)});
        mesh.triangles.push_back({at(ring, k + 1), at(ring + 1, k), at(ring + 1, k + 1)});
      }
    }
  }
  complete(mesh);
  return mesh;
}

SurfaceSampling points_of(const Surface& surface) {
  return sample_surface(surface, {.face_points = kViewPoints * 4 / 5, .edge_points = kViewPoints / 5, .iterations = 5});
}
#endif

}  // namespace

std::vector<std::string> sphere_view_endings(const std::string& prefix) {
  return {prefix + ".vtm", prefix + "-mesh.vtp", prefix + "-points.vtp", prefix + "-spheres.vtp"};
}

#ifdef ORCHARD_HAS_VIZ
void write_sphere_views(const std::filesystem::path& mesh, const std::string& prefix, const Surface& surface,
                        std::span<const Sphere> spheres, Outputs& outputs) {
  const auto name = [&](const char* ending) { return named(mesh, prefix + ending); };
  const SurfaceSampling points = points_of(surface);
  ViewArray gaps{.name = "gap", .values = {}};
  for (const Point& point : points.points) gaps.values.push_back(std::max(0.0, gap_from(spheres, point)));
  write_mesh(outputs.add(name("-mesh.vtp")), surface);
  write_points(outputs.add(name("-points.vtp")), points, {gaps});
  write_tree_level(outputs.add(name("-spheres.vtp")),
                   ball_tree(spheres, static_cast<Index>(std::max<std::size_t>(2, spheres.size()))), 1);
  const std::vector<NamedFile> files{
      {"mesh", name("-mesh.vtp")}, {"surface points", name("-points.vtp")}, {"spheres", name("-spheres.vtp")}};
  write_multiblock(
      outputs.add(name(".vtm"), "open this in ParaView: the mesh, the spheres, and how far each place is from them"),
      files);
}

void draw_spheres(const std::string& name, const std::string& title, const std::string& up, const Surface& surface,
                  std::span<const Sphere> spheres, Outputs& outputs) {
  const SphereTree set = ball_tree(spheres, static_cast<Index>(std::max<std::size_t>(2, spheres.size())));
  PipelinePicture picture;
  picture.values.surface = &surface;
  picture.values.spheres = &set;
  picture.title = title;
  picture.up = parse_up(up);
  picture.progress = cancelled_by_interrupts();
  if (is_drawn(draw_pipeline(outputs.staged(name), picture)))
    outputs.add(name, "the mesh and the spheres as a picture");
}

void draw_holes(const std::filesystem::path& mesh, const std::string& up, const Surface& surface,
                std::span<const Sphere> spheres, Outputs& outputs) {
  const double diagonal = surface.bounding_box().diagonal().norm();
  const SurfaceSampling points = points_of(surface);
  MedialMesh balls = as_triangles(spheres);
  MedialErrorsOfAxis errors{
      .mesh = &balls, .coverage = {}, .protrusion = std::vector<double>(balls.centers.size(), 0), .worst = {}};
  for (const Point& point : points.points)
    errors.coverage.push_back(100 / diagonal * std::max(0.0, gap_from(spheres, point)));
  for (std::size_t i = 0; surface.solid() && i < balls.centers.size(); ++i)
    errors.protrusion[i] = 100 / diagonal * std::max(0.0, surface.signed_distance(balls.centers[i]));
  const std::string name = named(mesh, "-audit.png");
  PipelinePicture picture;
  picture.title = mesh.stem().string();
  picture.up = parse_up(up);
  picture.progress = cancelled_by_interrupts();
  if (is_drawn(draw_medial_errors(outputs.staged(name),
                                  {.surface = &surface, .sampling = &points, .axes = {std::move(errors)}}, picture)))
    outputs.add(name, "where the surface is open and where spheres stick out, as a picture");
}
#else
void write_sphere_views(const std::filesystem::path&, const std::string&, const Surface&, std::span<const Sphere>,
                        Outputs&) {}

void draw_spheres(const std::string&, const std::string&, const std::string&, const Surface&, std::span<const Sphere>,
                  Outputs&) {
  fmt::print(stderr, "orchard: no picture was made: this program was built without VTK\n");
}

void draw_holes(const std::filesystem::path&, const std::string&, const Surface&, std::span<const Sphere>, Outputs&) {
  fmt::print(stderr, "orchard: no picture was made: this program was built without VTK\n");
}
#endif

}  // namespace orchard::apps
