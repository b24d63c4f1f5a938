#include "reader_entry.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  orchard::test::read_bytes(orchard::read_binary_medit, data, size);
  return 0;
}
