// Writes a tree for the example that the installation test runs:  write_sample_tree file.orchard
#include <fstream>

#include "orchard/runtime/tree_file.h"
#include "support.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  using namespace orchard::runtime;
  const auto bytes = serialize(test::build_tree(test::torus(24, 12, 1, 0.3)));
  std::ofstream file(argv[1], std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return file.good() ? 0 : 1;
}
