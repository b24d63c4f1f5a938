#pragma once
#include <string>

// Escapes text for XML and HTML; this header uses the standard library only.
namespace orchard {

// Returns the text with the characters replaced that must not occur between tags or within double quotes.
inline std::string xml_escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

}  // namespace orchard
