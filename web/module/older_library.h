#pragma once
#include <bit>
#include <memory>
#include <version>

// The C++ library of Debian 12's Emscripten has all of C++20 that the run-time uses but these.
namespace std {
#ifndef __cpp_lib_bit_cast
template <typename To, typename From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}
#endif
#ifndef __cpp_lib_smart_ptr_for_overwrite
template <typename T>
unique_ptr<T> make_unique_for_overwrite() {
  return unique_ptr<T>(new T);
}
#endif
}  // namespace std
