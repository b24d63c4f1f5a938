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
template <typename T>
void append(std::vector<T>& v, const T& value) {
  if (v.size() == v.capacity()) v.reserve(std::max<std::size_t>(64, v.size() + v.size() / 16));
  v.push_back(value);
}
template <typename T, typename Allocator>
void grow(std::vector<T, Allocator>& v, std::size_t size) {
  if (v.size() >= size) return;
  make_room(v, size);
  v.resize(size);
}

// Whether each index is one above that before it.
inline bool successive(std::span<const BodyIndex> bodies) noexcept {
  BodyIndex off = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) off |= bodies[i] ^ (bodies[0] + static_cast<BodyIndex>(i));
  return off == 0;
}

// Undoes what has been done so far, unless all of it has been: what is between throws. (No `catch`: the run-time is
// built without exceptions as well.)
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

// Starts loading what will be written soon. Part of its caller at once: GCC takes it for a function without effects,
// and leaves out what calls are left when it has found that.
ORCHARD_INLINE void prefetch(const void* where) noexcept {
#ifdef __GNUC__
  __builtin_prefetch(where, 1);
#else
  (void)where;
#endif
}

// All lines of an object.
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
