#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <string>

#include "palette.h"

// Colours as eyes see them that miss one kind of cones: maps keep their order, and kinds of lines stay apart. The
// simulation is that of Machado, Oliveira and Fernandes (2009) at full severity, on linear light; distances are those
// of CIELAB (1976) under D65.
namespace orchard::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Eye {
  const char* name;
  Matrix3d seen;  // of linear red, green, blue
};

const std::vector<Eye>& eyes() {
  static const std::vector<Eye> kEyes = [] {
    Matrix3d protan, deutan, tritan;
    protan << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998;
    deutan << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881;
    tritan << 1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900;
    return std::vector<Eye>{
        {"all cones", Matrix3d::Identity()}, {"protanopia", protan}, {"deuteranopia", deutan}, {"tritanopia", tritan}};
  }();
  return kEyes;
}

double linear(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }

// CIELAB of what the eye sees: lightness from 0 to 100, and two coordinates of colour.
Vector3d lab(const Color& color, const Eye& eye) {
  Matrix3d to_xyz;
  to_xyz << 0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522, 0.0721750, 0.0193339, 0.1191920, 0.9503041;
  const Vector3d light =
      (eye.seen * Vector3d(linear(color[0]), linear(color[1]), linear(color[2]))).cwiseMax(0).cwiseMin(1);
  const Vector3d xyz = (to_xyz * light).cwiseQuotient(Vector3d(0.95047, 1, 1.08883));
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
  const double x = f(xyz.x()), y = f(xyz.y()), z = f(xyz.z());
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

double distance(const Color& a, const Color& b, const Eye& eye) { return (lab(a, eye) - lab(b, eye)).norm(); }

constexpr int kSteps = 64;

TEST(ColorMaps, KeepTheOrderOfLightnessForAllEyes) {
  for (const ColorMap& map : kColorMaps) {
    for (const Eye& eye : eyes()) {
      SCOPED_TRACE(std::string(map.name) + ", " + eye.name);
      const double first = lab(color_at(map, 0), eye)[0], last = lab(color_at(map, 1), eye)[0];
      ASSERT_GT(std::abs(last - first), 50) << "too little contrast";
      const double even = (last - first) / kSteps;
      for (int i = 0; i < kSteps; ++i) {
        const double from = static_cast<double>(i) / kSteps, to = static_cast<double>(i + 1) / kSteps;
        const double step = lab(color_at(map, to), eye)[0] - lab(color_at(map, from), eye)[0];
        EXPECT_GT(step / even, 0.1) << "at " << from;  // the last yellow of viridis, to tritanopes
        EXPECT_LT(step / even, 1.75) << "at " << from;
      }
    }
  }
}

TEST(ColorMaps, HaveEvenStepsOfLightnessForEyesWithAllCones) {
  for (const ColorMap& map : kColorMaps) {
    const Eye& eye = eyes().front();
    const double even = (lab(color_at(map, 1), eye)[0] - lab(color_at(map, 0), eye)[0]) / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const double step =
          lab(color_at(map, (i + 1.0) / kSteps), eye)[0] - lab(color_at(map, static_cast<double>(i) / kSteps), eye)[0];
      EXPECT_NEAR(step / even, 1, 0.5) << map.name << " at step " << i;
    }
  }
}

TEST(ColorMaps, ARainbowWouldNotPass) {
  const ColorMap rainbow{"rainbow",
                         {rgb(0x0000ff), rgb(0x0080ff), rgb(0x00ffff), rgb(0x00ff80), rgb(0x00ff00), rgb(0x80ff00),
                          rgb(0xffff00), rgb(0xff8000), rgb(0xff0000)},
                         kSeamColor};
  bool ordered = true;
  for (int i = 0; i < kSteps; ++i)
    ordered = ordered && lab(color_at(rainbow, (i + 1.0) / kSteps), eyes().front())[0] >
                             lab(color_at(rainbow, static_cast<double>(i) / kSteps), eyes().front())[0];
  EXPECT_FALSE(ordered);
}

constexpr double kApart = 18;  // about eight times what is just noticeable

TEST(ColorMaps, LeaveBordersAndSeamsVisibleOnEverySheetForAllEyes) {
  for (const ColorMap& map : kColorMaps) {
    for (const Eye& eye : eyes()) {
      for (int i = 0; i <= kSteps; ++i) {
        const Color sheet = color_at(map, static_cast<double>(i) / kSteps);
        EXPECT_GT(distance(kBorderColor, sheet, eye), kApart) << map.name << ", " << eye.name << ", border at " << i;
        EXPECT_GT(distance(map.seams, sheet, eye), kApart) << map.name << ", " << eye.name << ", seam at " << i;
      }
      EXPECT_GT(distance(kBorderColor, map.seams, eye), kApart) << map.name << ", " << eye.name;
    }
  }
}

TEST(ColorMaps, KindsOfLinesStayApartForAllEyes) {
  const std::vector<std::pair<const char*, Color>> kinds{{"borders", kBorderColor},
                                                         {"seams", kSeamColor},
                                                         {"curves", kCurveColor},
                                                         {"lines of the solid", rgb(0x9aa3ad)},
                                                         {"paper", rgb(0xffffff)}};
  for (const Eye& eye : eyes())
    for (std::size_t i = 0; i < kinds.size(); ++i)
      for (std::size_t j = i + 1; j < kinds.size(); ++j)
        EXPECT_GT(distance(kinds[i].second, kinds[j].second, eye), kApart)
            << kinds[i].first << " and " << kinds[j].first << ", " << eye.name;
}

TEST(ColorMaps, GoThroughTheirColors) {
  for (const ColorMap& map : kColorMaps) {
    EXPECT_EQ(color_map(map.name), &map);
    for (std::size_t i = 0; i < map.colors.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(color_at(map, static_cast<double>(i) / 8)[c], map.colors[i][c], 1e-12);
  }
  EXPECT_EQ(color_map("jet"), nullptr);
}

}  // namespace
}  // namespace orchard::detail
