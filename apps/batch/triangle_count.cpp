#include "batch/triangle_count.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>

#include "input/input_file.h"

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kBytesOfOther = 100;  // of a triangle in other formats, about
constexpr std::size_t kStlHeader = 84, kStlFacet = 50, kMostHeaderLines = 1000;

std::uint64_t lines_that_begin_with(std::ifstream& in, const std::string& word) {
  std::uint64_t count = 0;
  for (std::string line; std::getline(in, line);) {
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin != std::string::npos && line.compare(begin, word.size(), word) == 0) ++count;
  }
  return count;
}

std::uint64_t of_stl(std::ifstream& in, std::uint64_t bytes) {
  std::array<unsigned char, kStlHeader> header{};
  if (!in.read(reinterpret_cast<char*>(header.data()), header.size())) return 0;
  std::uint64_t promised = 0;
  for (std::size_t i = 0; i < 4; ++i) promised |= std::uint64_t{header[80 + i]} << 8 * i;
  const std::uint64_t room = (bytes - kStlHeader) / kStlFacet;
  const bool text = std::string(header.begin(), header.begin() + 5) == "solid" && promised != room;
  if (!text) return std::min(promised, room);
  in.seekg(0);
  return lines_that_begin_with(in, "facet");
}

std::uint64_t of_ply(std::ifstream& in) {
  std::string line;
  std::uint64_t vertices = 0;
  for (std::size_t i = 0; i < kMostHeaderLines && std::getline(in, line) && !line.starts_with("end_header"); ++i) {
    std::istringstream words(line);
    std::string element, name;
    std::uint64_t count = 0;
    if (!(words >> element >> name >> count) || element != "element") continue;
    if (name == "vertex") vertices = count;
    if (name == "face") return count;
    // True of closed surfaces; the lengths of the strips come after the header.
    if (name == "tristrips") return 2 * vertices;
  }
  return 0;
}

std::uint64_t of_off(std::ifstream& in) {
  std::string line;
  for (std::size_t i = 0; i < kMostHeaderLines && std::getline(in, line); ++i) {
    std::istringstream words(line.starts_with("OFF") ? line.substr(3) : line);
    std::uint64_t vertices = 0, faces = 0;
    if (words >> vertices >> faces) return faces;
  }
  return 0;
}

}  // namespace

std::uint64_t count_triangles(const fs::path& mesh) {
  std::ifstream in(mesh, std::ios::binary);
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(mesh, error);
  if (!in || error) return 0;
  const std::string ending = lower_extension(mesh);
  const std::uint64_t count = ending == ".stl"   ? of_stl(in, bytes)
                              : ending == ".ply" ? of_ply(in)
                              : ending == ".off" ? of_off(in)
                              : ending == ".obj" ? lines_that_begin_with(in, "f ")
                                                 : bytes / kBytesOfOther;
  // A damaged header may contain any number, but a face takes at least a byte.
  return std::min<std::uint64_t>(count, bytes);
}

}  // namespace orchard::apps
