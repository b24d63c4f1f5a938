#pragma once
#include <span>
#include <string>
#include <vector>

#include "command_line/commands.h"
#include "output/outputs.h"

// The files that `orchard spheres` writes of a set, whether it was made or read.
namespace orchard::apps {

// What a set is, beside its spheres.
struct SetToWrite {
  std::span<const Sphere> spheres;
  std::string title;                           // a sentence for the head of the text, without its full stop
  const ParticleFigures* particles = nullptr;  // of that fit
};

// All names that a set's files may have.
std::vector<std::string> set_file_names(const SpheresCommand& command);

// Those of them that -o may name a file for: the spheres in one of the formats, or the tree.
std::vector<std::string> set_files(const SpheresCommand& command);

// As text, and in the formats of --export.
void write_set(const SpheresCommand& command, const Provenance& provenance, const SetToWrite& set, Outputs& outputs);

// The bytes of an .orchard file over a cover of a surface: with its triangles, and proven to hold it. Throws Error if
// it is not.
std::string cover_tree(const Surface& surface, std::span<const Sphere> spheres);
// The same over spheres whose union is the object.
std::string union_tree(std::span<const Sphere> spheres);

// Writes one of these.
void write_cover_tree(const SpheresCommand& command, const Surface& surface, std::span<const Sphere> spheres,
                      Outputs& outputs);
void write_union_tree(const SpheresCommand& command, std::span<const Sphere> spheres, Outputs& outputs);

// Whether the input's name is one of sets of spheres rather than of meshes.
bool names_spheres(const std::filesystem::path& input);

// `orchard spheres` of an input that holds spheres already.
ExitCode spheres_of_file(const SpheresCommand& command);

}  // namespace orchard::apps
