#pragma once
#include <filesystem>
#include <string>
#include <vector>

// Finds the mesh files of a robot without ROS.
namespace orchard::robot {

struct FoundMesh {
  std::filesystem::path file;                // empty: there is none
  std::vector<std::filesystem::path> tried;  // without those that are there
  std::string note;  // how the name had to be interpreted, if it differs from what the URDF says; otherwise empty
};

// Looks for a mesh by its name in a URDF:
//   - package://NAME/rest: below each of `packages` (folders of packages, or packages), and below the folder NAME, or
//     the one whose package.xml says NAME, in which the URDF lies, and beside it, folder by folder upward; where there
//     is no such package, NAME/rest as a relative path;
//   - model://NAME/rest: likewise;
//   - file://path, and paths: absolute, or relative to the URDF's folder; %20 and the like are tried decoded, too.
FoundMesh find_mesh(const std::string& name, const std::filesystem::path& urdf,
                    const std::vector<std::filesystem::path>& packages);

// A file in the same folder whose name differs in nothing but the case of its letters; empty: there is none.
std::filesystem::path other_case(const std::filesystem::path& file);

}  // namespace orchard::robot
