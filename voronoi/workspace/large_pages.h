#pragma once
#include <cstddef>
#include <vector>

namespace orchard::detail {

// Asks the system to map memory that will be filled by large pages: mapping it page by page takes longer than to fill
// it. Where it cannot, nothing changes; and where it takes longer than as many small pages would, for a virtual machine
// has to get what it has not used for a while from its host, small pages stay. To be called before the memory is
// written to, and for what will be filled only: up to 2 MB at either end may be taken otherwise.
void use_large_pages(void* begin, std::size_t bytes);

// Room for so many items of an empty vector, all of which will be filled.
template <class Item>
void reserve_large(std::vector<Item>& items, std::size_t count) {
  items.reserve(count);
  use_large_pages(items.data(), count * sizeof(Item));
}

}  // namespace orchard::detail
