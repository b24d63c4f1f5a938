#include "program.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "orchard/geometry/mesh_io.h"

namespace orchard::test {
namespace {

std::string read(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string quoted(const std::string& argument) {
  std::string text(1, '\'');
  for (const char c : argument) {
    if (c == '\'') {
      text += "'\\''";
    } else {
      text += c;
    }
  }
  text += '\'';
  return text;
}

}  // namespace

Workplace::Workplace() {
  std::string name = (std::filesystem::temp_directory_path() / "orchard-apps-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  folder_ = name;
}

Workplace::~Workplace() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::string Workplace::add(const std::string& name, const TriangleMesh& mesh) const {
  write_obj(folder_ / name, mesh);
  return (folder_ / name).string();
}

std::string Workplace::add(const std::string& name, const std::string& text) const {
  std::ofstream(folder_ / name, std::ios::binary) << text;
  return (folder_ / name).string();
}

Finished Workplace::run(const std::vector<std::string>& arguments) const {
  std::string command = quoted(ORCHARD_PROGRAM);
  for (const std::string& argument : arguments) (command += ' ') += quoted(argument);
  const std::string out = (folder_ / "stdout").string(), err = (folder_ / "stderr").string();
  const int status = std::system(command.append(" >").append(quoted(out)).append(" 2>").append(quoted(err)).c_str());
  Finished finished{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(out), read(err)};
  std::filesystem::remove(out);
  std::filesystem::remove(err);
  return finished;
}

std::map<std::string, std::string> Workplace::files(const std::string& folder) const {
  std::map<std::string, std::string> files;
  if (!std::filesystem::exists(folder_ / folder)) return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_ / folder)) {
    if (entry.is_regular_file()) files[entry.path().filename().string()] = read(entry.path());
  }
  return files;
}

bool is_one_line_error(const std::string& err) {
  return err.starts_with("orchard: ") && err.ends_with('\n') && std::count(err.begin(), err.end(), '\n') == 1;
}

}  // namespace orchard::test
