#pragma once
#include <string>

#include "camera.h"
#include "panels.h"
#include "render_request.h"

// Where the parts of a picture are, and from where its panels are seen.
namespace orchard::detail {

struct Layout {
  int width, height;  // of the picture, in pixels as all of these
  int columns, rows;
  int title_height, panel_width, panel_height, caption_height;
  int bar_width;  // of the colours', on the right of all panels
};

// What a picture has beside its size.
struct LayoutContent {
  int panels = 1;
  int columns = 0;  // 0: as many as fit
  bool color_bar = false;
};

// Where no width is asked for, the picture is as wide as the model needs, and its captions.
Layout make_layout(const Request& request, const LayoutContent& content, const View& view);

// The left and the lower side of a panel; the panels of a row that is not full are in its middle.
std::pair<int, int> corner_of(const Layout& layout, int panel, int panels);

// From the front and from behind, at one scale.
struct Views {
  View front, back;
};
// `from_behind`: whether a panel is.
Views views_of(const Request& request, const std::vector<Extent>& extents, bool from_behind);

// The size of print, at most `pixels`, in which `text` is not wider than `width`; all in pixels.
double fitting(const std::string& text, double pixels, double width);

}  // namespace orchard::detail
