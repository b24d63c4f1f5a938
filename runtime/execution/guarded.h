#pragma once

namespace orchard::runtime::detail {

// Returns what work() returns or, if there is no memory for it, what otherwise() returns, which must not allocate.
// Without exceptions (-fno-exceptions), lack of memory ends the program, as it does everywhere in such programs.
template <typename Work, typename Otherwise>
auto guarded(const Work& work, const Otherwise& otherwise) noexcept -> decltype(work()) {
#if defined(__cpp_exceptions) || defined(_CPPUNWIND)
  try {
    return work();
  } catch (...) {  // std::bad_alloc; nothing else is thrown
    return otherwise();
  }
#else
  (void)otherwise;
  return work();
#endif
}

// Returns what make() returns, or `otherwise` if there is no memory for it.
template <typename Result, typename Make>
Result made_or(const Result& otherwise, const Make& make) noexcept {
  return guarded([&]() -> Result { return make(); }, [&] { return otherwise; });
}

}  // namespace orchard::runtime::detail
