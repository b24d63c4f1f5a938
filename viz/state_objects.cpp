#include "state_objects.h"

#include <cstdio>

#include "orchard/geometry/xml_escaped.h"

namespace orchard::detail {
namespace {

// ParaView's tree of splits, in which item i has the children 2 i + 1 and 2 i + 2.
struct Split {
  int direction = 0;  // 0 for a view, 1 for one above the other, 2 for side by side
  double fraction = 0.5;
  int view = 0;
};

void split(std::vector<Split>& items, std::size_t at, const std::vector<int>& views, bool across) {
  if (items.size() <= at) items.resize(at + 1);
  if (views.size() == 1) {
    items[at].view = views.front();
    return;
  }
  const auto middle = views.begin() + static_cast<std::ptrdiff_t>((views.size() + 1) / 2);
  items[at].direction = across ? 2 : 1;
  items[at].fraction = static_cast<double>(middle - views.begin()) / static_cast<double>(views.size());
  split(items, 2 * at + 1, {views.begin(), middle}, !across || views.size() == 3);
  split(items, 2 * at + 2, {middle, views.end()}, !across || views.size() == 3);
}

}  // namespace

std::vector<std::string> StateObjects::texts(std::initializer_list<double> numbers) {
  std::vector<std::string> result;
  for (const double number : numbers) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", number);
    result.emplace_back(text);
  }
  return result;
}

void StateObjects::begin(const char* group, const char* type, Object object) {
  object_ = std::to_string(object);
  text_.append("    <Proxy group=\"").append(group).append("\" type=\"").append(type);
  text_.append("\" id=\"" + object_ + "\">\n");
}

void StateObjects::set(const char* property, const std::vector<std::string>& values) {
  begin_property(property, values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    text_ += "        <Element index=\"" + std::to_string(i) + "\" value=\"" + xml_escaped(values[i]) + "\"/>\n";
  text_ += "      </Property>\n";
}

void StateObjects::link(const char* property, const std::vector<Object>& objects, const std::vector<Object>& choices) {
  begin_property(property, objects.size());
  for (const Object object : objects) text_ += "        <Proxy value=\"" + std::to_string(object) + "\"/>\n";
  if (!choices.empty()) {
    text_ += "        <Domain name=\"proxy_list\" id=\"" + object_ + "." + property + ".proxy_list\">\n";
    for (const Object object : choices) text_ += "          <Proxy value=\"" + std::to_string(object) + "\"/>\n";
    text_ += "        </Domain>\n";
  }
  text_ += "      </Property>\n";
}

void StateObjects::layout_of(const std::vector<Object>& views) {
  std::vector<Split> items;
  split(items, 0, views, true);
  text_ += "      <Layout number_of_elements=\"" + std::to_string(items.size()) + "\">\n";
  for (const Split& item : items) {
    text_ += "        <Item direction=\"" + std::to_string(item.direction) + "\" fraction=\"" +
             texts({item.fraction}).front() + "\" view=\"" + std::to_string(item.view) + "\"/>\n";
  }
  text_ += "      </Layout>\n";
}

void StateObjects::name(const char* collection, Object object, const std::string& name) {
  names_.append("    <ProxyCollection name=\"").append(collection).append("\">\n      <Item id=\"");
  names_ += std::to_string(object) + "\" name=\"" + xml_escaped(name) + "\"/>\n    </ProxyCollection>\n";
}

void StateObjects::link_cameras(const std::vector<Object>& views) {
  for (std::size_t i = 1; i < views.size(); ++i) {
    const std::string first = std::to_string(views.front()), other = std::to_string(views[i]);
    links_ += "      <CameraLink name=\"CameraLink" + std::to_string(i) + "\">\n";
    for (const auto& [from, to] : {std::pair{first, other}, {other, first}}) {
      links_ += "        <Proxy direction=\"input\" id=\"" + from + "\"/>\n";
      links_ += "        <Proxy direction=\"output\" id=\"" + to + "\"/>\n";
    }
    links_ += "      </CameraLink>\n";
  }
}

std::string StateObjects::whole() const {
  const std::string links = links_.empty() ? "" : "    <Links>\n" + links_ + "    </Links>\n";
  return "<ParaView>\n  <ServerManagerState version=\"5.11.0\">\n" + text_ + names_ + links +
         "  </ServerManagerState>\n</ParaView>\n";
}

void StateObjects::begin_property(const char* property, std::size_t count) {
  text_.append("      <Property name=\"").append(property).append("\" id=\"" + object_ + "." + property);
  text_.append("\" number_of_elements=\"" + std::to_string(count) + "\">\n");
}

}  // namespace orchard::detail
