#include "orchard/geometry/ply_tables.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "ply_body.h"
#include "ply_header.h"

namespace orchard {
namespace {

std::string bytes_of(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) throw InputError(file.string() + ": this is a folder; give a file");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string() + ": the file cannot be opened; check that it exists and its permissions");
  return std::string(std::istreambuf_iterator<char>(in), {});
}

template <class Body>
void read_property(Body& body, const PlyProperty& property, PlyTables::Column& column) {
  std::uint64_t count = 1;
  if (property.length_type) {
    const std::size_t start = body.position();
    const std::int64_t length = body.integer(*property.length_type);
    if (length < 0 || static_cast<std::uint64_t>(length) > body.remaining() / body.min_bytes(property.type)) {
      body.fail(start, "a list of " + std::to_string(length) + " items, which the rest of the file cannot hold");
    }
    count = static_cast<std::uint64_t>(length);
  }
  for (; count > 0; --count) column.numbers.push_back(body.number(property.type));
  if (property.length_type) column.ends.push_back(column.numbers.size());
}

template <class Body>
std::vector<PlyTables::Table> read_tables(const PlyHeader& header, Body body) {
  std::vector<PlyTables::Table> tables;
  for (const PlyElement& element : header.elements) {
    PlyTables::Table& table = tables.emplace_back();
    table.name = element.name;
    for (const PlyProperty& property : element.properties)
      table.columns.push_back({property.name, property.length_type.has_value(), {}, {}});
    // An element without properties takes no bytes, so any number of rows would seem to be in the file: they are
    // skipped.
    if (element.properties.empty()) continue;
    for (std::uint64_t row = 0; row < element.rows; ++row) {
      table.at.push_back(body.position());
      for (std::size_t i = 0; i < element.properties.size(); ++i)
        read_property(body, element.properties[i], table.columns[i]);
    }
  }
  return tables;
}

}  // namespace

const PlyTables::Column* PlyTables::Table::find(std::string_view column) const {
  const auto found =
      std::find_if(columns.begin(), columns.end(), [&](const Column& own) { return own.name == column; });
  return found == columns.end() ? nullptr : &*found;
}

PlyTables::PlyTables(const std::filesystem::path& file) : PlyTables(file.string(), bytes_of(file)) {}

PlyTables::PlyTables(std::string name, std::string bytes) : name_(std::move(name)), bytes_(std::move(bytes)) {
  const PlyHeader header = read_ply_header(bytes_, name_);
  ascii_ = header.encoding == PlyEncoding::ascii;
  if (ascii_) {
    tables_ = read_tables(header, AsciiBody(bytes_, header.body, name_));
  } else {
    const std::endian order = header.encoding == PlyEncoding::little_endian ? std::endian::little : std::endian::big;
    tables_ = read_tables(header, BinaryBody(bytes_, header.body, order, name_));
  }
}

const PlyTables::Table* PlyTables::find(std::string_view element) const {
  const auto at =
      std::find_if(tables_.begin(), tables_.end(), [&](const Table& table) { return table.name == element; });
  return at == tables_.end() ? nullptr : &*at;
}

void PlyTables::fail(const Table& table, std::size_t row, const std::string& fault) const {
  if (ascii_) fail_at_line(name_, bytes_, table.at[row], fault);
  fail_at_byte(name_, table.at[row], fault);
}

}  // namespace orchard
