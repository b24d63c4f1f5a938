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

// Reads the file at once instead of mapping it: if a mapped file is cut short meanwhile, the process is killed.
std::string read_bytes(const std::filesystem::path& file) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) throw InputError(file.string() + ": no such file");
  if (status.type() == fs::file_type::directory) throw InputError(file.string() + ": a folder, not a mesh file");
  if (status.type() != fs::file_type::regular)
    throw InputError(file.string() + ": not a regular file that can be read");
  const std::uintmax_t size = fs::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  if (error || !stream) throw InputError(file.string() + ": cannot be opened for reading; check its permissions");
  if (size == 0) throw InputError(file.string() + ": the file is empty");
  std::string bytes(size, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size)
    throw InputError(file.string() + ": cannot be read to its end");
  return bytes;
}

std::string lower_case_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

using Reader = TriangleMesh (*)(std::string_view, const std::string&, MeshReadReport&);

Reader reader_for(const std::filesystem::path& file) {
  const std::string extension = lower_case_extension(file);
  if (extension == ".obj") return read_obj;
  if (extension == ".ply") return read_ply;
  if (extension == ".stl") return read_stl;
  if (extension == ".off") return read_off;
  throw InputError(file.string() + ": unknown mesh format \"" + extension + "\"; use .obj, .ply, .stl or .off");
}

Reader point_reader_for(const std::filesystem::path& file) {
  const std::string extension = lower_case_extension(file);
  if (extension == ".xyz") return read_xyz;
  if (extension == ".obj") return read_obj_or_points;
  if (extension == ".ply") return read_ply_or_points;
  if (extension == ".stl") return read_stl;
  if (extension == ".off") return read_off;
  throw InputError(file.string() + ": unknown format \"" + extension +
                   "\"; points: .xyz, .ply or .obj; meshes: .obj, .ply, .stl or .off");
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

MeshReading read_mesh_and_report(const std::filesystem::path& file) {
  const Reader reader = reader_for(file);
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

MeshReading read_points_or_mesh_and_report(const std::filesystem::path& file) {
  const Reader reader = point_reader_for(file);
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
