#pragma once
#include <cstddef>
#include <vector>

namespace orchard::detail {

// Asks the operating system to map memory by large pages, because mapping it page by page takes longer than filling it.
// If the system cannot do that, nothing changes. If large pages take longer than as many small ones would, which
// happens when a virtual machine has to get unused memory from its host, small pages stay. Call this before the memory
// is written to, and only for memory that will be filled: up to 2 MB at either end may be allocated in addition.
void use_large_pages(void* begin, std::size_t bytes);

// Reserves room for `count` items of an empty vector, all of which will be filled.
template <class Item>
void reserve_large(std::vector<Item>& items, std::size_t count) {
  items.reserve(count);
  use_large_pages(items.data(), count * sizeof(Item));
}

}  // namespace orchard::detail
