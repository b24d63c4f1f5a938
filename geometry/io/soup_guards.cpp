#include "soup_guards.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <optional>

#include "io/text_scan.h"

namespace orchard {
namespace {

// The lines of a text, split into words.
class LineScanner {
 public:
  // `comment` starts one that runs to the end of the line; 0 if the format has none.
  LineScanner(std::string_view bytes, std::size_t at, char comment, const std::string& name)
      : bytes_(bytes), name_(name), comment_(comment), next_(at) {}

  // Moves to the next line that has a word; false at the end.
  bool next() {
    while (next_ < bytes_.size()) {
      start_ = next_;
      const std::size_t stop = std::min(bytes_.find_first_of("\r\n", next_), bytes_.size());
      next_ = stop + 1;
      std::string_view line = bytes_.substr(start_, stop - start_);
      if (comment_ != 0) line = line.substr(0, line.find(comment_));
      at_ = line.data();
      end_ = line.data() + line.size();
      skip_blanks();
      if (at_ != end_) return true;
    }
    return false;
  }
  // Whether a word follows, on this line or, moving there, on a later one.
  bool more() { return at_ != end_ || next(); }
  std::size_t start() const { return start_; }
  std::size_t left() const { return bytes_.size() - start_; }
  [[noreturn]] void fail(const std::string& fault) const { fail_at_line(name_, bytes_, start_, fault); }

  // Empty if the line has no more words.
  std::string_view word() {
    const char* first = at_;
    while (at_ != end_ && !is_blank(*at_)) ++at_;
    const std::string_view result(first, static_cast<std::size_t>(at_ - first));
    skip_blanks();
    return result;
  }
  // Of the next word; the line stays where it is if there is none or it is no such number.
  std::optional<double> number() {
    double value = 0;
    const char* first = at_;
    if (!scan_double(at_, end_, value) || !word_ended() || !std::isfinite(value)) return no_number(first);
    skip_blanks();
    return value;
  }
  std::optional<std::uint64_t> count() {
    std::int64_t value = 0;
    const char* first = at_;
    if (!scan_integer(at_, end_, value) || !word_ended() || value < 0) return no_number(first);
    skip_blanks();
    return static_cast<std::uint64_t>(value);
  }
  std::array<double, 3> point() {
    std::array<double, 3> result;
    for (double& coordinate : result) {
      const std::optional<double> value = number();
      if (!value) fail("vertex needs three finite numbers");
      coordinate = *value;
    }
    return result;
  }

 private:
  bool word_ended() const { return at_ == end_ || is_blank(*at_); }
  std::nullopt_t no_number(const char* first) {
    at_ = first;
    return std::nullopt;
  }
  void skip_blanks() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
  }

  std::string_view bytes_;
  const std::string& name_;
  char comment_;
  std::size_t next_ = 0, start_ = 0;
  const char* at_ = nullptr;
  const char* end_ = nullptr;
};

// In the fewest digits that read back as the same number.
template <typename Number>
void append_number(std::string& text, Number value) {
  std::array<char, 32> digits;
  text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

void append_point(std::string& text, const std::array<double, 3>& point) {
  for (const double coordinate : point) append_number(text += ' ', coordinate);
  text += '\n';
}

constexpr std::size_t kStlHeader = 84, kStlTriangle = 50;

std::uint32_t stl_triangle_count(std::string_view bytes) {
  std::uint32_t count = 0;
  for (std::size_t byte = 4; byte-- > 0;) count = count << 8 | static_cast<unsigned char>(bytes[80 + byte]);
  return count;
}

void check_binary_stl(std::string_view bytes, const std::string& name) {
  if (bytes.size() < kStlHeader) {
    throw InputError(name + ": neither \"solid\" nor the 84 bytes that a binary STL file begins with");
  }
  const std::uint64_t triangles = stl_triangle_count(bytes);
  if (triangles > (bytes.size() - kStlHeader) / kStlTriangle) {
    fail_at_byte(name, 80,
                 "promises " + std::to_string(triangles) + " triangles, but the file ends at byte " +
                     std::to_string(bytes.size()));
  }
  for (std::uint64_t t = 0; t < triangles; ++t) {
    for (std::size_t i = 0; i < 9; ++i) {
      const std::size_t at = kStlHeader + t * kStlTriangle + 12 + 4 * i;
      float coordinate;
      std::memcpy(&coordinate, bytes.data() + at, 4);
      if (!std::isfinite(coordinate)) fail_at_byte(name, at, "a coordinate that is not a finite number");
    }
  }
}

// The words that open the lines of a facet, in order.
constexpr std::array<std::string_view, 7> kFacetLines{"facet",  "outer",   "vertex",  "vertex",
                                                      "vertex", "endloop", "endfacet"};

// Returns one solid of nothing but keywords and numbers: CGAL takes keywords for what they are wherever they turn up,
// in the name of a solid as well.
std::string check_ascii_stl(std::string_view bytes, const std::string& name) {
  std::string result = "solid\n";
  bool ended = false;
  for (LineScanner line(bytes, 0, 0, name); line.next();) {
    const std::string_view keyword = line.word();
    ended = keyword == "endsolid";
    if (ended || keyword == "solid") continue;
    for (std::size_t i = 0; i < kFacetLines.size(); ++i) {
      if (i > 0 && !line.next()) throw InputError(name + ": the file ends within a facet");
      const std::string_view word = i == 0 ? keyword : line.word();
      if (word != kFacetLines[i]) {
        line.fail("expected \"" + std::string(kFacetLines[i]) + "\" instead of " + in_quotes(word) +
                  " (the facets of STL are triangles)");
      }
      result += word;
      word == "vertex" ? append_point(result, line.point()) : result.push_back('\n');
    }
  }
  if (!ended) throw InputError(name + ": the file ends without \"endsolid\"");
  return result += "endsolid\n";
}

}  // namespace

std::string checked_stl(std::string_view bytes, const std::string& name) {
  // Many binary files begin with "solid" too; their length gives them away.
  const bool exact_length = bytes.size() >= kStlHeader &&
                            bytes.size() == kStlHeader + kStlTriangle * std::uint64_t{stl_triangle_count(bytes)};
  LineScanner line(bytes, 0, 0, name);
  if (!exact_length && line.next() && line.word() == "solid") return check_ascii_stl(bytes, name);
  check_binary_stl(bytes, name);
  std::string result(bytes);
  std::fill_n(result.begin(), 80, '-');  // so that it does not begin with "solid"
  return result;
}

namespace {

class OffChecker {
 public:
  OffChecker(std::string_view bytes, const std::string& name)
      : bytes_(bytes), name_(name), line_(bytes, bytes.starts_with("\xef\xbb\xbf") ? 3 : 0, '#', name) {}

  std::string run() {
    read_counts();
    result_ = "OFF\n" + std::to_string(vertices_) + " " + std::to_string(faces_) + " 0\n";
    for (std::uint64_t i = 0; i < vertices_; ++i) {
      if (!line_.next()) fail_at_end(i, vertices_, "vertices");
      append_point(result_, line_.point());
    }
    for (std::uint64_t i = 0; i < faces_; ++i) {
      if (!line_.next()) fail_at_end(i, faces_, "faces");
      read_face();
    }
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail_at_end(std::uint64_t found, std::uint64_t promised, const char* what) const {
    std::string fault = "the file ends after " + std::to_string(found) + " of " + std::to_string(promised) + " " + what;
    if (first_continued_ > 0) {
      const std::size_t at = line_number(bytes_, first_continued_);
      fault += "; the face of line " + std::to_string(at) + " has too few corners there and took the next lines' words";
    }
    line_.fail(fault);
  }

  // "OFF", which may be missing, and the numbers of vertices and faces after it, with or without a blank or on the next
  // line.
  void read_counts() {
    if (!line_.next()) throw InputError(name_ + ": nothing but comments; this is not an OFF file");
    std::optional<std::uint64_t> vertices = line_.count();
    if (!vertices) {
      vertices = count_after(line_.word());
      if (!vertices) vertices = line_.count();
    }
    if (!vertices) {
      const std::string_view other = line_.word();
      if (!other.empty()) line_.fail(in_quotes(other) + " after OFF; only text files are supported");
      if (!line_.next()) line_.fail("the file ends after its first line");
      vertices = line_.count();
    }
    const std::optional<std::uint64_t> faces = line_.count();
    if (!vertices || !faces) line_.fail("expected the numbers of vertices, faces and edges");
    // "0 0 0" and "3 0 0 0" with their line ends, the last of which may be missing.
    if (*vertices > line_.left() / 6 || *faces > line_.left() / 8 + 1) {
      line_.fail("promises " + std::to_string(*vertices) + " vertices and " + std::to_string(*faces) +
                 " faces, but only " + std::to_string(line_.left()) + " bytes are left");
    }
    vertices_ = *vertices;
    faces_ = *faces;
  }

  // The number that the keyword runs into, as in "OFF8 6 12"; nothing if it does not.
  std::optional<std::uint64_t> count_after(std::string_view keyword) const {
    // Normals, colours and texture coordinates follow a vertex's position and are left out by leaving out the prefix.
    const std::size_t prefix = std::min(keyword.find_first_not_of("STCN"), keyword.size());
    const std::string_view number = keyword.substr(std::min(prefix + 3, keyword.size()));
    std::int64_t count = 0;
    const char* at = number.data();
    const bool good =
        number.empty() || (scan_integer(at, number.data() + number.size(), count) && at == number.end() && count >= 0);
    if (!keyword.substr(prefix).starts_with("OFF") || !good) {
      line_.fail("expected OFF instead of " + in_quotes(keyword) + "; other dimensions are not supported");
    }
    if (number.empty()) return std::nullopt;
    return static_cast<std::uint64_t>(count);
  }

  // A face goes on over as many lines as its corners need; what follows them on the last one is its colour.
  void read_face() {
    const std::size_t start = line_.start();
    const std::optional<std::uint64_t> corners = line_.count();
    if (!corners || *corners < 3) line_.fail("a face begins with the number of its corners, 3 or more");
    append_number(result_, *corners);
    for (std::uint64_t j = 0; j < *corners; ++j) {
      const bool found = line_.more();
      if (first_continued_ == 0 && line_.start() != start) first_continued_ = start;
      const std::optional<std::uint64_t> vertex = found ? line_.count() : std::nullopt;
      if (!vertex || *vertex >= vertices_) {
        if (!found) line_.fail("the file ends before corner " + std::to_string(j + 1) + " of the face");
        line_.fail("corner " + std::to_string(j + 1) + " of the face is none of the " + std::to_string(vertices_) +
                   " vertices, counted from 0");
      }
      append_number(result_ += ' ', *vertex);
    }
    result_ += '\n';
  }

  std::string_view bytes_;
  const std::string& name_;
  LineScanner line_;
  std::uint64_t vertices_ = 0, faces_ = 0;
  std::size_t first_continued_ = 0;  // where the first face begins that is not on one line; 0 if there is none
  std::string result_;
};

}  // namespace

std::string checked_off(std::string_view bytes, const std::string& name) { return OffChecker(bytes, name).run(); }

}  // namespace orchard
