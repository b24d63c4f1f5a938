#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "input/repair_distance.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/repair.h"

// Reports how a file was read. Repairs of the mesh are reported elsewhere.
namespace orchard::apps {

// Prints a line for each kind of element that the reader skipped, and for each of its decisions.
void print_reading(const std::filesystem::path& file, const MeshReadReport& reading);
// Returns the unit to print after a number: " mm", or nothing.
std::string with_unit(const std::string& unit);
nlohmann::json reading_json(const MeshReadReport& reading);

// For --strict: throws InputError if anything that makes up the surface was skipped.
void require_complete(const std::string& name, const MeshReadReport& reading);

// Returns a warning if filled holes moved the surface far, with what to do about it; empty if they did not.
std::string hole_warning(const MeshRepairReport& repair, const RepairDistance& distance, double bounding_radius);
// Prints a warning to standard error in a line of its own, whatever else a command prints.
void print_warning(const std::filesystem::path& file, const std::string& warning);
void print_hole_warning(const std::filesystem::path& file, const MeshRepairReport& repair,
                        const RepairDistance& distance, double bounding_radius);

}  // namespace orchard::apps
