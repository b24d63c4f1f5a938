#include "reader_entry.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  orchard::test::read_bytes(orchard::read_legacy_vtk, data, size);
  return 0;
}
