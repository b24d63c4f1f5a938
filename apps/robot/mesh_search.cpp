#include "robot/mesh_search.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cctype>

namespace orchard::robot {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

// The name that a folder's package.xml gives it; empty: there is none.
std::string package_name(const fs::path& folder) {
  if (!is_file(folder / "package.xml")) return {};
  tinyxml2::XMLDocument document;
  if (document.LoadFile((folder / "package.xml").c_str()) != tinyxml2::XML_SUCCESS) return {};
  const auto* package = document.FirstChildElement("package");
  const auto* name = package != nullptr ? package->FirstChildElement("name") : nullptr;
  return name != nullptr && name->GetText() != nullptr ? name->GetText() : "";
}

bool is_package(const fs::path& folder, const std::string& name) {
  return folder.filename() == name || package_name(folder) == name;
}

std::string decoded(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto hex = [&](std::size_t at) {
      return at < text.size() && std::isxdigit(static_cast<unsigned char>(text[at]));
    };
    if (text[i] == '%' && hex(i + 1) && hex(i + 2)) {
      result += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

// Tries places one after the other.
class Search {
 public:
  explicit Search(FoundMesh& found) : found_(found) {}

  bool at(const fs::path& file) {
    if (!found_.file.empty()) return true;
    const fs::path plain = file.lexically_normal();
    if (is_file(plain)) {
      found_.file = plain;
    } else if (std::find(found_.tried.begin(), found_.tried.end(), plain) == found_.tried.end()) {
      found_.tried.push_back(plain);
    }
    return !found_.file.empty();
  }

  bool by_path(const std::string& path, const fs::path& folder) {
    if (at(folder / path)) return true;  // an absolute path stays one
    const std::string other = decoded(path);
    return other != path && at(folder / other);
  }

 private:
  FoundMesh& found_;
};

void search_package(const std::string& rest, const fs::path& folder, const std::vector<fs::path>& packages,
                    FoundMesh& found) {
  Search search(found);
  const std::size_t slash = rest.find('/');
  const std::string name = rest.substr(0, slash), inner = slash == std::string::npos ? "" : rest.substr(slash + 1);
  for (const fs::path& place : packages) {
    if (search.at(place / rest)) return;
    if (is_package(place, name) && search.at(place / inner)) return;
  }
  fs::path above = fs::absolute(folder).lexically_normal();
  while (true) {
    if (is_package(above, name) && search.at(above / inner)) return;
    const fs::path beside = above / name;
    std::error_code ignored;
    if (above != fs::absolute(folder).lexically_normal() && fs::is_directory(beside, ignored) &&
        search.at(beside / inner))
      return;
    if (!above.has_relative_path()) break;
    above = above.parent_path();
  }
  if (search.by_path(rest, folder))
    found.note = fmt::format("there is no package {}: read as {} beside the URDF", name, rest);
}

}  // namespace

FoundMesh find_mesh(const std::string& name, const fs::path& urdf, const std::vector<fs::path>& packages) {
  FoundMesh found;
  const fs::path folder = urdf.has_parent_path() ? urdf.parent_path() : fs::path(".");
  for (const std::string scheme : {"package://", "model://"}) {
    if (!name.starts_with(scheme)) continue;
    search_package(name.substr(scheme.size()), folder, packages, found);
    return found;
  }
  Search search(found);
  const std::string scheme = "file://";
  if (!name.starts_with(scheme)) {
    search.by_path(name, folder);
    return found;
  }
  const std::string path = name.substr(scheme.size());
  if (search.by_path(path, folder) && !path.starts_with('/'))
    found.note = "a file:// that is relative: read as relative to the URDF";
  return found;
}

fs::path other_case(const fs::path& file) {
  const auto lower = [](std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
  };
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(file.parent_path(), error))
    if (lower(entry.path().filename().string()) == lower(file.filename().string())) return entry.path();
  return {};
}

}  // namespace orchard::robot
