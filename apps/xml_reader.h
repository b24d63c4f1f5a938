#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace orchard::apps {

// An element of an XML file, with what is in it but for text between elements.
struct XmlElement {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::vector<XmlElement> children;
  std::size_t line = 0;  // of its first character, from 1

  // The first child of that name, or nullptr.
  const XmlElement* child(const std::string& child_name) const;
  // An attribute's text, or nullptr.
  const std::string* attribute(const std::string& attribute_name) const;
};

// The root element of a file. Comments, declarations and text are skipped; the five entities of XML and numbered
// characters below 128 are replaced in attributes. Throws InputError naming file and line where the file is no
// well-formed XML as far as elements and attributes go, or is nested more than 200 elements deep.
XmlElement read_xml(const std::filesystem::path& file);

}  // namespace orchard::apps
