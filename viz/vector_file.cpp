#include "vector_file.h"

#include <vtkNew.h>
#include <vtkZLibDataCompressor.h>

#include <array>
#include <cmath>
#include <cstdio>

namespace orchard::detail {
namespace {

// Numbers in an SVG file are hundredths of a point, so that they need no decimal point.
constexpr double kUnits = 100;

long rounded(double value) { return std::lround(kUnits * value); }

std::string hex_of(const Color& color) {
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", static_cast<unsigned>(std::lround(255 * color[0])),
                static_cast<unsigned>(std::lround(255 * color[1])), static_cast<unsigned>(std::lround(255 * color[2])));
  return text;
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  std::string number = text;
  while (number.back() == '0') number.pop_back();
  if (number.back() == '.') number.pop_back();
  return number == "-0" ? "0" : number;
}

// Calls visit for successive lines of the same look, which share an element.
template <class Visit>
void visit_looks(const std::vector<VectorLine>& lines, const Visit& visit) {
  for (std::size_t begin = 0; begin < lines.size();) {
    std::size_t end = begin;
    while (end < lines.size() && lines[end].color == lines[begin].color && lines[end].width == lines[begin].width)
      ++end;
    visit(begin, end);
    begin = end;
  }
}

void append_path(const VectorLine& line, std::string& path) {
  long x = rounded(line.places[0]), y = rounded(line.places[1]);
  path += "M" + std::to_string(x) + " " + std::to_string(y) + (line.places.size() == 2 ? "h0" : "l");
  for (std::size_t i = 2; i + 1 < line.places.size(); i += 2) {
    const long next_x = rounded(line.places[i]), next_y = rounded(line.places[i + 1]);
    const std::string dx = std::to_string(next_x - x), dy = std::to_string(next_y - y);
    if (i > 2 && dx[0] != '-') path += ' ';
    path += dx;
    if (dy[0] != '-') path += ' ';
    path += dy;
    x = next_x, y = next_y;
  }
}

std::string xml_text(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else
      result += c;
  }
  return result;
}

// Returns UTF-8 text in Latin-1.
std::string latin(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i]);
    const std::size_t length = first < 0x80 ? 1 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    if (length == 1) {
      result += text[i];
    } else if (length == 2 && i + 1 < text.size() && first < 0xc4) {
      result += static_cast<char>((first & 3) << 6 | (static_cast<unsigned char>(text[i + 1]) & 0x3f));
    } else {
      result += '?';
    }
    i += length;
  }
  return result;
}

// The widths in Helvetica of the characters from the blank to the tilde, in thousandths of the size.
constexpr std::array<int, 95> kWidths{278,  278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278,
                                      556,  556, 556, 556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556,
                                      1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833, 722, 778,
                                      667,  778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556,
                                      333,  556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556,
                                      556,  556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584};

double width_of(const std::string& latin_text, double size) {
  int sum = 0;
  for (const char c : latin_text) sum += c >= ' ' && c <= '~' ? kWidths.at(static_cast<std::size_t>(c - ' ')) : 556;
  return sum * size / 1000;
}

std::string pdf_color(const Color& color) {
  return short_number(color[0]) + " " + short_number(color[1]) + " " + short_number(color[2]);
}

std::string pdf_content(const VectorPicture& picture) {
  const auto place = [&](const VectorLine& line, std::size_t i) {
    return short_number(line.places[i]) + " " + short_number(picture.height - line.places[i + 1]);
  };
  std::string text = "1 J 1 j\n";
  visit_looks(picture.lines, [&](std::size_t begin, std::size_t end) {
    text += pdf_color(picture.lines[begin].color) + " RG " + short_number(picture.lines[begin].width) + " w\n";
    for (std::size_t k = begin; k < end; ++k) {
      const VectorLine& line = picture.lines[k];
      text += place(line, 0) + " m";
      for (std::size_t i = line.places.size() == 2 ? 0 : 2; i + 1 < line.places.size(); i += 2)
        text += " " + place(line, i) + " l";
      text += "\n";
    }
    text += "S\n";
  });
  for (const VectorText& words : picture.texts) {
    const std::string line = latin(words.text);
    const double left = words.x - width_of(line, words.size) / 2;
    text += "BT " + pdf_color(rgb(0x21292f)) + " rg /" + (words.bold ? "B" : "F") + " " + short_number(words.size) +
            " Tf " + short_number(left) + " " + short_number(picture.height - words.y) + " Td (";
    for (const char c : line) {
      if (c == '(' || c == ')' || c == '\\') text += '\\';
      text += c;
    }
    text += ") Tj ET\n";
  }
  return text;
}

std::string compressed(const std::string& text) {
  vtkNew<vtkZLibDataCompressor> zlib;
  zlib->SetCompressionLevel(9);
  std::string bytes(zlib->GetMaximumCompressionSpace(text.size()), '\0');
  bytes.resize(zlib->Compress(reinterpret_cast<const unsigned char*>(text.data()), text.size(),
                              reinterpret_cast<unsigned char*>(bytes.data()), bytes.size()));
  return bytes;
}

}  // namespace

std::string to_svg(const VectorPicture& picture) {
  const std::string width = short_number(picture.width), height = short_number(picture.height);
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" +
                     width + "pt\" height=\"" + height + "pt\" viewBox=\"0 0 " + width + " " + height + "\">\n";
  text += "<g transform=\"scale(.01)\" fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n";
  visit_looks(picture.lines, [&](std::size_t begin, std::size_t end) {
    const VectorLine& first = picture.lines[begin];
    std::string path;
    for (std::size_t i = begin; i < end; ++i) append_path(picture.lines[i], path);
    text += "<path stroke=\"" + hex_of(first.color) + "\" stroke-width=\"" + std::to_string(rounded(first.width)) +
            "\" d=\"" + path + "\"/>\n";
  });
  text += "</g>\n";
  for (const VectorText& words : picture.texts) {
    text += "<text x=\"" + short_number(words.x) + "\" y=\"" + short_number(words.y) +
            "\" text-anchor=\"middle\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"" +
            short_number(words.size) + "\" " + (words.bold ? "font-weight=\"bold\" " : "") + "fill=\"#21292f\">" +
            xml_text(words.text) + "</text>\n";
  }
  return text + "</svg>\n";
}

std::string to_pdf(const VectorPicture& picture) {
  const std::string content = compressed(pdf_content(picture));
  const auto font = [](const char* name) {
    return std::string("<< /Type /Font /Subtype /Type1 /BaseFont /") + name + " /Encoding /WinAnsiEncoding >>";
  };
  const std::array<std::string, 6> objects{
      "<< /Type /Catalog /Pages 2 0 R >>",
      "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
      "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 " + short_number(picture.width) + " " +
          short_number(picture.height) + "] /Contents 6 0 R /Resources << /Font << /F 4 0 R /B 5 0 R >> >> >>",
      font("Helvetica"),
      font("Helvetica-Bold"),
      "<< /Filter /FlateDecode /Length " + std::to_string(content.size()) + " >>\nstream\n" + content + "\nendstream"};
  std::string bytes = "%PDF-1.4\n", table = "0000000000 65535 f \n";
  for (std::size_t i = 0; i < objects.size(); ++i) {
    char row[24];
    std::snprintf(row, sizeof row, "%010zu 00000 n \n", bytes.size());
    table += row;
    bytes += std::to_string(i + 1) + " 0 obj\n" + objects[i] + "\nendobj\n";
  }
  const std::string count = std::to_string(objects.size() + 1), start = std::to_string(bytes.size());
  return bytes + "xref\n0 " + count + "\n" + table + "trailer\n<< /Size " + count + " /Root 1 0 R >>\nstartxref\n" +
         start + "\n%%EOF\n";
}

}  // namespace orchard::detail
