#include "vtk_xml_data.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "mixed_scanner.h"

namespace orchard {
namespace {

constexpr std::uint64_t kZlibRatio = 1032;  // the largest factor by which zlib can compress

// Bytes in a file, either plain or in base64. Several base64 streams may follow each other, each with its own padding.
class ByteSource {
 public:
  ByteSource(std::string_view bytes, std::size_t begin, std::size_t end, bool base64, const std::string& name)
      : bytes_(bytes.substr(0, end)), at_(begin), base64_(base64), name_(name) {}

  std::size_t position() const { return at_; }
  std::uint64_t room() const {
    const std::uint64_t left = bytes_.size() - std::min(at_, bytes_.size());
    return base64_ ? kept_.size() + left / 4 * 3 : left;
  }
  [[noreturn]] void fail(const std::string& fault) const { fail_at_byte(name_, at_, fault); }

  std::string take(std::uint64_t count) {
    if (count > room()) fail("the data end early: " + std::to_string(count) + " bytes are promised");
    std::string result;
    if (!base64_) {
      result = bytes_.substr(at_, count);
      at_ += count;
      return result;
    }
    result.reserve(count + 3);
    result.swap(kept_);
    while (result.size() < count) decode_four(result);
    kept_ = result.substr(count);
    result.resize(count);
    return result;
  }

 private:
  static int digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : c == '=' ? 64 : -1;
  }
  void decode_four(std::string& out) {
    std::uint32_t bits = 0;
    int digits = 0, padding = 0;
    while (digits + padding < 4) {
      while (at_ < bytes_.size() && (is_blank(bytes_[at_]) || is_line_end(bytes_[at_]))) ++at_;
      if (at_ >= bytes_.size()) fail("the data end early; the file may be cut off");
      const int value = digit(bytes_[at_]);
      if (value < 0 || (value == 64 && digits < 2) || (value < 64 && padding > 0)) fail("the data are not base64");
      bits = bits << 6 | static_cast<std::uint32_t>(value & 63);
      value == 64 ? ++padding : ++digits;
      ++at_;
    }
    for (int i = 0; i < 3 - padding; ++i) out.push_back(static_cast<char>(bits >> (16 - 8 * i) & 255));
  }

  std::string_view bytes_;
  std::size_t at_;
  bool base64_;
  const std::string& name_;
  std::string kept_;  // decoded bytes that have not been read yet
};

class BlockReader {
 public:
  BlockReader(ByteSource source, const VtkEncoding& encoding) : source_(std::move(source)), encoding_(encoding) {}

  std::string read() {
    const std::uint64_t first = head();
    if (!encoding_.compressed) return source_.take(first);
    if (first == 0) return {};
    const std::uint64_t size = head(), last = head();
    if (first > source_.room() / 4)
      source_.fail(std::to_string(first) + " blocks do not fit into the data; the file is damaged");
    std::vector<std::uint64_t> packed(first);
    for (std::uint64_t& bytes : packed) bytes = head();
    std::string result;
    for (std::size_t i = 0; i < packed.size(); ++i)
      inflate_block(packed[i], i + 1 == packed.size() && last > 0 ? last : size, result);
    return result;
  }

 private:
  std::uint64_t head() {
    const bool swap = encoding_.order != std::endian::native;
    if (encoding_.wide_heads) return MixedScanner::value_at<std::uint64_t>(source_.take(8).data(), swap);
    return MixedScanner::value_at<std::uint32_t>(source_.take(4).data(), swap);
  }
  void inflate_block(std::uint64_t packed, std::uint64_t size, std::string& out) {
    const std::string bytes = source_.take(packed);
    if (size / kZlibRatio > packed)
      source_.fail("a block of " + std::to_string(packed) + " bytes that would be " + std::to_string(size) +
                   " decompressed");
    const std::size_t before = out.size();
    out.resize(before + size);
    uLongf length = size;
    const int result = uncompress(reinterpret_cast<Bytef*>(out.data() + before), &length,
                                  reinterpret_cast<const Bytef*>(bytes.data()), packed);
    if (result != Z_OK || length != size) source_.fail("zlib cannot decompress a block; the file is damaged");
  }

  ByteSource source_;
  const VtkEncoding& encoding_;
};

// A type of numbers, and the function that reads one.
template <typename Result>
struct VtkNumber {
  std::string_view name;
  std::size_t bytes;
  Result (*read)(const char*, bool);
};
template <typename Result, typename T>
constexpr VtkNumber<Result> vtk_number(std::string_view name) {
  return {name, sizeof(T),
          [](const char* data, bool swap) { return static_cast<Result>(MixedScanner::value_at<T>(data, swap)); }};
}
template <typename Result>
const VtkNumber<Result>* vtk_number_named(std::string_view name) {
  static const std::array kIntegers{
      vtk_number<Result, std::int8_t>("Int8"),   vtk_number<Result, std::uint8_t>("UInt8"),
      vtk_number<Result, std::int16_t>("Int16"), vtk_number<Result, std::uint16_t>("UInt16"),
      vtk_number<Result, std::int32_t>("Int32"), vtk_number<Result, std::uint32_t>("UInt32"),
      vtk_number<Result, std::int64_t>("Int64"), vtk_number<Result, std::uint64_t>("UInt64")};
  static const std::array kReals{vtk_number<double, float>("Float32"), vtk_number<double, double>("Float64")};
  for (const VtkNumber<Result>& number : kIntegers)
    if (number.name == name) return &number;
  if constexpr (std::is_same_v<Result, double>) {
    for (const VtkNumber<double>& number : kReals)
      if (number.name == name) return &number;
  }
  return nullptr;
}

}  // namespace

std::string VtkXmlData::binary(const VtkArray& array) const {
  if (array.format != "appended") return BlockReader({bytes_, array.begin, array.end, true, name_}, encoding_).read();
  if (encoding_.appended == 0)
    fail_at_line(name_, bytes_, array.at, "an appended array, but there is no <AppendedData>");
  if (!array.offset || *array.offset > bytes_.size() - encoding_.appended)
    fail_at_line(name_, bytes_, array.at, "an appended array whose offset is missing or behind the end of the file");
  return BlockReader({bytes_, encoding_.appended + *array.offset, bytes_.size(), encoding_.base64, name_}, encoding_)
      .read();
}

template <typename Result>
std::vector<Result> VtkXmlData::text_numbers(const VtkArray& array) const {
  MixedScanner in(bytes_.substr(0, array.end), name_);
  in.move_to(array.begin);
  std::vector<Result> result;
  while (in.more()) {
    if constexpr (std::is_same_v<Result, double>) {
      result.push_back(in.number());
    } else {
      result.push_back(in.integer());
    }
  }
  return result;
}

template <typename Result>
std::vector<Result> VtkXmlData::numbers(const VtkArray& array) const {
  const VtkNumber<Result>* type = vtk_number_named<Result>(array.type);
  if (type == nullptr)
    fail_at_line(name_, bytes_, array.at, "an array of numbers of the type " + in_quotes(array.type));
  if (array.format == "ascii") return text_numbers<Result>(array);
  if (array.format != "binary" && array.format != "appended")
    fail_at_line(name_, bytes_, array.at, "an array in the format " + in_quotes(array.format));
  const std::string data = binary(array);
  std::vector<Result> result(data.size() / type->bytes);
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = type->read(data.data() + i * type->bytes, encoding_.order != std::endian::native);
  return result;
}

std::vector<double> VtkXmlData::reals(const VtkArray& array) const { return numbers<double>(array); }
std::vector<std::int64_t> VtkXmlData::integers(const VtkArray& array) const { return numbers<std::int64_t>(array); }

}  // namespace orchard
