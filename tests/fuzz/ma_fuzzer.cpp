#include "ma_entry.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  orchard::test::read_ma_bytes(data, size);
  return 0;
}
