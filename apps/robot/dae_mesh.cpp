#include "robot/dae_mesh.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <tinyxml2.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <map>
#include <string>

#include "input/xml_file.h"
#include "orchard/geometry/error.h"

namespace orchard::robot {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLElement;

// What <asset> says.
struct Asset {
  double meter = 1;
  char up = 'Y';
};

Asset read_asset(const fs::path& file) {
  tinyxml2::XMLDocument document;
  const XMLElement& root = apps::parse_xml(file, document, "COLLADA", "COLLADA file");
  Asset result;
  const XMLElement* asset = root.FirstChildElement("asset");
  if (asset == nullptr) return result;
  if (const XMLElement* unit = asset->FirstChildElement("unit"); unit != nullptr && unit->Attribute("meter") != nullptr)
    result.meter = apps::numbers_in(unit->Attribute("meter"), 1, apps::at_line(file, *unit), "meter").front();
  if (!(result.meter > 0) || !std::isfinite(result.meter))
    throw InputError(apps::at_line(file, *asset) + ": the unit is to be above 0");
  const XMLElement* up = asset->FirstChildElement("up_axis");
  if (up != nullptr && up->GetText() != nullptr) result.up = up->GetText()[0];
  return result;
}

// From the file's axes to those where z points up.
Eigen::Matrix3d upright(char up) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (up == 'Y') turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  if (up == 'X') turn << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return turn;
}

// Adds the meshes of a node and of those below it.
class Scene {
 public:
  Scene(const aiScene& scene, TriangleMesh& mesh) : scene_(scene), mesh_(mesh) {}

  void add(const aiNode& node, const aiMatrix4x4& above) {
    const aiMatrix4x4 here = above * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) add(*scene_.mMeshes[node.mMeshes[i]], here);
    for (unsigned i = 0; i < node.mNumChildren; ++i) add(*node.mChildren[i], here);
  }

 private:
  void add(const aiMesh& part, const aiMatrix4x4& place) {
    std::map<std::array<float, 3>, Index> places;
    std::vector<Index> corner(part.mNumVertices);
    for (unsigned v = 0; v < part.mNumVertices; ++v) {
      const aiVector3D moved = place * part.mVertices[v];
      const auto [at, is_new] =
          places.try_emplace({moved.x, moved.y, moved.z}, static_cast<Index>(mesh_.vertices.size()));
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
};

}  // namespace

TriangleMesh read_dae(const fs::path& file, const DaeOptions& options) {
  const Asset asset = read_asset(file);
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFile(file.string(), aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr)
    throw InputError(file.string() + ": cannot be read: " + importer.GetErrorString());
  TriangleMesh mesh;
  Scene(*scene, mesh).add(*scene->mRootNode, aiMatrix4x4());
  if (mesh.triangles.empty()) throw InputError(file.string() + ": its scene has no triangle");
  // Assimp has applied the unit.
  const double scale = options.units ? 1 : 1 / asset.meter;
  const Eigen::Matrix3d turn = options.up ? upright(asset.up) : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  for (Point& vertex : mesh.vertices) vertex = scale * (turn * vertex);
  validate(mesh);
  require_usable_size(mesh);
  return mesh;
}

}  // namespace orchard::robot
