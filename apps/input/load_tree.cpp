#include "input/load_tree.h"

#include "orchard/geometry/error.h"
#include "orchard/runtime/tree_file.h"

namespace orchard::apps {

runtime::PackedSphereTree load_tree(const std::filesystem::path& file) {
  runtime::PackedSphereTree tree;
  const auto status = runtime::load_file(file.c_str(), tree);
  if (status != runtime::LoadStatus::ok)
    throw InputError(file.string() + ": " + runtime::message(status) + "; make one with \"orchard build\"");
  return tree;
}

}  // namespace orchard::apps
