#include "batch/batch_support.h"

#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <thread>

#include "support/effort.h"
#include "support/shapes.h"

namespace orchard::test {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kEvery = 20;  // of so many meshes one is broken

// Whether a triangle is there twice, which repair drops.
bool is_repaired(std::size_t number) { return number % 12 == 7; }

TriangleMesh shape(std::size_t number) {
  const double size = 1 + 0.01 * static_cast<double>(number);
  switch (number % 6) {
    case 0:
      return box({0, 0, 0}, {size, 1, 2});
    case 1: {
      TriangleMesh ball = icosphere(1, size);
      if (is_repaired(number)) ball.triangles.push_back(ball.triangles.front());
      return ball;
    }
    case 2:
      return torus(12, 8, size, 0.3);
    case 3:
      return transformed(l_shape(), size, {1, 2, 3});
    case 4:
      return transformed(u_shape(0.5), size, {0, 0, 0});
    default:
      return two_boxes(0.1 * size);
  }
}

std::string name_of(std::size_t number) {
  const std::string digits = std::to_string(number);
  return "mesh-" + std::string(4 - digits.size(), '0') + digits + ".obj";
}

void add_broken(const Workplace& here, const std::string& path, std::size_t number, std::size_t kind) {
  TriangleMesh mesh = shape(number);
  if (kind == 0) here.add(path, open_box());
  if (kind == 1)
    here.add(path, std::string("v 0 0 0\nv 1 0 nan\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\n"));
  if (kind == 2)
    here.add(path, std::string("\x7f"
                               "ELF\0\1\2 v f \xff\xfe\n f 1 2 -900\n",
                               24));
  if (kind == 3) here.add(path, transformed(mesh, 1e300, {1e300, 0, 0}));
  if (kind == 4) here.add(path, mesh);
}

}  // namespace

const char* batch_status(std::size_t number) {
  return number % kEvery == kEvery / 2 ? "failed" : is_repaired(number) ? "repaired" : "solid";
}

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::size_t batch_meshes() { return more() == 1 ? 100 : 1000; }

std::vector<std::string> add_batch_meshes(const Workplace& here, const std::string& folder, std::size_t count) {
  fs::create_directories(here / folder);
  std::vector<std::string> faults;
  for (std::size_t number = 0; number < count; ++number) {
    const std::string path = folder + "/" + name_of(number);
    if (number % kEvery != kEvery / 2) {
      here.add(path, shape(number));
      continue;
    }
    const std::size_t kind = number / kEvery % 5;
    add_broken(here, path, number, kind);
    if (kind == 4) faults.insert(faults.end(), {"--fault", "hang=" + name_of(number)});
  }
  return faults;
}

std::vector<nlohmann::json> rows_in(const fs::path& file) {
  std::ifstream in(file);
  std::vector<nlohmann::json> rows;
  for (std::string line; std::getline(in, line);) rows.push_back(nlohmann::json::parse(line));
  return rows;
}

std::vector<pid_t> processes_with(const std::string& text) {
  std::vector<pid_t> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::ifstream in(entry.path() / "cmdline", std::ios::binary);
    const std::string line{std::istreambuf_iterator<char>(in), {}};
    if (line.find(text) != std::string::npos && std::stoi(name) != getpid()) found.push_back(std::stoi(name));
  }
  return found;
}

bool all_end(const std::string& text) {
  for (int i = 0; i < 3000; ++i) {
    if (processes_with(text).empty()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

std::size_t results_in(const fs::path& out) {
  std::size_t count = 0;
  std::error_code ignored;
  for (fs::directory_iterator two(out / "results", ignored), end; two != end; two.increment(ignored))
    count += static_cast<std::size_t>(std::distance(fs::directory_iterator(*two, ignored), fs::directory_iterator()));
  return count;
}

}  // namespace orchard::test
