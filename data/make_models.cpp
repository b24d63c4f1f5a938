// orchard_make_models OUTPUT_DIR: writes lamp.obj, faucet.obj and ship.obj.

#include <exception>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <locale>
#include <stdexcept>
#include <string>

#include "models.h"

namespace {

namespace fs = std::filesystem;
using orchard::models::TriangleMesh;

constexpr int kExitFailure = 2;

void write_mesh(std::ostream& out, const TriangleMesh& mesh, const std::string& name) {
  out.imbue(std::locale::classic());
  out << "# " << name << ", " << mesh.points.size() << " vertices, " << mesh.triangles.size() << " triangles\n";
  out << std::fixed << std::setprecision(orchard::models::kDecimals);
  for (const auto& p : mesh.points) out << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (const auto& t : mesh.triangles) {
    out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  }
}

// A reader never sees half a model: the file gets its name only once it is complete.
void save_model(const fs::path& directory, const std::string& name, const TriangleMesh& mesh) {
  const fs::path target = directory / (name + ".obj");
  const fs::path temporary = directory / (name + ".obj.tmp");
  {
    // Binary, so that line ends are the same bytes on every system.
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    write_mesh(out, mesh, name);
    out.close();
    if (!out) {
      std::error_code ignored;
      fs::remove(temporary, ignored);
      throw std::runtime_error("cannot write " + temporary.string());
    }
  }
  fs::rename(temporary, target);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: orchard_make_models OUTPUT_DIR\n";
    return kExitFailure;
  }
  try {
    const fs::path directory = argv[1];
    if (!fs::is_directory(directory)) {
      throw std::runtime_error("not a directory: " + directory.string());
    }
    save_model(directory, "lamp", orchard::models::make_lamp());
    save_model(directory, "faucet", orchard::models::make_faucet());
    save_model(directory, "ship", orchard::models::make_ship());
  } catch (const std::exception& error) {
    std::cerr << "orchard_make_models: " << error.what() << '\n';
    return kExitFailure;
  }
  return 0;
}
