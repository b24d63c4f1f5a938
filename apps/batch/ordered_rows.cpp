#include "batch/ordered_rows.h"

#include <utility>

#include "orchard/geometry/error.h"

namespace orchard::apps {

OrderedRows::OrderedRows(std::filesystem::path file) : file_(std::move(file)), out_(file_, std::ios::binary) {
  check();
}

void OrderedRows::check() {
  if (!out_) throw Error(file_.string() + ": cannot be written");
}

void OrderedRows::add(std::size_t place, const nlohmann::ordered_json& row) {
  waiting_[place] = row.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  for (auto first = waiting_.begin(); first != waiting_.end() && first->first == next_; ++next_) {
    out_ << first->second << '\n';
    first = waiting_.erase(first);
  }
  out_.flush();
  check();
}

void OrderedRows::close() {
  out_.close();
  check();
}

}  // namespace orchard::apps
