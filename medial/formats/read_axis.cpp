#include "orchard/medial/read_axis.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <iterator>

#include "../ma_text.h"
#include "axis_text.h"
#include "orchard/geometry/error.h"

namespace orchard {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string bytes_of(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) throw InputError(file.string() + ": this is a folder; give a file");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string() + ": the file cannot be opened; check that it exists and its permissions");
  return std::string(std::istreambuf_iterator<char>(in), {});
}

bool one_of(const std::string& extension, std::initializer_list<const char*> known) {
  return std::find(known.begin(), known.end(), extension) != known.end();
}

ForeignAxis read_by_extension(const std::filesystem::path& file) {
  const std::string extension = lower(file.extension().string());
  if (one_of(extension, {".ma", ".ma_dup", ".ma_struct"})) return detail::parse_ma_axis(TextLines(file));
  if (one_of(extension, {".obj", ".off"})) return detail::read_axis_family(file);
  if (extension == ".cg") return detail::parse_obj_axis(TextLines(file), true);
  if (extension == ".sph") return detail::parse_sph_axis(TextLines(file));
  if (extension == ".swc") return detail::parse_swc_axis(TextLines(file));
  const bool polylines = lower(file.stem().extension().string()) == ".polylines";
  if (extension == ".cgal" || (extension == ".txt" && polylines)) return detail::parse_polylines(TextLines(file));
  if (extension == ".ply") return detail::parse_ply_axis(bytes_of(file), file.string());
  if (one_of(extension, {".txt", ".xyz", ".xyzr", ".balls"})) return detail::parse_balls(file.string(), bytes_of(file));
  std::string known;
  for (const char* one : axis_extensions()) known += std::string(known.empty() ? "" : ", ") + one;
  throw InputError(file.string() + ": \"" + extension + "\" is no format of medial axes that can be read; use one of " +
                   known);
}

}  // namespace

std::span<const char* const> axis_extensions() {
  static constexpr std::array kAll{".ma",  ".ma_dup", ".ma_struct", ".obj", ".ply", ".off",  ".sph",
                                   ".swc", ".cg",     ".cgal",      ".txt", ".xyz", ".xyzr", ".balls"};
  return kAll;
}

ForeignAxis detail::parse_ma_axis(TextLines lines) {
  const FlaggedMedialMesh flagged = parse_ma(std::move(lines));
  ForeignAxis axis;
  axis.mesh = without_deleted(flagged);
  const auto differ = [](std::size_t all, std::size_t kept, const char* what, ForeignAxis& own) {
    if (all == kept) return false;
    own.notes.push_back(std::to_string(all - kept) + ' ' + what + " are deleted in the file and left out");
    return true;
  };
  bool renumbered = differ(flagged.mesh.centers.size(), axis.mesh.centers.size(), "vertices", axis);
  renumbered |= differ(flagged.mesh.edges.size(), axis.mesh.edges.size(), "edges", axis);
  renumbered |= differ(flagged.mesh.triangles.size(), axis.mesh.triangles.size(), "triangles", axis);
  if (!renumbered) axis.structure = flagged.structure;
  if (flagged.tetrahedra > 0)
    axis.notes.push_back(std::to_string(flagged.tetrahedra) +
                         " tetrahedra are left out: their triangles stay, and enclose them");
  return axis;
}

ForeignAxis read_axis(const std::filesystem::path& file) {
  ForeignAxis axis = read_by_extension(file);
  if (axis.files.empty()) axis.files = {file};
  try {
    validate(axis.mesh);
  } catch (const InputError& error) {
    throw InputError(file.string() + ": " + error.what());
  }
  return axis;
}

}  // namespace orchard
