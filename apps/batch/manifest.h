#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace orchard::apps {

struct BatchMesh {
  std::string name;            // as in the manifest, or relative to the folder, so that it is the same on every machine
  std::filesystem::path file;  // where it is
};

// The meshes of a batch in their order, which is that of its rows.
struct Manifest {
  std::vector<BatchMesh> meshes;
  std::string checksum;  // of the names: manifests with the same checksum have the same rows
};

// Reads a text file of a path a line (relative to the file's folder; empty lines and lines that begin with # do not
// count), or lists the meshes (input/mesh_input.h) of a folder and the folders in it, sorted by name, but for what
// lies in `skipped`. Throws InputError if there is no mesh, or if some are missing, may not be read or are no plain
// files: the message names them all. Cost: one look at every file.
Manifest read_manifest(const std::filesystem::path& source, const std::filesystem::path& skipped);

// A part of a manifest: every `count`th mesh, from the number `index`, counted from 1, on.
struct Shard {
  std::size_t index = 1, count = 1;
};

// "2/8". Throws InputError if that is no shard.
Shard parse_shard(const std::string& text);

// "2-of-8": the stem of the shard's files.
std::string stem_of(const Shard& shard);

// The positions in the manifest of the meshes of a shard, in ascending order; none if there are fewer than shards.
std::vector<std::size_t> positions_of(const Shard& shard, std::size_t meshes);

}  // namespace orchard::apps
