#include "layout.h"

#include <algorithm>

namespace orchard::detail {
namespace {

using Eigen::Vector3d;

constexpr double kWidestPanel = 1.3;  // over its height
constexpr int kWidestBar = 160;       // pixels
constexpr int kRowHeight = 560;       // in pixels, if no height is asked for

}  // namespace

Layout make_layout(const Request& request, const LayoutContent& content, const View& view) {
  Layout layout{};
  layout.columns = content.panels <= 4 ? content.panels : (content.panels + 1) / 2;
  if (content.columns > 0) layout.columns = content.columns;
  layout.rows = (content.panels + layout.columns - 1) / layout.columns;
  layout.height = request.height > 0 ? request.height : kRowHeight * layout.rows;
  layout.title_height = request.title.empty() ? 0 : layout.height / (7 * layout.rows);
  layout.panel_height = (layout.height - layout.title_height) / layout.rows;
  layout.caption_height = request.captions ? layout.panel_height / 5 : 0;
  layout.bar_width = content.color_bar ? std::min(layout.panel_height / 4, kWidestBar) : 0;
  if (request.width > 0) {
    layout.width = request.width;
    layout.bar_width = std::min(layout.bar_width, layout.width / 5);
    layout.panel_width = (layout.width - layout.bar_width) / layout.columns;
    layout.caption_height = std::min(layout.caption_height, layout.panel_width / 5);
  } else {
    const double needed = (layout.panel_height - layout.caption_height) * view.width / view.height;
    layout.panel_width =
        static_cast<int>(std::clamp(needed, 5.0 * layout.caption_height, kWidestPanel * layout.panel_height));
    layout.width = layout.panel_width * layout.columns + layout.bar_width;
  }
  return layout;
}

std::pair<int, int> corner_of(const Layout& layout, int panel, int panels) {
  const int row = panel / layout.columns, column = panel % layout.columns;
  const int in_row = std::min(layout.columns, panels - row * layout.columns);
  const int room = layout.width - layout.bar_width;
  return {(room - in_row * layout.panel_width) / 2 + column * layout.panel_width,
          layout.height - layout.title_height - (row + 1) * layout.panel_height};
}

Views views_of(const Request& request, const std::vector<Extent>& extents, bool from_behind) {
  Direction behind = request.direction;
  behind.azimuth += 180;
  Views views{make_view(request.direction, extents), make_view(behind, extents)};
  if (from_behind) {
    views.front.width = views.back.width = std::max(views.front.width, views.back.width);
    views.front.height = views.back.height = std::max(views.front.height, views.back.height);
  }
  if (request.steady) views.front = steady(views.front, extents);
  if (request.look_at) {
    const double all = std::max(views.front.width, views.front.height);
    views.front = look_at(views.front, Vector3d(request.look_at->data()), request.span > 0 ? request.span : all);
  }
  return views;
}

double fitting(const std::string& text, double pixels, double width) {
  constexpr double kLetter = 0.54;  // the width of a letter over the size of the print, estimated generously
  return std::min(pixels, width / kLetter / static_cast<double>(std::max<std::size_t>(text.size(), 1)));
}

}  // namespace orchard::detail
