#include "output/stamp.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "input/input_file.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/xml_escaped.h"
#include "output/array_descriptions.h"

namespace orchard::apps {
namespace {

constexpr std::string_view kPngBegin = "\x89PNG\r\n\x1a\n";
constexpr std::size_t kPngHeaderEnd = 33;  // the signature, and the chunk that is always the first one

// Behind the first `mark`, if there is one.
std::string inserted_behind(std::string bytes, std::string_view mark, const std::string& text) {
  const std::size_t at = bytes.find(mark);
  return at == std::string::npos ? bytes : bytes.insert(at + mark.size(), text);
}

std::string with_last_line(std::string bytes, const std::string& line) {
  if (!bytes.empty() && bytes.back() != '\n') bytes += '\n';
  return bytes.append("# ").append(line).append("\n");
}

std::string with_ply_comment(std::string bytes, const std::string& line) {
  const std::string comment = "comment " + line + "\n";
  const bool binary = bytes.starts_with("ply\nformat binary_little_endian 1.0\n");
  return inserted_behind(std::move(bytes), binary ? "format binary_little_endian 1.0\n" : "format ascii 1.0\n",
                         comment);
}

// An array of texts as VTK writes it: the numbers of their characters, each text with a zero behind it.
std::string text_array(const char* name, const std::vector<std::string>& texts) {
  std::string array = std::string("<Array type=\"String\" Name=\"") + name + "\" NumberOfTuples=\"" +
                      std::to_string(texts.size()) + "\" format=\"ascii\">\n";
  for (const std::string& text : texts) {
    for (const char c : text) array += std::to_string(static_cast<unsigned char>(c)) + ' ';
    array += "0\n";
  }
  return array + "</Array>\n";
}

std::string with_field_data(std::string bytes, const std::string& line) {
  std::string array = text_array("provenance", {line});
  if (const std::vector<std::string> lines = descriptions_in(bytes); !lines.empty())
    array += text_array("descriptions", lines);
  if (bytes.find("<FieldData>") != std::string::npos) return inserted_behind(std::move(bytes), "<FieldData>\n", array);
  for (const char* const kind : {"<PolyData>\n", "<UnstructuredGrid>\n"})
    if (bytes.find(kind) != std::string::npos)
      return inserted_behind(std::move(bytes), kind, "<FieldData>\n" + array + "</FieldData>\n");
  return bytes;
}

// A comment before the last lines, which say where the table of objects is: nothing that has a place in it moves.
std::string with_pdf_comment(std::string bytes, const std::string& line) {
  const std::size_t at = bytes.rfind("startxref\n");
  return at == std::string::npos ? bytes : bytes.insert(at, "% " + line + "\n");
}

// As PNG's specification has it: CRC-32.
std::uint32_t png_checksum(std::string_view bytes) {
  std::uint32_t sum = 0xffffffffu;
  for (const char c : bytes) {
    sum ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ ((sum & 1u) != 0 ? 0xedb88320u : 0u);
  }
  return ~sum;
}

std::string big_endian(std::uint32_t number) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 0xffu);
  return bytes;
}

std::string with_png_text(std::string bytes, const std::string& line) {
  if (!bytes.starts_with(kPngBegin) || bytes.size() < kPngHeaderEnd) return bytes;
  const std::string data = "Comment" + std::string(1, '\0') + line, chunk = "tEXt" + data;
  return bytes.insert(kPngHeaderEnd,
                      big_endian(static_cast<std::uint32_t>(data.size())) + chunk + big_endian(png_checksum(chunk)));
}

// Behind the declaration, which must come first.
std::string with_instruction(std::string bytes, const std::string& line) {
  const std::string instruction = "<?" + line + "?>\n";
  if (!bytes.starts_with("<?xml")) return instruction + bytes;
  return inserted_behind(std::move(bytes), "?>\n", instruction);
}

std::string with_metadata(std::string bytes, const std::string& line) {
  const std::size_t root = bytes.find("<svg");
  const std::size_t end = root == std::string::npos ? root : bytes.find('>', root);
  if (end == std::string::npos) return bytes;
  return bytes.insert(end + 1, "\n<metadata>" + xml_escaped(line) + "</metadata>");
}

using Place = std::string (*)(std::string, const std::string&);

Place place_of(const std::string& extension) {
  static constexpr std::array<std::pair<std::string_view, Place>, 16> kPlaces{{{".ma", with_last_line},
                                                                               {".vor", with_last_line},
                                                                               {".csv", with_last_line},
                                                                               {".obj", with_last_line},
                                                                               {".py", with_last_line},
                                                                               {".vtp", with_field_data},
                                                                               {".vtu", with_field_data},
                                                                               {".vtm", with_instruction},
                                                                               {".pvd", with_instruction},
                                                                               {".pvsm", with_instruction},
                                                                               {".graphml", with_instruction},
                                                                               {".urdf", with_instruction},
                                                                               {".svg", with_metadata},
                                                                               {".pdf", with_pdf_comment},
                                                                               {".png", with_png_text},
                                                                               {".ply", with_ply_comment}}};
  for (const auto& [name, place] : kPlaces)
    if (name == extension) return place;
  return nullptr;
}

}  // namespace

std::string stamped(std::string bytes, const std::filesystem::path& name, const std::string& line) {
  const Place place = place_of(lower_extension(name));
  return place == nullptr ? bytes : place(std::move(bytes), line);
}

void stamp(const std::filesystem::path& file, const std::string& line) {
  const std::string bytes = content_of(file), with_line = stamped(bytes, file, line);
  if (with_line != bytes) write_file(file, with_line);
}

}  // namespace orchard::apps
