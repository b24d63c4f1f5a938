#pragma once
#include <Eigen/Core>
#include <vector>

namespace orchard::detail {

// A word and the place that it describes, in pixels from the lower left corner of a picture.
struct PlacedWord {
  Eigen::Vector2d anchor;                            // the place
  Eigen::Vector2d size;                              // of the word
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  // of the word, chosen by place_words()
};

// Places each word near its anchor so that it covers no other word and no anchor, and does not cross the edge of the
// rectangle from `low` to `high`. Lines from anchors to words do not cross words either. Words are pushed away from
// `center`, so that they are next to the model rather than in front of it. If there is not enough room, a word is
// placed where it covers least. The time is quadratic in the number of words.
void place_words(std::vector<PlacedWord>& words, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                 const Eigen::Vector2d& center);

}  // namespace orchard::detail
