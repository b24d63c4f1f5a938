#include "ply_header.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "text_scan.h"

namespace orchard {
namespace {

constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypeNames{{
    {"char", PlyType::int8},
    {"uchar", PlyType::uint8},
    {"short", PlyType::int16},
    {"ushort", PlyType::uint16},
    {"int", PlyType::int32},
    {"uint", PlyType::uint32},
    {"float", PlyType::float32},
    {"double", PlyType::float64},
    {"int8", PlyType::int8},
    {"uint8", PlyType::uint8},
    {"int16", PlyType::int16},
    {"uint16", PlyType::uint16},
    {"int32", PlyType::int32},
    {"uint32", PlyType::uint32},
    {"float32", PlyType::float32},
    {"float64", PlyType::float64},
}};

class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  PlyHeader read() {
    if (next_line() != "ply") {
      throw InputError(name_ + ": the file does not begin with \"ply\"; this is not a PLY file");
    }
    bool format_seen = false;
    while (true) {
      const std::vector<std::string_view> words = split(next_line());
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format") {
        read_format(words);
        format_seen = true;
      } else if (words[0] == "element") {
        read_element(words);
      } else if (words[0] == "property") {
        read_property(words);
      } else {
        fail("unknown keyword " + in_quotes(words[0]) + " in the PLY header");
      }
    }
    if (!format_seen) fail("the PLY header has no \"format\" line");
    header_.body = at_;
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& fault) const { fail_at_line(name_, bytes_, line_at_, fault); }

  // Returns the next line without its end, and moves at_ past it.
  std::string_view next_line() {
    line_at_ = at_;
    const std::size_t stop = bytes_.find_first_of("\r\n", at_);
    if (stop == std::string_view::npos) {
      fail(at_ == 0 ? "this is not a PLY file" : "the PLY header ends without \"end_header\"");
    }
    at_ = stop + 1;
    // If lines end with a single \r, a \n after the header is the first byte of the body.
    if (line_at_ == 0) lone_returns_ = bytes_[stop] == '\r' && !(at_ < bytes_.size() && bytes_[at_] == '\n');
    if (!lone_returns_ && bytes_[stop] == '\r' && at_ < bytes_.size() && bytes_[at_] == '\n') ++at_;
    return bytes_.substr(line_at_, stop - line_at_);
  }

  static std::vector<std::string_view> split(std::string_view line) {
    std::vector<std::string_view> words;
    while (true) {
      line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
      if (line.empty()) return words;
      words.push_back(line.substr(0, line.find_first_of(" \t")));
      line.remove_prefix(words.back().size());
    }
  }

  void read_format(const std::vector<std::string_view>& words) {
    const std::string_view encoding = words.size() == 3 && words[2] == "1.0" ? words[1] : std::string_view();
    if (encoding == "ascii") {
      header_.encoding = PlyEncoding::ascii;
    } else if (encoding == "binary_little_endian") {
      header_.encoding = PlyEncoding::little_endian;
    } else if (encoding == "binary_big_endian") {
      header_.encoding = PlyEncoding::big_endian;
    } else {
      fail("expected \"format\", then ascii, binary_little_endian or binary_big_endian, then 1.0");
    }
  }

  void read_element(const std::vector<std::string_view>& words) {
    PlyElement element;
    element.at = line_at_;
    if (words.size() != 3) fail("expected \"element\", a name and a number of rows");
    element.name = words[1];
    const auto [stop, error] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.rows);
    if (error != std::errc() || stop != words[2].data() + words[2].size()) {
      fail(in_quotes(words[2]) + " is not a number of rows");
    }
    if (!names_.insert(words[1]).second) fail("element " + in_quotes(words[1]) + " is declared twice");
    header_.elements.push_back(std::move(element));
  }

  PlyType read_type(std::string_view name) const {
    for (const auto& [type_name, type] : kTypeNames) {
      if (type_name == name) return type;
    }
    fail("unknown property type " + in_quotes(name));
  }

  void read_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) fail("a property comes before the first element");
    PlyProperty property;
    if (words.size() == 5 && words[1] == "list") {
      property.length_type = read_type(words[2]);
      property.type = read_type(words[3]);
    } else if (words.size() == 3) {
      property.type = read_type(words[1]);
    } else {
      fail("expected \"property\", a type and a name, or \"property list\", two types and a name");
    }
    property.name = words.back();
    header_.elements.back().properties.push_back(std::move(property));
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0, line_at_ = 0;
  bool lone_returns_ = false;
  std::set<std::string_view> names_;  // of elements
  PlyHeader header_;
};

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      return 8;
  }
  return 0;
}

std::optional<std::size_t> PlyElement::find(std::string_view property) const {
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (properties[i].name == property) return i;
  }
  return std::nullopt;
}

std::size_t PlyElement::min_row_bytes(PlyEncoding encoding) const {
  std::size_t bytes = 0;
  for (const PlyProperty& property : properties) {
    // in ASCII, a number takes a digit and a space, except for the last number of the file
    bytes += encoding == PlyEncoding::ascii ? 2 : size_of(property.length_type.value_or(property.type));
  }
  return bytes;
}

PlyHeader read_ply_header(std::string_view bytes, const std::string& name) { return HeaderReader(bytes, name).read(); }

}  // namespace orchard
