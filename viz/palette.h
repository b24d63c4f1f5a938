#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

// The colours that represent values, both in pictures and in ParaView's states.
namespace orchard::detail {

using Color = std::array<double, 3>;  // red, green, blue, 0 to 1

constexpr Color rgb(int hex) { return {((hex >> 16) & 255) / 255.0, ((hex >> 8) & 255) / 255.0, (hex & 255) / 255.0}; }

// A map from values to colours at even steps. Its lightness rises or falls monotonically, also for colour-blind viewers
// (tests/viz/color_maps_test.cpp).
struct ColorMap {
  std::string_view name;
  std::array<Color, 9> colors;
  Color seams;  // the colour of lines on surfaces with this map
};

inline constexpr Color kBorderColor = rgb(0x000000);  // the colour of the borders of sheets, with every map
inline constexpr Color kSeamColor = rgb(0xd55e00), kCurveColor = rgb(0x0072b2);

inline constexpr std::array kColorMaps{
    ColorMap{"viridis",
             {rgb(0x440154), rgb(0x472d7b), rgb(0x3b528b), rgb(0x2c728e), rgb(0x21918c), rgb(0x28ae80), rgb(0x5ec962),
              rgb(0xaddc30), rgb(0xfde725)},
             kSeamColor},
    ColorMap{"cividis",
             {rgb(0x002051), rgb(0x11366c), rgb(0x3c4d6e), rgb(0x62646f), rgb(0x7f7c75), rgb(0x9a9478), rgb(0xbbaf71),
              rgb(0xe2cb5c), rgb(0xfdea45)},
             kSeamColor},
    ColorMap{"blues",
             {rgb(0xeef4f9), rgb(0xcfe1ef), rgb(0xabcbe3), rgb(0x84b1d5), rgb(0x5f95c4), rgb(0x4379ae), rgb(0x305e93),
              rgb(0x214576), rgb(0x152e57)},
             kSeamColor},
    ColorMap{"heat",
             {rgb(0xf2efe6), rgb(0xf5dead), rgb(0xf4c57b), rgb(0xefa652), rgb(0xe58435), rgb(0xd26028), rgb(0xb93f21),
              rgb(0x9e251e), rgb(0x86161c)},
             rgb(0x0072b2)},
    ColorMap{"grey",
             {rgb(0x505050), rgb(0x626262), rgb(0x747474), rgb(0x878787), rgb(0x9a9a9a), rgb(0xadadad), rgb(0xc2c2c2),
              rgb(0xd6d6d6), rgb(0xebebeb)},
             kSeamColor}};
inline constexpr const ColorMap& kViridis = kColorMaps[0];
inline constexpr const ColorMap& kHeat = kColorMaps[3];  // the map of errors, which is pale for 0

// Returns null if there is no map of this name.
constexpr const ColorMap* color_map(std::string_view name) {
  for (const ColorMap& map : kColorMaps)
    if (map.name == name) return &map;
  return nullptr;
}

// Returns the colour at t in [0, 1], interpolated between its neighbours.
inline Color color_at(const ColorMap& map, double t) {
  const double place = std::clamp(t, 0.0, 1.0) * static_cast<double>(map.colors.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(place), map.colors.size() - 2);
  Color color{};
  for (std::size_t c = 0; c < 3; ++c)
    color[c] =
        map.colors[below][c] + (place - static_cast<double>(below)) * (map.colors[below + 1][c] - map.colors[below][c]);
  return color;
}

// The colours of Okabe and Ito, which colour-blind viewers can distinguish, for numbers of parts.
inline constexpr std::array kDistinct{rgb(0x0072b2), rgb(0xe69f00), rgb(0x009e73), rgb(0xcc79a7),
                                      rgb(0x56b4e9), rgb(0xd55e00), rgb(0xf0e442), rgb(0x808080)};

}  // namespace orchard::detail
