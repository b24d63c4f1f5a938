// How many spheres each way of finding redundancy removes from octrees, merged and annealed trees, as a Markdown table.
// Usage: orchard_redundancy_table [--no-annealing] MESH..
#include <cstdio>
#include <filesystem>
#include <string_view>

#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/repair.h"
#include "orchard/spheretree/annealing.h"
#include "orchard/spheretree/octree.h"
#include "orchard/spheretree/redundancy.h"
#include "trees.h"

namespace {

using namespace orchard;

void row(const std::string& mesh, const char* kind, const Surface& surface, const SphereTree& tree, Index earlier) {
  std::printf("| %s | %s | %zu |", mesh.c_str(), kind, tree.nodes.size() + earlier);
  for (const Selection selection : {Selection::independent, Selection::acyclic, Selection::exhaustive}) {
    SphereTree rest = tree;
    const RedundancyReport report = remove_redundant(rest, surface, selection);
    if (selection == Selection::independent) std::printf(" %u | %u |", report.by_siblings, report.by_aunts);
    if (selection == Selection::exhaustive) {
      std::printf(" %u |\n", report.removed + earlier);
    } else {
      std::printf(" %u (%u kept) |", report.removed, report.vetoed);
    }
  }
  std::fflush(stdout);
}

void rows(const char* file, bool annealing) {
  TriangleMesh mesh = read_mesh(file);
  repair_mesh(mesh);
  const Surface surface(std::move(mesh));
  const std::string name = std::filesystem::path(file).stem().string();
  row(name, "octree", surface, octree(surface), 0);
  row(name, "merged", surface, bench::merged_tree(surface), 0);
  if (!annealing) return;
  const auto [annealed, report] = annealed_tree(surface);
  row(name, "annealed", surface, annealed, report.redundant);
}

}  // namespace

int main(int argc, char** argv) {
  std::puts("| model | tree | spheres | by siblings | by aunts | independent set | cycles broken | whatever can go |");
  std::puts("|---|---|---:|---:|---:|---:|---:|---:|");
  const bool annealing = argc < 2 || std::string_view(argv[1]) != "--no-annealing";
  for (int i = annealing ? 1 : 2; i < argc; ++i) rows(argv[i], annealing);
}
