#pragma once
#include <string>

#include "medial/medial_tuning.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/quality.h"

namespace orchard::apps {

// How an axis came about, as far as it says what can be done about it.
struct AxisOrigin {
  const MedialTuning* tuning = nullptr;  // with which this program built it; null: a file, and nothing here tunes it
  bool own_points = false;               // the surface points are the user's, or those of a diagram of theirs
  bool cuts_itself = false;              // the mesh does
};

// What to do about a place, in a few words.
struct Advice {
  std::string text;
  std::string option = {}, value = {};  // that the words suggest; empty: no single option
};

// What to do about a place where the axis is bad: an option with a value where one helps.
Advice advice(const WorstPlace& place, const Surface& surface, const AxisOrigin& origin);

}  // namespace orchard::apps
