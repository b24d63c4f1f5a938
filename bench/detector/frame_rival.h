#pragma once
#include <memory>
#include <string>

#include "scenes.h"

// Other libraries' whole frames: all bodies are moved, then all pairs that touch are found and counted.
namespace orchard::bench {

// After the first step it need not be looked at: it stays where it is permanently.
inline bool stays(const runtime::test::SceneBody& body) {
  const runtime::test::SceneBody always;
  return body.is_static && body.birth == always.birth && body.death == always.death;
}

class FrameRival {
 public:
  virtual ~FrameRival() = default;
  virtual std::string name() const = 0;
  virtual std::size_t step(int step) = 0;  // how many pairs touch
};

// A part of a body is an object of its own; parts of one body are never tested, nor are static bodies against each
// other. Null where the library is not installed.
std::unique_ptr<FrameRival> fcl_frames_double(const runtime::test::Scene& scene);
std::unique_ptr<FrameRival> fcl_frames_float(const runtime::test::Scene& scene);
std::unique_ptr<FrameRival> bullet_frames(const runtime::test::Scene& scene);

}  // namespace orchard::bench
