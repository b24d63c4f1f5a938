#include "input/scene_mesh.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "input/input_file.h"
#include "orchard/geometry/error.h"
#include "robot/dae_mesh.h"

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;

// Adds the meshes of a node and of those below it.
class SceneWalk {
 public:
  SceneWalk(const aiScene& scene, TriangleMesh& mesh) : scene_(scene), mesh_(mesh) {}

  void add(const aiNode& node, const aiMatrix4x4& above) {
    const aiMatrix4x4 here = above * node.mTransformation;
    places_.clear();
    for (unsigned i = 0; i < node.mNumMeshes; ++i) add_part(*scene_.mMeshes[node.mMeshes[i]], here);
    for (unsigned i = 0; i < node.mNumChildren; ++i) add(*node.mChildren[i], here);
  }

 private:
  void add_part(const aiMesh& part, const aiMatrix4x4& place) {
    std::vector<Index> corner(part.mNumVertices);
    for (unsigned v = 0; v < part.mNumVertices; ++v) {
      const aiVector3D moved = place * part.mVertices[v];
      const auto [at, is_new] =
          places_.try_emplace({moved.x, moved.y, moved.z}, static_cast<Index>(mesh_.vertices.size()));
      if (is_new) mesh_.vertices.emplace_back(moved.x, moved.y, moved.z);
      corner[v] = at->second;
    }
    const bool mirrored = place.Determinant() < 0;
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3) continue;  // points and lines
      std::array<Index, 3> triangle{corner[face.mIndices[0]], corner[face.mIndices[1]], corner[face.mIndices[2]]};
      if (mirrored) std::swap(triangle[1], triangle[2]);
      mesh_.triangles.push_back(triangle);
    }
  }

  const aiScene& scene_;
  TriangleMesh& mesh_;
  std::map<std::array<float, 3>, Index> places_;  // of the node
};

// The first bytes of a packed file, at most 4096; empty if it cannot be unpacked.
std::string unpacked_head(std::string_view packed, bool deflated) {
  std::string head(4096, '\0');
  if (!deflated) return std::string(packed.substr(0, head.size()));
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return {};
  std::string input(packed.substr(0, 1 << 20));  // zlib takes bytes that it could change
  stream.next_in = reinterpret_cast<Bytef*>(input.data());
  stream.avail_in = static_cast<uInt>(input.size());
  stream.next_out = reinterpret_cast<Bytef*>(head.data());
  stream.avail_out = static_cast<uInt>(head.size());
  inflate(&stream, Z_SYNC_FLUSH);
  head.resize(head.size() - stream.avail_out);
  inflateEnd(&stream);
  return head;
}

// The beginning of the file in a ZIP archive whose name ends so; empty if there is none.
std::string head_in_zip(std::string_view zip, std::string_view ending) {
  const auto number = [&](std::size_t at, std::size_t bytes) {
    std::size_t value = 0;
    for (std::size_t i = bytes; i-- > 0;) value = value << 8 | static_cast<unsigned char>(zip[at + i]);
    return value;
  };
  constexpr std::size_t kEntry = 46, kLocal = 30;  // bytes of the heads
  for (std::size_t at = zip.find("PK\x01\x02"); at != zip.npos && at + kEntry <= zip.size();
       at = zip.find("PK\x01\x02", at + 4)) {
    const std::string_view name = zip.substr(at + kEntry, number(at + 28, 2));
    const std::size_t local = number(at + 42, 4);
    if (!name.ends_with(ending) || local + kLocal > zip.size()) continue;
    const std::size_t data = local + kLocal + number(local + 26, 2) + number(local + 28, 2);
    if (data <= zip.size()) return unpacked_head(zip.substr(data, number(at + 20, 4)), number(at + 10, 2) == 8);
  }
  return {};
}

// The unit that a 3MF package names in its model, by the short name that orchard prints: millimetres if it names none.
std::string unit_of_3mf(const fs::path& file) {
  static constexpr std::array<std::pair<const char*, const char*>, 6> kUnits{
      {{"micron", "um"}, {"millimeter", "mm"}, {"centimeter", "cm"}, {"inch", "in"}, {"foot", "ft"}, {"meter", "m"}}};
  const std::string head = head_in_zip(content_of(file), ".model");
  const std::size_t model = std::min(head.find("<model"), head.size());
  const std::string tag = head.substr(model, std::min(head.find('>', model), head.size()) - model);
  for (const auto& [long_name, short_name] : kUnits)
    for (const char quote : {'"', '\''})
      if (tag.find(std::string(" unit=") + quote + long_name + quote) != std::string::npos) return short_name;
  return "mm";
}

const char* name_of_scene_format(const std::string& format) {
  if (format == "3mf") return "3MF";
  return format == "dae" ? "COLLADA" : "glTF";
}

// Assimp puts the numbers of a file's faces in bounds where a file is sound; what it lets through is checked.
void check_indices(const aiScene& scene, const std::string& name) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& part = *scene.mMeshes[m];
    for (unsigned f = 0; f < part.mNumFaces; ++f)
      for (unsigned k = 0; k < part.mFaces[f].mNumIndices; ++k)
        if (part.mFaces[f].mIndices[k] >= part.mNumVertices)
          throw InputError(name + ": face " + std::to_string(f) + " of mesh " + std::to_string(m) +
                           " names a vertex that does not exist");
  }
}

TriangleMesh read_by_assimp(const fs::path& file, const std::string& format) {
  Assimp::Importer importer;
  const std::string bytes = content_of(file), name = file.string();
  const aiScene* scene = nullptr;
  try {
    // A .gltf file may have its numbers in files beside it, which are found by its own name alone.
    scene = lower_extension(file) == "." + format
                ? importer.ReadFile(name, aiProcess_Triangulate)
                : importer.ReadFileFromMemory(bytes.data(), bytes.size(), aiProcess_Triangulate, format.c_str());
  } catch (const std::exception& error) {
    throw InputError(name + ": this is no readable " + name_of_scene_format(format) + " file: " + error.what());
  }
  if (scene == nullptr || scene->mRootNode == nullptr)
    throw InputError(name + ": this is no readable " + name_of_scene_format(format) +
                     " file: " + importer.GetErrorString());
  check_indices(*scene, name);
  TriangleMesh mesh = triangles_of(*scene);
  if (mesh.triangles.empty()) throw InputError(name + ": the scene of the file has no triangle");
  return mesh;
}

}  // namespace

bool is_scene_format(const std::string& format) {
  return format == "glb" || format == "gltf" || format == "3mf" || format == "dae";
}

TriangleMesh triangles_of(const aiScene& scene) {
  TriangleMesh mesh;
  SceneWalk(scene, mesh).add(*scene.mRootNode, aiMatrix4x4());
  return mesh;
}

MeshReading read_scene(const fs::path& file, const std::string& format) {
  MeshReading reading;
  if (format == "dae") {
    reading.mesh = robot::read_dae(file);
    reading.report.unit = std::string("m");
    return reading;
  }
  reading.mesh = read_by_assimp(file, format);
  reading.report.unit = format == "3mf" ? unit_of_3mf(file) : std::string("m");
  try {
    validate(reading.mesh);
    require_usable_size(reading.mesh);
  } catch (const InputError& error) {
    throw InputError(file.string() + ": " + error.what());
  }
  return reading;
}

}  // namespace orchard::apps
