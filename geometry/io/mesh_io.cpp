#include "orchard/geometry/mesh_io.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <string>

#include "mesh_formats.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"

namespace orchard {
namespace {

std::string format_of(const std::filesystem::path& file, const std::string& format) {
  std::string name = format.empty() ? file.extension().string() : format;
  if (format.empty() && !name.empty()) name.erase(0, 1);
  for (char& c : name) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return name;
}

using Reader = TriangleMesh (*)(std::string_view, const std::string&, MeshReadReport&);

// A format with its readers: of meshes, none where there are only points, and of points or a mesh.
struct Format {
  std::string_view name;
  Reader mesh, any;
};
constexpr std::array kFormats{Format{"obj", read_obj, read_obj_or_points},
                              Format{"ply", read_ply, read_ply_or_points},
                              Format{"stl", read_stl, read_stl},
                              Format{"off", read_off, read_off},
                              Format{"vtp", read_vtk_xml, read_vtk_xml},
                              Format{"vtu", read_vtk_xml, read_vtk_xml},
                              Format{"vtk", read_legacy_vtk, read_legacy_vtk},
                              Format{"msh", read_gmsh, read_gmsh},
                              Format{"mesh", read_medit, read_medit},
                              Format{"meshb", read_binary_medit, read_binary_medit},
                              Format{"xyz", nullptr, read_xyz}};

Reader reader_for(const std::filesystem::path& file, const std::string& format, bool needs_faces) {
  const std::string name = format_of(file, format);
  std::string known;
  for (const Format& one : kFormats) {
    const Reader reader = needs_faces ? one.mesh : one.any;
    if (reader == nullptr) continue;
    if (one.name == name) return reader;
    known += (known.empty() ? "." : ", .") + std::string(one.name);
  }
  throw InputError(file.string() + ": unknown " + (needs_faces ? "mesh format \"" : "format \"") +
                   (name.empty() ? "" : ".") + name + "\"; known are " + known);
}

// Collects text in memory and writes it to the stream in large pieces.
class TextBuffer {
 public:
  explicit TextBuffer(std::ostream& stream) : stream_(stream) {}
  ~TextBuffer() { flush(); }
  TextBuffer(const TextBuffer&) = delete;
  TextBuffer& operator=(const TextBuffer&) = delete;

  TextBuffer& operator<<(char c) {
    if (size_ + kLongestNumber > buffer_.size()) flush();
    buffer_[size_++] = c;
    return *this;
  }
  // Writes a number with the fewest digits (17 at most) that read back as the same number.
  template <typename Number>
  void number(Number value) {
    if (size_ + kLongestNumber > buffer_.size()) flush();
    size_ = static_cast<std::size_t>(std::to_chars(buffer_.data() + size_, buffer_.data() + buffer_.size(), value).ptr -
                                     buffer_.data());
  }

 private:
  static constexpr std::size_t kLongestNumber = 32;
  void flush() {
    stream_.write(buffer_.data(), static_cast<std::streamsize>(size_));
    size_ = 0;
  }
  std::ostream& stream_;
  std::array<char, 1 << 16> buffer_;
  std::size_t size_ = 0;
};

}  // namespace

// In one read: a mapped file that someone cuts short meanwhile would kill the process.
std::string read_bytes(const std::filesystem::path& file) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) throw InputError(file.string() + ": there is no such file");
  if (status.type() == fs::file_type::directory)
    throw InputError(file.string() + ": this is a folder; give a mesh file");
  if (status.type() != fs::file_type::regular)
    throw InputError(file.string() + ": this is not a regular file; give a mesh file");
  const std::uintmax_t size = fs::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  if (error || !stream) throw InputError(file.string() + ": cannot be opened for reading; check its permissions");
  if (size == 0) throw InputError(file.string() + ": the file is empty");
  std::string bytes(size, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size)
    throw InputError(file.string() + ": the file cannot be read to its end; check the disk");
  return bytes;
}

std::vector<std::string> mesh_formats() {
  std::vector<std::string> names;
  for (const Format& format : kFormats)
    if (format.mesh != nullptr) names.emplace_back(format.name);
  return names;
}

MeshReading read_mesh_and_report(const std::filesystem::path& file, const std::string& format) {
  const Reader reader = reader_for(file, format, true);
  MeshReading reading;
  reading.mesh = reader(read_bytes(file), file.string(), reading.report);
  try {
    require_usable_size(reading.mesh);
  } catch (const InputError& error) {
    throw InputError(file.string() + ": " + error.what());
  }
  return reading;
}

TriangleMesh read_mesh(const std::filesystem::path& file) { return read_mesh_and_report(file).mesh; }

MeshReading read_points_or_mesh_and_report(const std::filesystem::path& file, const std::string& format) {
  const Reader reader = reader_for(file, format, false);
  MeshReading reading;
  reading.mesh = reader(read_bytes(file), file.string(), reading.report);
  return reading;
}

TriangleMesh read_points_or_mesh(const std::filesystem::path& file) {
  return read_points_or_mesh_and_report(file).mesh;
}

void write_obj(const std::filesystem::path& file, const TriangleMesh& mesh) {
  write_file(file, [&](std::ostream& stream) {
    TextBuffer text(stream);
    for (const Point& vertex : mesh.vertices) {
      text << 'v';
      for (const double coordinate : vertex) (text << ' ').number(coordinate);
      text << '\n';
    }
    for (const auto& corners : mesh.triangles) {
      text << 'f';
      for (const Index corner : corners) (text << ' ').number(corner + 1);
      text << '\n';
    }
  });
}

}  // namespace orchard
