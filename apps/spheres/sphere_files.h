#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "orchard/geometry/surface.h"

// Sets of spheres as other tools ship them: what audit reads.
namespace orchard::apps {

// What the coordinates of a link's spheres are relative to.
enum class SphereFrame {
  link,     // the link
  element,  // one of the link's collision elements: before its origin
  mesh      // the mesh file of one of them: before its scale and its origin
};

// The spheres of one link of a robot, or of the one object that a file is about.
struct SphereGroup {
  std::string name;             // of the link; empty: the file names none
  std::vector<Sphere> spheres;  // radii above 0
  Index switched_off = 0;       // spheres whose radius is zero or below, which means that they do not count
  double buffer = 0;            // that the file adds to the link's radii, in its unit of length
  std::vector<double> masses;   // of `spheres`, where the file has them
  SphereFrame frame = SphereFrame::link;
  Index element = 0;  // of the link's collision elements, where the frame is one of theirs
};

struct SphereFile {
  std::string format;  // in words
  std::vector<SphereGroup> groups;
};

// Reads spheres by the ending of the file:
//   - .txt .csv .xyz: x y z r a line, parted by blanks, commas or semicolons; a header and further columns are left
//   out, but for a last column `link` of .csv, which the header names;
//   - .json: lists of [x, y, z, r] or of objects with origin (or center) and radius, levels of such lists, of which the
//     deepest counts, {centers, radii} and masses if there are any, or one of these for each link by name; what VAMP's
//     generator reads, which names a URDF: the spheres of that;
//   - .yml .yaml .xrdf: robots of cuRobo and of Isaac, with their buffers;
//   - .urdf: the spheres among a link's collision geometry, in the link's frame, and those of links LINK_sphereK that
//   are
//     fixed to it, as MorphIt writes them;
//   - .srdf: link_sphere_approximation, in the frame of the link's first collision element;
//   - .xml: MJCF, the spheres of each body;
//   - .mol: molecules of LAMMPS; .py: clumps of YADE;
//   - .ply: vertices with a radius;
//   - .sph .orchard: the leaves of a tree;
//   - a folder of MorphIt's files, LINK_K.json: in the frame of the mesh of the K-th collision element of that link.
// A radius of zero or below switches its sphere off. Throws InputError naming file, line (of JSON and PLY: link or row)
// and fault, also for what is not a finite number and for files without a sphere.
SphereFile read_sphere_file(const std::filesystem::path& file);

// The group of that name; with an empty name the only one. Throws InputError, which lists the names, if there is no
// such group or there are several.
const SphereGroup& group_named(const SphereFile& spheres, const std::filesystem::path& file, const std::string& name);

// Adds a sphere, or counts it as switched off. Throws InputError, which begins with `where`, if a number is not finite.
void add_sphere(SphereGroup& group, const Point& center, double radius, const std::string& where);

SphereFile read_json_spheres(const std::filesystem::path& file);  // as read_sphere_file(), which calls them
SphereFile read_yaml_spheres(const std::filesystem::path& file);
SphereFile read_text_spheres(const std::filesystem::path& file);
SphereFile read_urdf_spheres(const std::filesystem::path& file);
SphereFile read_srdf_spheres(const std::filesystem::path& file);
SphereFile read_mjcf_spheres(const std::filesystem::path& file);
SphereFile read_lammps_spheres(const std::filesystem::path& file);
SphereFile read_yade_spheres(const std::filesystem::path& file);

}  // namespace orchard::apps
