#include "xml_tags.h"

#include <algorithm>

#include "text_scan.h"

namespace orchard {

std::string_view XmlTags::Tag::value(std::string_view attribute, std::string_view otherwise) const {
  for (const auto& [key, text] : attributes)
    if (key == attribute) return text;
  return otherwise;
}

void XmlTags::fail(std::size_t at, const std::string& fault) const { fail_at_line(name_, bytes_, at, fault); }

void XmlTags::skip_blanks() {
  while (at_ < bytes_.size() && (is_blank(bytes_[at_]) || is_line_end(bytes_[at_]))) ++at_;
}

void XmlTags::skip_to(std::string_view end, std::size_t start) {
  const std::size_t found = bytes_.find(end, at_);
  if (found == std::string_view::npos) fail(start, "the file ends within a tag; it may be cut off");
  at_ = found + end.size();
}

bool XmlTags::next() {
  while (true) {
    at_ = bytes_.find('<', at_);
    if (at_ == std::string_view::npos) {
      at_ = bytes_.size();
      return false;
    }
    const std::size_t start = at_;
    if (bytes_.substr(at_).starts_with("<!--")) {
      skip_to("-->", start);
    } else if (bytes_.substr(at_).starts_with("<?")) {
      skip_to("?>", start);
    } else if (bytes_.substr(at_).starts_with("<!")) {
      skip_to(">", start);
    } else {
      break;
    }
  }
  tag_ = {};
  tag_.at = at_++;
  tag_.opens = at_ >= bytes_.size() || bytes_[at_] != '/';
  tag_.closes = !tag_.opens;
  if (tag_.closes) ++at_;
  const std::size_t stop = std::min(bytes_.find_first_of(" \t\r\n/>", at_), bytes_.size());
  tag_.name = bytes_.substr(at_, stop - at_);
  at_ = stop;
  if (tag_.name.empty()) fail(tag_.at, "a tag has no name");
  read_attributes();
  return true;
}

void XmlTags::read_attributes() {
  while (true) {
    skip_blanks();
    if (at_ >= bytes_.size()) fail(tag_.at, "the file ends within a tag; it may be cut off");
    if (bytes_[at_] == '>') break;
    if (bytes_[at_] == '/') {
      tag_.closes = true;
      ++at_;
      continue;
    }
    const std::size_t start = at_, equals = bytes_.find('=', at_);
    if (equals == std::string_view::npos) fail(start, "an attribute has no value");
    const std::size_t quote = bytes_.find_first_not_of(" \t\r\n", equals + 1);
    if (quote == std::string_view::npos || (bytes_[quote] != '"' && bytes_[quote] != '\''))
      fail(start, "the value of an attribute is not in quotes");
    const std::size_t close = bytes_.find(bytes_[quote], quote + 1);
    if (close == std::string_view::npos) fail(start, "the quotes of an attribute do not close");
    std::string_view name = bytes_.substr(start, equals - start);
    name = name.substr(0, std::min(name.find_first_of(" \t\r\n"), name.size()));
    tag_.attributes.emplace_back(name, bytes_.substr(quote + 1, close - quote - 1));
    at_ = close + 1;
  }
  tag_.end = ++at_;
}

}  // namespace orchard
