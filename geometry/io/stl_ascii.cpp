#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "line_scanner.h"
#include "orchard/geometry/error.h"
#include "soup_guards.h"

namespace orchard {
namespace {

std::string lower_case(std::string_view word) {
  std::string result(word);
  for (char& c : result) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return result;
}

constexpr std::array<std::string_view, 10> kKeywords{"solid",  "facet",   "normal",   "outer",    "loop",
                                                     "vertex", "endloop", "endfacet", "endsolid", "end"};

bool may_be_number(std::string_view word) {
  return word.find_first_of("+-.0123456789") == 0 || word.starts_with("nan") || word.starts_with("inf");
}

// Returns one solid of nothing but keywords and numbers: CGAL takes keywords for what they are wherever they turn up,
// in the name of a solid as well.
class AsciiStl {
 public:
  AsciiStl(std::string_view bytes, const std::string& name, MeshReadReport& report)
      : bytes_(bytes),
        name_(name),
        report_(report),
        words_(bytes, bytes.starts_with("\xef\xbb\xbf") ? 3 : 0, 0, name) {}

  std::string run() {
    bool ended = false;
    for (std::string word = keyword(); !word.empty(); word = keyword()) {
      ended = word == "endsolid";
      if (word == "solid" || word == "endsolid") {
        skip_name();
      } else if (word == "facet") {
        read_facet();
      } else {
        fail_to_find("facet", word);
      }
    }
    if (!ended) throw InputError(name_ + ": the file ends without \"endsolid\"; it may be cut off");
    return result_ += "endsolid\n";
  }

 private:
  [[noreturn]] void fail_to_find(const std::string& wanted, const std::string& found) const {
    if (found.empty()) throw InputError(name_ + ": the file ends within a facet; it may be cut off");
    words_.fail("expected \"" + wanted + "\" instead of " + in_quotes(found) + " (the facets of STL are triangles)");
  }

  // Whether a word follows, on this line or a later one.
  bool more() {
    if (words_.more_on_line()) return true;
    if (!words_.next()) return false;
    first_of_line_ = words_.rest_of_line().data();
    return true;
  }
  // The next word, in lower case, but for the rest of a line that is no keyword; empty at the end of the file. It is
  // not passed.
  std::string next() {
    for (; more(); words_.word()) {
      std::string word = lower_case(words_.peek());
      if (words_.rest_of_line().data() == first_of_line_ || std::ranges::count(kKeywords, word) > 0) return word;
    }
    return {};
  }
  // Passes the next word, and the second one of "end loop" and the like.
  std::string keyword() {
    std::string word = next();
    if (word.empty()) return word;
    words_.word();
    if (word != "end") return word;
    const std::string what = next();
    if (what.empty()) return word;
    words_.word();
    return word + what;
  }
  void expect(const std::string& wanted) {
    const std::string found = keyword();
    if (found != wanted) fail_to_find(wanted, found);
  }

  // To the end of the line, or to a facet on it.
  void skip_name() {
    while (words_.more_on_line()) {
      const std::string rest = lower_case(words_.rest_of_line());
      const std::size_t next_word = rest.starts_with("facet") ? rest.find_first_not_of(" \t", 5) : std::string::npos;
      if (next_word != std::string::npos && next_word > 5 && rest.substr(next_word).starts_with("normal")) return;
      words_.word();
    }
  }

  void read_facet() {
    const std::size_t start = words_.start();
    if (next() == "normal") words_.word();
    // The normal's numbers, which are not looked at: of a facet without area they may be no numbers.
    for (int i = 0; i < 3 && more() && may_be_number(lower_case(words_.peek())); ++i) words_.word();
    expect("outer");
    if (next() == "loop") words_.word();
    std::string corners;
    int count = 0;
    for (; count < 3 && next() == "vertex"; ++count) {
      words_.word();
      append_point(corners += "vertex", read_point());
    }
    expect("endloop");
    expect("endfacet");
    if (count == 3) {
      result_ += "facet\nouter\n" + corners + "endloop\nendfacet\n";
    } else if (report_.faces_skipped.count++ == 0) {
      report_.faces_skipped.first = line_place(bytes_, start);
    }
  }

  std::array<double, 3> read_point() {
    const std::size_t start = words_.start();
    std::array<double, 3> point;
    for (double& coordinate : point) {
      const std::optional<double> value = more() ? words_.number() : std::nullopt;
      if (!value) fail_at_line(name_, bytes_, start, "vertex needs three finite numbers");
      coordinate = *value;
    }
    return point;
  }

  std::string_view bytes_;
  const std::string& name_;
  MeshReadReport& report_;
  LineScanner words_;
  const char* first_of_line_ = nullptr;  // its first word
  std::string result_ = "solid\n";
};

}  // namespace

std::string checked_ascii_stl(std::string_view bytes, const std::string& name, MeshReadReport& report) {
  return AsciiStl(bytes, name, report).run();
}

}  // namespace orchard
