#include "vector_picture.h"

#include <algorithm>
#include <fstream>
#include <stdexcept>

#include "blocks.h"
#include "layout.h"
#include "line_art.h"
#include "vector_file.h"
#include "view_panels.h"
#include "view_parts.h"

namespace orchard::detail {
namespace {

std::vector<VectorLine> lines_of(const ViewParts& parts, int level, const Request& request,
                                 const Projection& projection, const Layout& layout) {
  LineArt art(projection, layout.panel_width, layout.panel_height);
  if (request.figure.clip) art.clip(*request.figure.clip);
  for (const auto& part : parts.axes) {
    if (request.figure.balls)
      art.add_spheres(part.second);
    else
      art.add_surface(part.second, LineArt::Surface::axis);
  }
  for (const auto& part : parts.data) {
    if (is_sphere_set(part.second))
      art.add_spheres(part.second);
    else if (is_point_set(part.second))
      art.add_points(part.second);
    else
      art.add_surface(part.second, is_bound(part.second) ? LineArt::Surface::glass : LineArt::Surface::solid);
  }
  for (const auto& part : parts.points) art.add_points(part.second);
  if (const auto trees = parts.levels.find(level); trees != parts.levels.end())
    for (const auto& part : trees->second) art.add_spheres(part.second);
  const bool solid = parts.meshes_alone() || request.opacity == 1;
  if (parts.meshes_alone() || request.opacity > 0)
    for (const auto& part : parts.meshes)
      art.add_surface(part.second, solid ? LineArt::Surface::solid : LineArt::Surface::glass);
  return art.lines();
}

// Moves lines from the lower left corner of a panel to the upper left corner of the picture.
void add_lines(std::vector<VectorLine> lines, double left, double bottom, VectorPicture& picture) {
  for (VectorLine& line : lines) {
    for (std::size_t i = 0; i + 1 < line.places.size(); i += 2) {
      line.places[i] += left;
      line.places[i + 1] = picture.height - bottom - line.places[i + 1];
    }
    picture.lines.push_back(std::move(line));
  }
}

void write_text(const std::string& file, const std::string& bytes) {
  std::ofstream out(file, std::ios::binary);
  out << bytes;
  out.close();
  if (!out) throw std::runtime_error(file + ": cannot be written; check that its folder exists and is writable");
}

}  // namespace

bool is_vector_file(const std::filesystem::path& picture) {
  return picture.extension() == ".svg" || picture.extension() == ".pdf";
}

void draw_vector_picture(const Request& request) {
  const ViewParts parts = view_parts(Blocks(request.vtm));
  if (!parts.any())
    throw std::runtime_error("only orchard view can write .svg and .pdf; give the picture a name that ends in .png");
  if (!parts.cells.empty())
    throw std::runtime_error("Voronoi cells cannot be drawn as lines; give the picture a name that ends in .png");
  const std::vector<PanelParts> panels = panel_parts(parts, request.figure);
  const int count = static_cast<int>(panels.size());
  const Views views = views_of(request, extents_of(parts, request.figure), false);
  const Layout layout = make_layout(request, {.panels = count}, views.front);
  const Projection projection =
      projection_of(views.front, layout.panel_width, layout.panel_height, layout.caption_height);
  VectorPicture picture{.width = static_cast<double>(layout.width), .height = static_cast<double>(layout.height)};
  const double line = layout.caption_height, span = layout.panel_width;
  double caption_print = 0.30 * line, detail_print = 0.24 * line;
  for (const auto& [seen, level] : panels) {
    caption_print = fitting(caption_of(seen, level), caption_print, span);
    detail_print = fitting(detail_of(seen, level), detail_print, span);
  }
  for (int i = 0; i < count; ++i) {
    const auto& [seen, level] = panels[static_cast<std::size_t>(i)];
    const auto [left, bottom] = corner_of(layout, i, count);
    add_lines(lines_of(seen, level, request, projection, layout), left, bottom, picture);
    if (!request.captions) continue;
    const double middle = left + span / 2, below = picture.height - bottom;
    // The baseline is a third of the print size below the middle of a line.
    picture.texts.push_back(
        {caption_of(seen, level), middle, below - 0.70 * line + caption_print / 3, caption_print, true});
    picture.texts.push_back({detail_of(seen, level), middle, below - 0.28 * line + detail_print / 3, detail_print});
  }
  const bool pdf = std::filesystem::path(request.png).extension() == ".pdf";
  write_text(request.png, pdf ? to_pdf(picture) : to_svg(picture));
}

}  // namespace orchard::detail
