#pragma once
#include <string>
#include <utility>
#include <vector>

#include "orchard/geometry/surface.h"
#include "orchard/medial/axis.h"
#include "orchard/medial/medial_mesh.h"
#include "output/array_files.h"

// A medial axis as arrays, for NumPy, Octave and tables.
namespace orchard::apps {

// Where balls touch the surface.
struct AxisContacts {
  std::vector<Index> balls;   // the ball of each contact, ascending
  std::vector<Point> places;  // of the surface
};
// Those of an axis that was built: its forming points. Its vertices are the first balls of its medial mesh.
AxisContacts contacts_of(const MedialAxis& axis);
// Of any other axis: the place of the surface nearest to each centre.
AxisContacts contacts_of(const Surface& surface, const MedialMesh& mesh);

// balls (x, y, z, radius; mesh units), structure (the number of the part that each ball is in, as in the .ma file) and
// structure_kind (0 sheet, 1 seam, 2 border, 3 junction, 4 curve), edges and triangles (balls, from 0), contacts (x, y,
// z) and contact_ball.
std::vector<NamedArray> axis_arrays(const MedialMesh& mesh, const AxisContacts& contacts);
// The same as tables: the ending of the file's name (-balls.csv, -edges.csv, -triangles.csv, -contacts.csv), its text.
std::vector<std::pair<std::string, std::string>> axis_tables(const MedialMesh& mesh, const AxisContacts& contacts);
// These endings.
std::vector<std::string> axis_table_endings();

}  // namespace orchard::apps
