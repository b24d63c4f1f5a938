#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "orchard/geometry/surface.h"
#include "output/outputs.h"

// Views and pictures of a set of spheres beside a mesh. Without VTK they are left out.
namespace orchard::apps {

// The endings of the files that write_sphere_views() may write.
std::vector<std::string> sphere_view_endings(const std::string& prefix);

// MODEL + prefix + .vtm and its parts: the mesh, the spheres, and points of the surface with `gap`, how far each is
// from the union of the spheres (below 0: inside).
void write_sphere_views(const std::filesystem::path& mesh, const std::string& prefix, const Surface& surface,
                        std::span<const Sphere> spheres, Outputs& outputs);

// `name`: the mesh and the spheres around it as a picture. `up`: x, y or z.
void draw_spheres(const std::string& name, const std::string& title, const std::string& up, const Surface& surface,
                  std::span<const Sphere> spheres, Outputs& outputs);

// MODEL-audit.png: where the surface is open, and which spheres stick out, each from two sides. `up`: x, y or z.
void draw_holes(const std::filesystem::path& mesh, const std::string& up, const Surface& surface,
                std::span<const Sphere> spheres, Outputs& outputs);

}  // namespace orchard::apps
