#include "robot/dae_mesh.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <tinyxml2.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <string>

#include "input/scene_mesh.h"
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
    throw InputError(apps::at_line(file, *asset) + ": the unit must be above 0");
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

}  // namespace

TriangleMesh read_dae(const fs::path& file, const DaeOptions& options) {
  const Asset asset = read_asset(file);
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFile(file.string(), aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr)
    throw InputError(file.string() + ": the file cannot be read: " + importer.GetErrorString());
  TriangleMesh mesh = apps::triangles_of(*scene);
  if (mesh.triangles.empty()) throw InputError(file.string() + ": the scene of the file has no triangle");
  // Assimp has applied the unit.
  const double scale = options.units ? 1 : 1 / asset.meter;
  const Eigen::Matrix3d turn = options.up ? upright(asset.up) : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  for (Point& vertex : mesh.vertices) vertex = scale * (turn * vertex);
  validate(mesh);
  require_usable_size(mesh);
  return mesh;
}

}  // namespace orchard::robot
