#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "orchard/spheretree/sphere_audit.h"

// What an audit of a set of spheres says, for people and as JSON.
namespace orchard::apps {

// Of one set beside one mesh. Lengths are in mesh units.
nlohmann::json to_json(const SphereAudit& audit, const Surface& surface);

// The table, without the verdict.
void print_audit(const SphereAudit& audit, const Surface& surface);

// Open surface that is more than what rounding leaves where spheres meet.
bool is_open(const SphereAudit& audit, const Surface& surface);
// "CLOSED: .." or "OPEN: ..", in one line.
std::string verdict(const SphereAudit& audit, const Surface& surface);

// For a set that does not touch the mesh, or is far larger or smaller than it: the unit or the frame in which it would
// fit, as a sentence; empty: it fits as it is, or there is no guess.
std::string suggested_frame(const Surface& surface, std::span<const Sphere> spheres);

}  // namespace orchard::apps
