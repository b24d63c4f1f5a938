#pragma once
#include <string>
#include <utility>
#include <vector>

#include "medial/axis_importance.h"
#include "orchard/medial/contacts.h"
#include "orchard/medial/medial_mesh.h"
#include "output/array_files.h"

// Turns a medial axis into arrays, for NumPy, Octave and tables.
namespace orchard::apps {

// Returns these arrays: balls (x, y, z, radius; mesh units), structure (the number of the part that each ball is in, as
// in the .ma file), structure_kind (0 sheet, 1 seam, 2 border, 3 junction, 4 curve), edges and triangles (numbers of
// balls, from 0), contacts (x, y, z) with contact_ball and contact_sample, and samples (x, y, z) with sample_ball,
// where 4294967295 means none. After these come the arrays of `importance`, with a value for each ball.
std::vector<NamedArray> axis_arrays(const MedialMesh& mesh, const AxisContacts& contacts,
                                    const std::vector<ImportanceArray>& importance);
// Returns the same as tables: for each, the ending of the file's name (-balls.csv, -edges.csv, -triangles.csv,
// -contacts.csv, -samples.csv) and the text.
std::vector<std::pair<std::string, std::string>> axis_tables(const MedialMesh& mesh, const AxisContacts& contacts,
                                                             const std::vector<ImportanceArray>& importance);
// Returns these endings.
std::vector<std::string> axis_table_endings();

}  // namespace orchard::apps
