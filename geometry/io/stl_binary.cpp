#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "line_scanner.h"
#include "orchard/geometry/error.h"
#include "soup_guards.h"

namespace orchard {
namespace {

// A binary STL file is a header of 80 bytes, the number of facets, and then for each facet a normal, three corners and
// a 16-bit number. That number should count the attribute bytes that follow, but programs also store colours in it.
constexpr std::size_t kCountAt = 80, kHeader = 84, kCorners = 12, kAttributes = 48, kFacet = 50;
// A stored normal agrees with the corners if the cosine of the angle to their normal is at least the first, and its
// length differs from 1 by at most the second.
constexpr double kSameNormal = 0.99, kUnitLength = 1e-3;

std::uint64_t integer_at(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t byte = size; byte-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + byte]);
  return value;
}

using Corner = std::array<float, 3>;

Corner three_floats(std::string_view bytes, std::size_t at) {
  Corner corner;
  for (std::size_t i = 0; i < 3; ++i)
    corner[i] = std::bit_cast<float>(static_cast<std::uint32_t>(integer_at(bytes, at + 4 * i, 4)));
  return corner;
}

Vector vector_of(const Corner& corner) { return {corner[0], corner[1], corner[2]}; }

class BinaryStl {
 public:
  BinaryStl(std::string_view bytes, const std::string& name, MeshReadReport& report)
      : bytes_(bytes), name_(name), report_(report), promised_(integer_at(bytes, kCountAt, 4)) {}

  std::string run() {
    const std::uint64_t room = (bytes_.size() - kHeader) / kFacet;
    if (promised_ > room) {
      fail_at_byte(name_, kCountAt,
                   "promises " + std::to_string(promised_) + " triangles, but the file ends at byte " +
                       std::to_string(bytes_.size()) + ", after " + std::to_string(room) +
                       "; it is cut off, or its count is wrong: export it again");
    }
    if (bytes_.size() == kHeader + promised_ * kFacet || !find_behind_attributes()) {
      for (std::uint64_t t = 0; t < promised_; ++t) at_.push_back(kHeader + t * kFacet);
      if (bytes_.size() > kHeader + promised_ * kFacet) find_beyond_count(room);
    }
    return plain();
  }

 private:
  // Whether as many facets as the header counts, each followed by the attribute bytes that it counts, fill the file
  // exactly. If so, stores where they are.
  bool find_behind_attributes() {
    std::vector<std::size_t> places;
    std::size_t at = kHeader;
    while (places.size() < promised_ && at + kFacet <= bytes_.size()) {
      places.push_back(at);
      at += kFacet + integer_at(bytes_, at + kAttributes, 2);
    }
    if (places.size() < promised_ || at != bytes_.size()) return false;
    report_.attribute_bytes = bytes_.size() - kHeader - promised_ * kFacet;
    at_ = std::move(places);
    return true;
  }

  // The file is longer than the header's count: either the count is too low, or the bytes that follow are none of
  // facets. is_facet() tells the two apart.
  void find_beyond_count(std::uint64_t room) {
    std::vector<Corner> all;
    for (std::uint64_t t = 0; t < room; ++t)
      for (std::size_t i = 0; i < 3; ++i) all.push_back(corner(kHeader + t * kFacet, i));
    std::erase_if(all, [](const Corner& c) { return !vector_of(c).allFinite(); });
    std::sort(all.begin(), all.end());
    const auto is_facet_at = [&](std::uint64_t t) { return is_facet(kHeader + t * kFacet, all); };
    std::uint64_t found = promised_;
    while (found < room && is_facet_at(found)) at_.push_back(kHeader + found++ * kFacet);
    for (std::uint64_t t = found; t < room; ++t) {
      if (!is_facet_at(t)) continue;
      fail_at_byte(name_, kHeader + found * kFacet,
                   "no facet, but facets follow at byte " + std::to_string(kHeader + t * kFacet) + ", beyond the " +
                       std::to_string(promised_) + " that the header counts; export the file again");
    }
    if (found == 0)
      fail_at_byte(name_, kCountAt,
                   "promises no triangles, and the " + std::to_string(bytes_.size() - kHeader) +
                       " bytes that follow hold none; export the file again");
    if (found > promised_) report_.facets_promised = promised_, report_.facets_found = found;
    report_.bytes_left_out = bytes_.size() - kHeader - found * kFacet;
  }

  Corner corner(std::size_t facet, std::size_t i) const { return three_floats(bytes_, facet + kCorners + 12 * i); }

  // Whether the bytes at a place look like a facet: its three corners differ, and either its normal is theirs or one of
  // its corners is a corner of another facet. `all`: the corners of all places, this one included.
  bool is_facet(std::size_t at, const std::vector<Corner>& all) const {
    const std::array<Corner, 3> corners{corner(at, 0), corner(at, 1), corner(at, 2)};
    bool shared = false;
    for (const Corner& c : corners) {
      if (!(vector_of(c).cwiseAbs().maxCoeff() <= kMaxCoordinate)) return false;
      const auto [first, last] = std::equal_range(all.begin(), all.end(), c);
      shared |= last - first > 1;
    }
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return false;
    if (shared) return true;
    const Vector normal = vector_of(three_floats(bytes_, at)),
                 own = (vector_of(corners[1]) - vector_of(corners[0]))
                           .cross(vector_of(corners[2]) - vector_of(corners[0]));
    return std::abs(normal.norm() - 1) <= kUnitLength && normal.dot(own) >= kSameNormal * own.norm();
  }

  // A plain file of the facets without attributes, with a header that no reader can mistake for text.
  std::string plain() const {
    std::string result(kCountAt, '-');
    for (std::size_t byte = 0; byte < 4; ++byte) result += static_cast<char>(at_.size() >> 8 * byte & 0xff);
    for (const std::size_t at : at_) {
      for (std::size_t i = 0; i < 9; ++i) {
        const std::size_t place = at + kCorners + 4 * i;
        if (!std::isfinite(std::bit_cast<float>(static_cast<std::uint32_t>(integer_at(bytes_, place, 4)))))
          fail_at_byte(name_, place, "a coordinate that is not a finite number");
      }
      result.append(bytes_.substr(at, kAttributes));
      result.append(2, '\0');
    }
    return result;
  }

  std::string_view bytes_;
  const std::string& name_;
  MeshReadReport& report_;
  std::uint64_t promised_;
  std::vector<std::size_t> at_;  // where the facets are
};

// Whether a file is an STL file in text, which begins with "solid". Many binary files begin so, too: those are known by
// a length that agrees with their count, or by a zero byte in the header, the count or the first facet, since text
// holds no zero byte.
bool is_text(std::string_view bytes) {
  const bool marked = bytes.starts_with("\xef\xbb\xbf");
  const std::size_t first = bytes.find_first_not_of(" \t\v\f\r\n", marked ? 3 : 0);
  if (first == std::string_view::npos) return false;
  std::string word(bytes.substr(first, 5));
  for (char& c : word) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  const bool whole_word = first + 5 >= bytes.size() || is_blank(bytes[first + 5]) || is_line_end(bytes[first + 5]);
  if (word != "solid" || !whole_word) return false;
  if (bytes.size() >= kHeader && bytes.size() == kHeader + integer_at(bytes, kCountAt, 4) * kFacet) return false;
  return bytes.substr(0, kHeader + kFacet).find('\0') == std::string_view::npos;
}

}  // namespace

std::string checked_binary_stl(std::string_view bytes, const std::string& name, MeshReadReport& report) {
  return BinaryStl(bytes, name, report).run();
}

std::string checked_stl(std::string_view bytes, const std::string& name, MeshReadReport& report) {
  if (is_text(bytes)) return checked_ascii_stl(bytes, name, report);
  if (bytes.size() < kHeader)
    throw InputError(
        name +
        ": the file begins neither with \"solid\" nor with the 84 bytes of a binary STL file; this is not an STL file");
  return checked_binary_stl(bytes, name, report);
}

}  // namespace orchard
