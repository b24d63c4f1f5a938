#pragma once
#include <filesystem>
#include <string>

// A line of text inside files of many formats. `line` is one line of ASCII characters that begins with a word, without
// "?>".
namespace orchard::apps {

// The bytes of a file with the line in the place that its format has for such things:
//   .ma .vor .csv .obj .py        a last line, "# " + line; readers that know no comments have read everything by then
//   .ply                          a comment of the header
//   .vtp .vtu                     field data, the text array "provenance"; with it comes the text array "descriptions",
//                                 a line for each array of the file (array_descriptions.h)
//   .vtm .pvd .pvsm .graphml .urdf  a processing instruction behind the declaration, "<?" + line + "?>"
//   .svg                          the element "metadata"
//   .pdf                          a comment before the last lines
//   .png                          a text chunk, "Comment"
// Other formats, and bytes that are not of the format, come back as they are.
std::string stamped(std::string bytes, const std::filesystem::path& name, const std::string& line);

// The same with a file in its place. Throws Error if it cannot be replaced.
void stamp(const std::filesystem::path& file, const std::string& line);

}  // namespace orchard::apps
