#pragma once
#include <Eigen/Core>
#include <vector>

namespace orchard::detail {

// A word and the place that it belongs to, in pixels from the lower left corner of a picture.
struct PlacedWord {
  Eigen::Vector2d anchor;                            // the place
  Eigen::Vector2d size;                              // of the word
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  // of the word, chosen by place_words()
};

// Puts each word near its anchor so that none covers another word or an anchor, and none crosses the edge of the
// rectangle from `low` to `high`; the lines from anchors to words do not cross words either. Words are pushed away from
// `center`, so that they are beside what is drawn there rather than in front of it. Where the room does not suffice, a
// word goes where it covers the least. The time grows with the square of the number of words.
void place_words(std::vector<PlacedWord>& words, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                 const Eigen::Vector2d& center);

}  // namespace orchard::detail
