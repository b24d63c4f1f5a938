#include "label_layout.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "orchard/geometry/random.h"

namespace orchard::detail {
namespace {

using Eigen::Vector2d;
using Box2 = Eigen::AlignedBox2d;

Box2 box_of(const PlacedWord& word) { return {word.middle - 0.5 * word.size, word.middle + 0.5 * word.size}; }

void expect_readable(const std::vector<PlacedWord>& words, const Box2& room) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    EXPECT_TRUE(room.contains(box_of(words[i]))) << i;
    for (std::size_t j = 0; j < words.size(); ++j) {
      EXPECT_FALSE(box_of(words[i]).contains(words[j].anchor)) << i << " covers the place of " << j;
      EXPECT_TRUE(i == j || box_of(words[i]).intersection(box_of(words[j])).isEmpty()) << i << " and " << j;
    }
  }
}

TEST(LabelLayout, NoWordCoversAnotherOneOrAPlace) {
  const Box2 room(Vector2d(0, 40), Vector2d(600, 500));
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed, 2, 1);
    std::vector<PlacedWord> words;
    for (int i = 0; i < 24; ++i)
      words.push_back({.anchor = Vector2d(60 + 480 * random.uniform(), 100 + 340 * random.uniform()),
                       .size = Vector2d(i < 9 ? 22 : 32, 20)});
    place_words(words, room.min(), room.max(), {300, 270});
    expect_readable(words, room);
  }
}

TEST(LabelLayout, PlacesAtOnePointFanOut) {
  const Box2 room(Vector2d(0, 0), Vector2d(400, 400));
  std::vector<PlacedWord> words(8, PlacedWord{.anchor = Vector2d(200, 200), .size = Vector2d(25, 20)});
  place_words(words, room.min(), room.max(), {200, 200});
  expect_readable(words, room);
}

TEST(LabelLayout, PlacesAtTheSidesHaveWordsInside) {
  const Box2 room(Vector2d(0, 50), Vector2d(300, 300));
  std::vector<PlacedWord> words;
  for (const Vector2d& corner : {Vector2d(0, 50), Vector2d(300, 50), Vector2d(0, 300), Vector2d(300, 300)})
    words.push_back({.anchor = corner, .size = Vector2d(25, 20)});
  place_words(words, room.min(), room.max(), {150, 150});
  expect_readable(words, room);
}

}  // namespace
}  // namespace orchard::detail
