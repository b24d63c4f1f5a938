#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "orchard/runtime/broad_phase.h"
#include "simd/vector_support.h"

// How the broad phase and the detector use memory.
namespace orchard::runtime::detail {

// Makes room in a vector that grows one by one. It grows by an eighth, because doubling would leave up to half of the
// memory unused. What is added all at once gets exactly the room that it needs.
template <typename T, typename Allocator>
void make_room(std::vector<T, Allocator>& v, std::size_t size) {
  constexpr std::size_t kMinRoom = 32;
  if (v.capacity() < size) v.reserve(std::max({kMinRoom, size, v.capacity() + v.capacity() / 8}));
}
// Appends one element to a vector that grows by a sixteenth.
template <typename T>
ORCHARD_INLINE void append(std::vector<T>& v, const T& value) {
  if (v.size() == v.capacity()) v.reserve(std::max<std::size_t>(64, v.size() + v.size() / 16));
  v.push_back(value);
}
// Resizes a vector to `size` if it is smaller.
template <typename T, typename Allocator>
void grow(std::vector<T, Allocator>& v, std::size_t size) {
  if (v.size() >= size) return;
  make_room(v, size);
  v.resize(size);
}

// Returns whether each index is one above the one before it.
inline bool successive(std::span<const BodyIndex> bodies) noexcept {
  BodyIndex off = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) off |= bodies[i] ^ (bodies[0] + static_cast<BodyIndex>(i));
  return off == 0;
}

// Calls undo() when it is destroyed, unless done() has been called: for the case that something throws before
// everything is done. (There is no `catch`, because the run-time is also built without exceptions.)
template <typename Undo>
class UndoUnlessDone {
 public:
  explicit UndoUnlessDone(const Undo& undo) : undo_(undo) {}
  UndoUnlessDone(const UndoUnlessDone&) = delete;
  UndoUnlessDone& operator=(const UndoUnlessDone&) = delete;
  ~UndoUnlessDone() {
    if (!done_) undo_();
  }
  void done() noexcept { done_ = true; }

 private:
  Undo undo_;
  bool done_ = false;
};

// Empties a vector and gives its memory back, which assigning {} does not.
template <typename T, typename Allocator>
void give_back(std::vector<T, Allocator>& v) noexcept {
  std::vector<T, Allocator>().swap(v);
}

// Prefetches a cache line that will be written soon. It has to be inlined: GCC takes it for a function without effects,
// and removes the calls that are not inlined by then.
ORCHARD_INLINE void prefetch([[maybe_unused]] const void* where) noexcept {
#ifdef __GNUC__
  __builtin_prefetch(where, 1);
#endif
}

// Prefetches all cache lines of an object.
template <typename T>
ORCHARD_INLINE void prefetch_all(const T& object) noexcept {
  constexpr std::size_t kLine = 64;
  const char* const begin = reinterpret_cast<const char*>(&object);
  for (std::size_t at = 0; at < sizeof(T); at += kLine) prefetch(begin + at);
}

template <typename... Vectors>
std::size_t bytes_of(const Vectors&... vectors) noexcept {
  return ((vectors.capacity() * sizeof(typename Vectors::value_type)) + ...);
}

}  // namespace orchard::runtime::detail
