#pragma once
#include <array>

// The colours that stand for values: in pictures and in ParaView's states alike.
namespace orchard::detail {

using Color = std::array<double, 3>;  // red, green, blue, 0 to 1

constexpr Color rgb(int hex) { return {((hex >> 16) & 255) / 255.0, ((hex >> 8) & 255) / 255.0, (hex & 255) / 255.0}; }

// Viridis, whose brightness grows evenly, at even steps.
inline constexpr std::array kViridis{rgb(0x440154), rgb(0x472d7b), rgb(0x3b528b), rgb(0x2c728e), rgb(0x21918c),
                                     rgb(0x28ae80), rgb(0x5ec962), rgb(0xaddc30), rgb(0xfde725)};
// Of Okabe and Ito, which colour-blind people can tell apart: for numbers of things.
inline constexpr std::array kDistinct{rgb(0x0072b2), rgb(0xe69f00), rgb(0x009e73), rgb(0xcc79a7),
                                      rgb(0x56b4e9), rgb(0xd55e00), rgb(0xf0e442), rgb(0x808080)};

}  // namespace orchard::detail
