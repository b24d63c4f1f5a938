#pragma once
#include <initializer_list>
#include <string>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// The text of a state: ParaView's objects ("proxies") by number, each with the properties that differ from ParaView's
// defaults, and then the names by which they are found.
class StateObjects {
 public:
  using Object = int;

  static std::vector<std::string> texts(std::initializer_list<double> numbers);
  static std::vector<std::string> texts(const Vector& v) { return texts({v.x(), v.y(), v.z()}); }

  // A number for an object that is written later.
  Object reserve() { return next_++; }
  void begin(const char* group, const char* type, Object object);
  Object begin(const char* group, const char* type) {
    const Object object = reserve();
    begin(group, type, object);
    return object;
  }
  void set(const char* property, const std::vector<std::string>& values);
  void set(const char* property, const std::string& value) { set(property, std::vector<std::string>{value}); }
  void set(const char* property, double value) { set(property, texts({value})); }
  // `choices` has the objects that the property offers as alternatives.
  void link(const char* property, const std::vector<Object>& objects, const std::vector<Object>& choices = {});
  // Sets the object to a layout of views side by side, in rows.
  void layout_of(const std::vector<Object>& views);
  void end() { text_ += "    </Proxy>\n"; }

  void name(const char* collection, Object object, const std::string& name);
  // The cameras of these views move together.
  void link_cameras(const std::vector<Object>& views);

  std::string whole() const;

 private:
  void begin_property(const char* property, std::size_t count);

  std::string text_, names_, links_, object_;
  Object next_ = 101;
};

}  // namespace orchard::detail
