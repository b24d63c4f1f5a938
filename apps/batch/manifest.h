#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace orchard::apps {

struct BatchMesh {
  std::string name;            // as in the manifest, or relative to the folder, so that it is the same on every machine
  std::filesystem::path file;  // its path
};

// The meshes of a batch, in the order of its rows.
struct Manifest {
  std::vector<BatchMesh> meshes;
  std::string checksum;  // of the names: manifests with the same checksum have the same rows
};

// Reads the meshes of a batch. If `source` is a text file, each line is a path, relative to the file's folder; empty
// lines and lines that begin with # are skipped. If it is a folder, the meshes (input/mesh_input.h) in it and in the
// folders below are listed by name, without those in `skipped`. Throws InputError if there is no mesh, or if some are
// missing, unreadable or no regular files; the message names all of these. Cost: the status of every file is read.
Manifest read_manifest(const std::filesystem::path& source, const std::filesystem::path& skipped);

// A part of a manifest: every `count`th mesh, beginning with number `index`, counted from 1.
struct Shard {
  std::size_t index = 1, count = 1;
};

// Parses a shard such as "2/8". Throws InputError if the text is no shard.
Shard parse_shard(const std::string& text);

// Returns the stem of the names of a shard's files, such as "2-of-8".
std::string stem_of(const Shard& shard);

// Returns the positions in the manifest of the meshes of a shard, in ascending order. There are none if the shard's
// number exceeds that of the meshes.
std::vector<std::size_t> positions_of(const Shard& shard, std::size_t meshes);

}  // namespace orchard::apps
