#pragma once
#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace orchard {

// How numbers are stored, as <VTKFile> says.
struct VtkEncoding {
  std::endian order = std::endian::little;
  bool wide_heads = false;   // the numbers before arrays have 64 bits
  bool compressed = false;   // by zlib
  bool base64 = true;        // whether appended data are in base64
  std::size_t appended = 0;  // the byte after the "_" of <AppendedData>; 0 if there is none
};

// A <DataArray>.
struct VtkArray {
  std::string_view type, format;
  std::size_t at = 0;                   // byte of the tag
  std::size_t begin = 0, end = 0;       // the bytes between the tags
  std::optional<std::uint64_t> offset;  // from the beginning of the appended data
};

// Reads the numbers of a file's arrays in any encoding. Throws InputError, which names the byte or line. The memory is
// bounded by the size of the file, or 1032 times that if it is compressed.
class VtkXmlData {
 public:
  VtkXmlData(std::string_view bytes, const std::string& name, const VtkEncoding& encoding)
      : bytes_(bytes), name_(name), encoding_(encoding) {}

  std::vector<double> reals(const VtkArray& array) const;
  std::vector<std::int64_t> integers(const VtkArray& array) const;

 private:
  template <typename Result>
  std::vector<Result> numbers(const VtkArray& array) const;
  template <typename Result>
  std::vector<Result> text_numbers(const VtkArray& array) const;
  std::string binary(const VtkArray& array) const;

  std::string_view bytes_;
  const std::string& name_;
  const VtkEncoding& encoding_;
};

}  // namespace orchard
