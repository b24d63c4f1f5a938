#include "xml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <string_view>
#include <utility>

#include "input_file.h"
#include "orchard/geometry/error.h"

namespace orchard::apps {
namespace {

constexpr int kMaxDepth = 200;

bool is_name_part(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == ':' || c == '.' ||
         static_cast<unsigned char>(c) >= 128;
}

class XmlReader {
 public:
  XmlReader(std::string file, std::string text) : file_(std::move(file)), text_(std::move(text)) {}

  XmlElement root() {
    skip_to_element();
    if (!begins("<")) fail("holds no element");
    return element(0);
  }

 private:
  [[noreturn]] void fail(const std::string& fault) const {
    throw InputError(fmt::format("{}, line {}: {}; is it XML?", file_, line_, fault));
  }

  bool begins(std::string_view what) const { return text_.compare(at_, what.size(), what) == 0; }
  bool at_end() const { return at_ >= text_.size(); }

  void advance(std::size_t to) {
    to = std::min(to, text_.size());
    line_ += static_cast<std::size_t>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_),
                                                 text_.begin() + static_cast<std::ptrdiff_t>(to), '\n'));
    at_ = to;
  }

  void skip_blanks() {
    std::size_t to = at_;
    while (to < text_.size() && std::isspace(static_cast<unsigned char>(text_[to])) != 0) ++to;
    advance(to);
  }

  void skip_past(std::string_view end, const char* what) {
    const std::size_t found = text_.find(end, at_);
    if (found == std::string::npos) fail(fmt::format("{} has no end", what));
    advance(found + end.size());
  }

  // Text, comments, declarations and instructions.
  void skip_to_element() {
    while (!at_end()) {
      advance(std::min(text_.find('<', at_), text_.size()));
      if (begins("<!--"))
        skip_past("-->", "a comment");
      else if (begins("<![CDATA["))
        skip_past("]]>", "a section of text");
      else if (begins("<?"))
        skip_past("?>", "an instruction");
      else if (begins("<!"))
        skip_past(">", "a declaration");
      else
        return;
    }
  }

  std::string name(const char* what) {
    std::size_t to = at_;
    while (to < text_.size() && is_name_part(text_[to])) ++to;
    if (to == at_) fail(fmt::format("{} has no name", what));
    std::string found = text_.substr(at_, to - at_);
    advance(to);
    return found;
  }

  std::string decoded(std::string_view text) const {
    static const std::map<std::string_view, char> entities{
        {"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}};
    std::string result;
    while (!text.empty()) {
      const std::size_t entity = text.find('&'), end = text.find(';', entity);
      result += text.substr(0, entity);
      if (entity == std::string_view::npos) return result;
      if (end == std::string_view::npos) fail("an & begins nothing that is known");
      const std::string_view what = text.substr(entity + 1, end - entity - 1);
      if (const auto found = entities.find(what); found != entities.end())
        result += found->second;
      else
        result += numbered(what);
      text.remove_prefix(end + 1);
    }
    return result;
  }

  char numbered(std::string_view what) const {
    const bool hexadecimal = what.starts_with("#x");
    int code = 0;
    const char* const begin = what.data() + (hexadecimal ? 2 : 1);
    const char* const end = what.data() + what.size();
    if (what.size() < 2 || what[0] != '#') fail(fmt::format("&{}; is not known", what));
    const auto [next, error] = std::from_chars(begin, end, code, hexadecimal ? 16 : 10);
    if (error != std::errc() || next != end || code <= 0 || code >= 128) fail(fmt::format("&{}; is not known", what));
    return static_cast<char>(code);
  }

  void read_attribute(XmlElement& element) {
    std::string key = name("an attribute");
    skip_blanks();
    if (!begins("=")) fail(fmt::format("the attribute {} has no value", key));
    advance(at_ + 1);
    skip_blanks();
    const char quote = at_end() ? '\0' : text_[at_];
    if (quote != '"' && quote != '\'') fail(fmt::format("the attribute {} has no value in quotes", key));
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == std::string::npos) fail(fmt::format("the value of {} has no end", key));
    element.attributes[key] = decoded(std::string_view(text_).substr(at_ + 1, end - at_ - 1));
    advance(end + 1);
  }

  // Precondition: a '<' that begins an element.
  XmlElement element(int depth) {
    if (depth > kMaxDepth) fail(fmt::format("elements are nested more than {} deep", kMaxDepth));
    XmlElement result;
    result.line = line_;
    advance(at_ + 1);
    result.name = name("an element");
    for (skip_blanks(); !begins(">") && !begins("/>"); skip_blanks()) {
      if (at_end()) fail(fmt::format("<{}> has no end", result.name));
      read_attribute(result);
    }
    const bool is_empty = begins("/>");
    advance(at_ + (is_empty ? 2 : 1));
    if (!is_empty) read_children(result, depth);
    return result;
  }

  void read_children(XmlElement& parent, int depth) {
    for (skip_to_element(); !begins("</"); skip_to_element()) {
      if (at_end()) fail(fmt::format("<{}> of line {} has no end", parent.name, parent.line));
      parent.children.push_back(element(depth + 1));
    }
    advance(at_ + 2);
    const std::string closed = name("an end of an element");
    if (closed != parent.name) fail(fmt::format("</{}> ends the <{}> of line {}", closed, parent.name, parent.line));
    skip_blanks();
    if (!begins(">")) fail(fmt::format("</{} has no end", closed));
    advance(at_ + 1);
  }

  std::string file_, text_;
  std::size_t at_ = 0, line_ = 1;
};

}  // namespace

const XmlElement* XmlElement::child(const std::string& child_name) const {
  const auto found = std::find_if(children.begin(), children.end(),
                                  [&](const XmlElement& element) { return element.name == child_name; });
  return found == children.end() ? nullptr : &*found;
}

const std::string* XmlElement::attribute(const std::string& attribute_name) const {
  const auto found = attributes.find(attribute_name);
  return found == attributes.end() ? nullptr : &found->second;
}

XmlElement read_xml(const std::filesystem::path& file) { return XmlReader(file.string(), content_of(file)).root(); }

}  // namespace orchard::apps
