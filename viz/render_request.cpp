#include "render_request.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "palette.h"

namespace orchard::detail {
namespace {

constexpr const char* kUsage =
    "usage: orchard-render VIEWS.vtm PICTURE.png|.svg|.pdf [options]\n"
    "Draws what \"orchard build\" or \"orchard medial\" wrote for ParaView, or a scene of \"orchard view\". Needs an X "
    "display, for instance by "
    "xvfb-run, unless the picture is one of lines (.svg, .pdf).\n"
    "  --width N      pixels, 64 to 8192; 0 (default): as wide as the model needs\n"
    "  --height N     pixels, 64 to 8192; 0 (default): 560 for each row of panels\n"
    "  --up x|y|z     the model's axis that points up (y)\n"
    "  --azimuth A    degrees from the model's front to its right (35)\n"
    "  --elevation A  degrees above its middle, -80 to 80 (23)\n"
    "  --title TEXT   above the panels\n"
    "  --opacity A    of meshes in a scene that has more than them, 0 to 1 (0.16)\n"
    "  --whole        all Voronoi cells of a scene, not those of the half away from the eye: where a box has cut them\n"
    "  --color NAME   by an array of the points, or cells, with a bar of its colours\n"
    "  --bar-title TEXT   beside this bar (the name)\n"
    "  --map NAME     of the colours: viridis (default), cividis, blues, heat, grey\n"
    "  --range A,B    of these colours (that of all values)\n"
    "  --look-at X,Y,Z, --span W   a part of the scene, W wide and high\n"
    "  --clip A,B,C,D  cuts away what has A x + B y + C z > D\n"
    "  --edges        borders and seams of axes, feature edges of .vtp files\n"
    "  --balls        the balls of axes instead of their sheets\n"
    "  --beside       a panel for each thing, with the meshes around it\n"
    "  --room X,Y,Z,X,Y,Z  two corners of a box that must fit in as well\n"
    "  --no-captions  nothing below the panels\n"
    "  --transparent  no ground\n"
    "  --steady       room for the scene from all directions\n"
    "  --window       a window instead of a picture, of a scene; s saves what it shows to PICTURE.png\n"
    "  --level K      of the trees, that the window begins with (the last)\n";

double number(const std::string& text, double low, double high) {
  std::size_t used = 0;
  const double value = std::stod(text, &used);
  if (used != text.size() || !(value >= low && value <= high)) throw std::out_of_range(text);
  return value;
}

// "1,2,3"
template <std::size_t count>
std::array<double, count> numbers(const std::string& text) {
  std::array<double, count> result{};
  std::size_t at = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    result.at(i) = number(text.substr(at, end - at), -1e300, 1e300);
    if ((end == text.size()) != (i + 1 == count)) throw std::out_of_range(text);
    at = end + 1;
  }
  return result;
}

bool set_flag(const std::string& option, Request& request) {
  const std::map<std::string, bool*> flags{
      {"--window", &request.window},      {"--whole", &request.whole},          {"--edges", &request.figure.edges},
      {"--balls", &request.figure.balls}, {"--beside", &request.figure.beside}, {"--transparent", &request.transparent},
      {"--steady", &request.steady}};
  if (option == "--no-captions") {
    request.captions = false;
    return true;
  }
  const auto flag = flags.find(option);
  if (flag == flags.end()) return false;
  *flag->second = true;
  return true;
}

bool set_figure(const std::string& option, const std::string& value, Request& request) {
  if (option == "--color") {
    request.figure.color = value;
  } else if (option == "--range") {
    request.figure.range = numbers<2>(value);
  } else if (option == "--bar-title") {
    request.figure.bar_title = value;
  } else if (option == "--map") {
    if (color_map(value) == nullptr) throw std::out_of_range(value);
    request.figure.map = value;
  } else if (option == "--room") {
    request.figure.room = numbers<6>(value);
  } else if (option == "--clip") {
    request.figure.clip = numbers<4>(value);
  } else if (option == "--look-at") {
    request.look_at = numbers<3>(value);
  } else if (option == "--span") {
    request.span = number(value, 0, 1e300);
  } else {
    return false;
  }
  return true;
}

void set(const std::string& option, const std::string& value, Request& request) {
  if (option == "--width") {
    request.width = value == "0" ? 0 : static_cast<int>(number(value, 64, 8192));
  } else if (option == "--height") {
    request.height = value == "0" ? 0 : static_cast<int>(number(value, 64, 8192));
  } else if (option == "--up" && (value == "x" || value == "y" || value == "z")) {
    request.direction.up = value[0];
  } else if (option == "--azimuth") {
    request.direction.azimuth = number(value, -360, 720);
  } else if (option == "--elevation") {
    request.direction.elevation = number(value, -80, 80);
  } else if (option == "--opacity") {
    request.opacity = number(value, 0, 1);
  } else if (option == "--level") {
    request.level = static_cast<int>(number(value, 0, 1e6));
  } else if (option == "--title") {
    request.title = value;
  } else if (!set_figure(option, value, request)) {
    throw std::invalid_argument(option);
  }
}

}  // namespace

Request parse_request(const std::vector<std::string>& arguments) {
  Request request;
  request.vtm = arguments.at(0);
  request.png = arguments.at(1);
  for (std::size_t i = 2; i < arguments.size(); ++i) {
    if (set_flag(arguments[i], request)) continue;
    set(arguments[i], arguments.at(i + 1), request);
    ++i;
  }
  return request;
}

const char* usage() { return kUsage; }

}  // namespace orchard::detail
