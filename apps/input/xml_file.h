#pragma once
#include <tinyxml2.h>

#include <filesystem>
#include <string>
#include <vector>

// XML as robots' files are written in it, read so that every fault has a line.
namespace orchard::apps {

// "FILE, line 12", for the beginning of a message.
std::string at_line(const std::filesystem::path& file, const tinyxml2::XMLElement& element);

// Parses a file into `document` and returns its root. Throws InputError, with the line, if the file cannot be opened or
// is no well-formed XML, or if the root is not <`root`>; `what` is the format's name for that message.
const tinyxml2::XMLElement& parse_xml(const std::filesystem::path& file, tinyxml2::XMLDocument& document,
                                      const char* root, const char* what);

// Numbers parted by blanks, `count` of them. Numbers that are not finite are returned as they are. Throws InputError,
// which begins with `where` and calls the text `what`, if there are more or fewer, or anything else.
std::vector<double> numbers_in(const std::string& text, std::size_t count, const std::string& where, const char* what);

// The children of that name, in order.
std::vector<const tinyxml2::XMLElement*> children_of(const tinyxml2::XMLElement& parent, const char* name);

}  // namespace orchard::apps
