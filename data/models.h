// The bundled models. All stand or fly with +y up.
#pragma once

#include "solid_builder.h"

namespace orchard::models {

/// Desk lamp: round base, jointed arm of twin rods, hollow conical shade with a bulb.
[[nodiscard]] TriangleMesh make_lamp();

/// Bathroom faucet: base plate, arched spout, two cross handles, lift rod behind the spout.
[[nodiscard]] TriangleMesh make_faucet();

/// Spaceship: long hull with a nose, thin wings, engine nacelles on struts, spherical pods.
[[nodiscard]] TriangleMesh make_ship();

}  // namespace orchard::models
