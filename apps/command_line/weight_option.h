#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "orchard/spheretree/set_weights.h"

// Reads from the command line and from files where looseness counts more.
namespace orchard::apps {

// Parses "x,y,z,r=F" for a ball, or "x,y,z,x,y,z=F" for a box with these opposite corners. Throws CLI::ValidationError.
WeightRegion parse_weight(const std::string& text);

// Reads a number for each vertex in the order of the mesh, one on each line. Throws InputError, which names file and
// line.
std::vector<double> read_vertex_weights(const std::filesystem::path& file);

}  // namespace orchard::apps
