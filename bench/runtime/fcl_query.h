#pragma once
#include <memory>

#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"

// FCL's OBBRSS trees in float, compiled from its headers (twice as fast as the double ones of the library).
namespace orchard::bench {

class FclPair {
 public:
  FclPair(const runtime::PackedSphereTree& a, const runtime::PackedSphereTree& b);  // the triangles that they store
  ~FclPair();
  bool collide(const runtime::Pose& a, const runtime::Pose& b) const;

 private:
  struct Models;
  std::unique_ptr<Models> models_;
};

}  // namespace orchard::bench
