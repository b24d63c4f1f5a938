#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace orchard::apps {

// Computes the SHA-256 (FIPS 180-4) of bytes that are added piece by piece. It names the results of a batch, because
// the checksums of 64 bits that files have against damage (provenance.h, the tree format) are too short to identify the
// contents of a million meshes. No library that the program links has this function. About 200 MB a second.
class Sha256 {
 public:
  void add(std::string_view bytes);
  std::string hexadecimal();  // 64 digits; nothing may be added after it

 private:
  void add_block(const unsigned char* block);

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> waiting_{};  // the bytes that fill no block yet
  std::size_t waiting_count_ = 0;
  std::uint64_t length_ = 0;
};

}  // namespace orchard::apps
