#pragma once

namespace orchard::runtime::detail {

// What `work` gives; or, where there is no memory for it, what `otherwise` does, which allocates nothing. Where
// exceptions are off (-fno-exceptions) lack of memory ends the program, as it does everywhere in such a one.
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

// What `make` gives, or `otherwise` if there is no memory for it.
template <typename Result, typename Make>
Result made_or(const Result& otherwise, const Make& make) noexcept {
  return guarded([&]() -> Result { return make(); }, [&] { return otherwise; });
}

}  // namespace orchard::runtime::detail
