#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "orchard/geometry/mesh.h"

// Runs the built program in a folder of its own, as a user would.
namespace orchard::test {

struct Finished {
  int exit_code = -1;
  std::string out, err;
};

// A new, empty folder that goes when this does.
class Workplace {
 public:
  Workplace();
  ~Workplace();
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
  std::string add(const std::string& name, const TriangleMesh& mesh) const;  // an .obj; returns its path
  std::string add(const std::string& name, const std::string& text) const;
  Finished run(const std::vector<std::string>& arguments) const;
  std::map<std::string, std::string> files(const std::string& folder) const;  // name, content; empty if there is none

 private:
  std::filesystem::path folder_;
};

// One line "orchard: ..." and nothing else.
bool is_one_line_error(const std::string& err);

}  // namespace orchard::test
