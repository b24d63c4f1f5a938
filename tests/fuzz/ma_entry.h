#pragma once
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "ma_text.h"
#include "orchard/geometry/error.h"

namespace orchard::test {

// What the reader of .ma files owes to any bytes at all: a valid medial mesh no larger than the bytes can make it,
// which reads back the same from what is written of it, or InputError with one line that begins with the file's name.
// Anything else leaves as another exception. Returns whether there is a mesh.
inline bool read_ma_bytes(const std::uint8_t* data, std::size_t size) {
  const auto parse = [](std::string text) { return detail::parse_ma(TextLines("bytes", std::move(text))); };
  FlaggedMedialMesh flagged;
  try {
    flagged = parse({reinterpret_cast<const char*>(data), size});
  } catch (const InputError& error) {
    const std::string_view message = error.what();
    const bool named = message.starts_with("bytes, line ") || message.starts_with("bytes: the file is empty");
    if (!named || message.find('\n') != message.npos || message.size() > 300)
      throw std::logic_error("not a message to show to a user: " + std::string(message));
    return false;
  }
  const MedialMesh mesh = without_deleted(flagged);
  try {
    validate(flagged.mesh);
    validate(mesh);
  } catch (const InputError& error) {
    throw std::logic_error("the reader let through what validate() refuses: " + std::string(error.what()));
  }
  if (flagged.mesh.centers.size() > size || flagged.mesh.edges.size() > size)
    throw std::logic_error("larger than its file");
  const std::string text = to_ma(flagged);
  if (to_ma(parse(text)) != text || to_ma(without_deleted(parse(text))) != to_ma(mesh))
    throw std::logic_error("what is written reads back as something else");
  return true;
}

}  // namespace orchard::test
