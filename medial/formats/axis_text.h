#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "orchard/geometry/text_lines.h"
#include "orchard/medial/read_axis.h"

// The readers behind read_axis(), one for each kind of text. They accept any text: either the result has a complete and
// valid mesh, or InputError names the faulty line.
namespace orchard::detail {

ForeignAxis parse_ma_axis(TextLines lines);
// `cg`: edges are lines "e i j", as in .cg files.
ForeignAxis parse_obj_axis(TextLines lines, bool cg = false);
ForeignAxis parse_off_axis(TextLines lines);
ForeignAxis parse_sph_axis(TextLines lines);
ForeignAxis parse_swc_axis(TextLines lines);
ForeignAxis parse_polylines(TextLines lines);
ForeignAxis parse_balls(const std::string& name, std::string text);
// A PLY file, ASCII or binary.
ForeignAxis parse_ply_axis(std::string_view bytes, const std::string& name);

// The files that Point2Skeleton and similar programs write side by side for one axis.
ForeignAxis read_axis_family(const std::filesystem::path& file);

}  // namespace orchard::detail
