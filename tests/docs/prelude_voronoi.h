// What the page about Voronoi diagrams leaves to its reader.
#include <vector>

#include "orchard/geometry/mesh.h"

std::vector<orchard::Point> read_points();
extern std::vector<orchard::Point> more_points;
void use(const orchard::Point& point);
