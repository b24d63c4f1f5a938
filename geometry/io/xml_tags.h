#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace orchard {

// Reads the tags of an XML text one after another, with their places. It is made for formats that contain data, and
// binary data after a tag, where a parser of whole documents would fail.
class XmlTags {
 public:
  struct Tag {
    std::string_view name;               // "Piece" for <Piece> and for </Piece>
    bool opens = false, closes = false;  // <A> opens, </A> closes, and <A/> does both
    std::size_t at = 0, end = 0;         // the byte of "<" and the one after ">"
    std::vector<std::pair<std::string_view, std::string_view>> attributes;

    // Returns the value of an attribute, or `otherwise` if there is none.
    std::string_view value(std::string_view attribute, std::string_view otherwise = {}) const;
  };

  XmlTags(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  // Moves to the next tag, past comments and declarations. Returns false at the end of the file. Throws InputError,
  // which names the line, if a tag is broken.
  bool next();
  const Tag& tag() const { return tag_; }

 private:
  [[noreturn]] void fail(std::size_t at, const std::string& fault) const;
  void skip_to(std::string_view end, std::size_t start);
  void read_attributes();
  void skip_blanks();

  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
  Tag tag_;
};

}  // namespace orchard
