#include "detector/part_search.h"

#include <algorithm>

namespace orchard::runtime::detail {

void PartSearch::begin(BodyIndex body, const BodyTable& table) {
  if (bodies_.empty()) {
    for (BodyIndex i = 0; i < table.slots(); ++i) {
      if (table[i].id != kNoBody && table[i].is_static) spheres_.put(i, table.float_part_spheres(i));
    }
  }
  bodies_.insert(std::lower_bound(bodies_.begin(), bodies_.end(), body), body);
}

void PartSearch::end(BodyIndex body) noexcept {
  std::erase(bodies_, body);
  if (bodies_.empty()) spheres_ = {};
}

void PartSearch::static_changed(BodyIndex body, const BodyTable& table) {
  if (any()) spheres_.put(body, table.float_part_spheres(body));
}

void PartSearch::static_gone(BodyIndex body) noexcept {
  if (any()) spheres_.take_away(body);
}

std::span<const BodyIndex> PartSearch::touching(BodyIndex body, const BodyTable& table) {
  spheres_.prepare();
  found_.clear();
  for (const FloatSphere& sphere : table.float_part_spheres(body)) spheres_.append_touching(sphere, found_);
  std::sort(found_.begin(), found_.end());
  found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
  return found_;
}

std::size_t PartSearch::count_touching(const FloatSphere& sphere) {
  spheres_.prepare();
  found_.clear();
  spheres_.append_touching(sphere, found_);
  return found_.size();
}

std::size_t PartSearch::memory_bytes() const noexcept {
  return bytes_of(bodies_) + bytes_of(found_) + spheres_.memory_bytes();
}

}  // namespace orchard::runtime::detail
