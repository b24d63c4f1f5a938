#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "orchard/spheretree/set_weights.h"

// Where looseness counts more, as the command line and files say it.
namespace orchard::apps {

// "x,y,z,r=F" of a ball, or "x,y,z,x,y,z=F" of a box by two opposite corners. Throws CLI::ValidationError.
WeightRegion parse_weight(const std::string& text);

// A number for each vertex in the order of the mesh, one a line. Throws InputError naming file and line.
std::vector<double> read_vertex_weights(const std::filesystem::path& file);

}  // namespace orchard::apps
