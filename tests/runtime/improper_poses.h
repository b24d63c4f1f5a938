#pragma once
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "support.h"

// What a program may hand over in place of a pose, at that place where a proper one would be.
namespace orchard::runtime::test {

inline Pose rounded_to_float(Pose pose) {
  // Through memory: GCC 12 with -O2 leaves a conversion to float and back out where it makes vectors of such lines.
  const auto round = [](double& x) {
    const volatile float rounded = static_cast<float>(x);
    x = double{rounded};
  };
  for (double& x : pose.rotation) round(x);
  for (double& x : pose.translation) round(x);
  return pose;
}

inline std::vector<std::pair<std::string, Pose>> improper_poses(const Pose& proper) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  std::vector<std::pair<std::string, Pose>> poses;
  const auto add = [&](std::string name, auto&& change) {
    Pose pose = proper;
    change(pose);
    poses.emplace_back(std::move(name), pose);
  };
  add("zeros", [](Pose& p) { p.rotation = {}, p.translation = {}, p.scale = 0; });
  add("a zero matrix", [](Pose& p) { p.rotation = {}; });
  add("a mirror", [](Pose& p) {
    for (std::size_t i = 0; i < 3; ++i) p.rotation[i] = -p.rotation[i];
  });
  add("a point reflection", [](Pose& p) {
    for (double& x : p.rotation) x = -x;
  });
  add("shear", [](Pose& p) { p.rotation[1] += 0.5; });
  add("a little shear", [](Pose& p) { p.rotation[7] += 1e-9; });
  add("a scaled matrix", [](Pose& p) {
    for (double& x : p.rotation) x *= 1 + 1e-9;
  });
  add("one stretched axis", [](Pose& p) {
    for (std::size_t i = 6; i < 9; ++i) p.rotation[i] *= 2;
  });
  add("two equal rows", [](Pose& p) {
    for (std::size_t i = 0; i < 3; ++i) p.rotation[3 + i] = p.rotation[i];
  });
  add("floats", [](Pose& p) { p = rounded_to_float(p); });
  for (const double bad : {nan, infinity, -infinity, 1e200}) {
    for (std::size_t i = 0; i < 9; ++i) {
      add("an entry " + std::to_string(bad), [=](Pose& p) { p.rotation[i] = bad; });
    }
  }
  for (const double bad : {nan, infinity, -infinity}) {
    for (std::size_t i = 0; i < 3; ++i) {
      add("a translation " + std::to_string(bad), [=](Pose& p) { p.translation[i] = bad; });
    }
  }
  for (const double bad : {0.0, -1.0, nan, infinity, -infinity, 1e-101, 1e101, 5e-324}) {
    add("a scale " + std::to_string(bad), [=](Pose& p) { p.scale = bad; });
  }
  return poses;
}

}  // namespace orchard::runtime::test
