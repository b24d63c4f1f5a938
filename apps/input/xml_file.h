#pragma once
#include <tinyxml2.h>

#include <filesystem>
#include <string>
#include <vector>

// Reads XML, the language of robots' files, so that messages can name a line.
namespace orchard::apps {

// Returns "FILE, line 12" for the beginning of a message.
std::string at_line(const std::filesystem::path& file, const tinyxml2::XMLElement& element);

// Parses a file into `document` and returns its root. Throws InputError, with the line, if the file cannot be opened or
// is no well-formed XML, or if the root is not <`root`>. `what` is the name of the format in the message.
const tinyxml2::XMLElement& parse_xml(const std::filesystem::path& file, tinyxml2::XMLDocument& document,
                                      const char* root, const char* what);

// Returns `count` numbers that are separated by blanks. They may be infinite or NaN. Throws InputError if there are
// more or fewer numbers, or anything else; the message begins with `where` and calls the text `what`.
std::vector<double> numbers_in(const std::string& text, std::size_t count, const std::string& where, const char* what);

// Returns the children with a name, in their order.
std::vector<const tinyxml2::XMLElement*> children_of(const tinyxml2::XMLElement& parent, const char* name);

}  // namespace orchard::apps
