#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string_view>

#include "orchard/geometry/error.h"
#include "orchard/medial/medial_mesh.h"

namespace orchard {
namespace {

void append(std::string& text, double value) {
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
  (void)error;  // 32 characters hold every double
  text += ' ';
  text.append(digits, end);
}

void append(std::string& text, Index value) { text += ' ' + std::to_string(value); }

class MaReader {
 public:
  MaReader(std::string name, std::string_view text) : name_(std::move(name)), rest_(text) {}

  MedialMesh run() {
    if (!next_line()) fail("is empty; a .ma file starts with its numbers of vertices, edges and faces");
    vertices_ = index(), edges_ = index(), faces_ = index();
    if (vertices_ == 0) fail("promises no vertices");
    for (std::size_t i = 0; i < vertices_; ++i) read_vertex();
    for (std::size_t i = 0; i < edges_; ++i) mesh_.edges.push_back(corners<2>('e'));
    for (std::size_t i = 0; i < faces_; ++i) mesh_.triangles.push_back(corners<3>('f'));
    complete(mesh_);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& fault) const {
    throw InputError(name_ + ", line " + std::to_string(line_number_) + ": " + fault);
  }

  // The next line that holds anything; false at the end.
  bool next_line() {
    while (!rest_.empty()) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      line_ = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++line_number_;
      skip_space();
      if (!line_.empty() && line_[0] != '#') return true;
    }
    return false;
  }
  void skip_space() {
    while (!line_.empty() && (line_[0] == ' ' || line_[0] == '\t' || line_[0] == '\r')) line_.remove_prefix(1);
  }
  template <class Number>
  Number number(const char* what) {
    skip_space();
    Number value{};
    const auto [end, error] = std::from_chars(line_.data(), line_.data() + line_.size(), value);
    if (error != std::errc())
      fail("expected " + std::string(what) + " at \"" + std::string(line_.substr(0, 20)) + "\"");
    line_.remove_prefix(static_cast<std::size_t>(end - line_.data()));
    return value;
  }
  Index index() { return number<Index>("a whole number"); }
  double real() {
    const double value = number<double>("a number");
    if (!std::isfinite(value)) fail("a number that is not finite");
    return value;
  }

  void expect(char kind) {
    if (!next_line()) fail("the file ends before all that its first line promises; it may be cut off");
    if (line_[0] != kind) {
      fail(std::string("expected a line that starts with \"") + kind + "\" as the first line of the file promises");
    }
    line_.remove_prefix(1);
  }
  void read_vertex() {
    expect('v');
    const double x = real(), y = real(), z = real(), radius = real();
    if (radius < 0) fail("a negative radius");
    mesh_.centers.emplace_back(x, y, z);
    mesh_.radii.push_back(radius);
  }
  template <std::size_t kCorners>
  std::array<Index, kCorners> corners(char kind) {
    expect(kind);
    std::array<Index, kCorners> result;
    for (std::size_t k = 0; k < kCorners; ++k) {
      result[k] = index();
      if (result[k] >= vertices_) fail("a vertex number beyond the last vertex (they count from 0)");
      for (std::size_t before = 0; before < k; ++before) {
        if (result[before] == result[k]) fail("a vertex number twice");
      }
    }
    return result;
  }

  std::string name_;
  std::string_view rest_, line_;
  std::size_t line_number_ = 0;
  Index vertices_ = 0, edges_ = 0, faces_ = 0;
  MedialMesh mesh_;
};

}  // namespace

std::string to_ma(const MedialMesh& mesh) {
  std::string text = std::to_string(mesh.centers.size()) + ' ' + std::to_string(mesh.edges.size()) + ' ' +
                     std::to_string(mesh.triangles.size()) + '\n';
  for (std::size_t i = 0; i < mesh.centers.size(); ++i) {
    text += 'v';
    for (int axis = 0; axis < 3; ++axis) append(text, mesh.centers[i][axis]);
    append(text, mesh.radii[i]);
    text += '\n';
  }
  for (const auto& [a, b] : mesh.edges) {
    text += 'e';
    append(text, a), append(text, b);
    text += '\n';
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    text += 'f';
    append(text, a), append(text, b), append(text, c);
    text += '\n';
  }
  return text;
}

MedialMesh read_ma(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string() + ": cannot be opened");
  const std::string text(std::istreambuf_iterator<char>(in), {});
  if (in.bad()) throw InputError(file.string() + ": cannot be read");
  return MaReader(file.string(), text).run();
}

}  // namespace orchard
