#include "orchard/geometry/text_lines.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "expect_input_error.h"

namespace orchard {
namespace {

// Short texts live inside a std::string, long ones outside: copies and moves of the two go wrong in different ways.
std::string text_of(std::size_t lines) {
  std::string text = "a 1 2\n";
  for (std::size_t i = 1; i < lines; ++i) text += "b " + std::to_string(i) + " 2\n";
  return text;
}

void expect_rest(TextLines& lines, std::size_t count) {
  EXPECT_EQ(lines.index(), 2u);
  for (std::size_t i = 1; i < count; ++i) {
    ASSERT_NO_THROW(lines.expect("b")) << i;
    EXPECT_EQ(lines.index(), i);
    EXPECT_EQ(lines.index(), 2u);
  }
  EXPECT_FALSE(lines.next());
}

TEST(TextLines, ReadOnInACopyAfterTheOriginalIsGone) {
  for (const std::size_t count : {1u, 2u, 500u}) {
    auto original = std::make_unique<TextLines>("text", text_of(count));
    original->expect("a");
    EXPECT_EQ(original->index(), 1u);
    TextLines copy = *original, assigned("other", "1 2 3\n");
    assigned = *original;
    original = std::make_unique<TextLines>("other", std::string(count * 8, '7'));
    const std::string overwritten(count * 8, '9');  // where the text was, if it was freed
    expect_rest(copy, count);
    expect_rest(assigned, count);
  }
}

TEST(TextLines, ReadOnWhereTheyWereMovedTo) {
  for (const std::size_t count : {1u, 2u, 500u}) {
    std::optional<TextLines> original(std::in_place, "text", text_of(count));
    original->expect("a");
    EXPECT_EQ(original->index(), 1u);
    TextLines moved = std::move(*original);
    original.emplace("other", std::string(14, '7'));
    expect_rest(moved, count);
  }
}

TEST(TextLines, ReadOnInTheOriginalApartFromItsCopy) {
  TextLines original("text", text_of(3));
  original.expect("a");
  TextLines copy = original;
  EXPECT_EQ(original.index(), 1u);
  expect_rest(original, 3);
  EXPECT_EQ(copy.index(), 1u);
  expect_rest(copy, 3);
}

TEST(TextLines, GiveWholeNumbersToTheEndOrNothing) {
  const struct {
    const char* line;
    std::size_t count;
    std::array<std::int64_t, 2> numbers;
  } cases[] = {{"x", 0, {}},       {"x  \t\r", 0, {}},
               {"x 3", 1, {3, 0}}, {"x -1 0\r", 2, {-1, 0}},
               {"x 1 2 3", 0, {}}, {"x 1 2.5", 0, {}},
               {"x 1 # 2", 0, {}}, {"x1 2", 2, {1, 2}},
               {"x 1,2", 0, {}},   {"x 99999999999999999999", 0, {}}};
  for (const auto& [line, count, numbers] : cases) {
    TextLines lines("text", line);
    lines.expect("x");
    std::array<std::int64_t, 2> found{};
    ASSERT_EQ(lines.whole_numbers_to_the_end(found), count) << line;
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(found.at(i), numbers.at(i)) << line;
  }
  TextLines kept("text", "x 1 y");
  kept.expect("x");
  std::array<std::int64_t, 2> unused{};
  EXPECT_EQ(kept.whole_numbers_to_the_end(unused), 0u);
  EXPECT_EQ(kept.index(), 1u);
}

TEST(TextLines, TakeNumbersInAnyFormOfC) {
  TextLines lines("text", "+3 -7 +2.5e1 1e-999 .5\n");
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.index(), 3u);
  EXPECT_EQ(lines.whole(), -7);
  EXPECT_EQ(lines.real(), 25);
  EXPECT_EQ(lines.real(), 0) << "too small for a double";
  EXPECT_EQ(lines.real(), 0.5);
  test::expect_input_error([&] { lines.real("a radius"); },
                           {"text, line 1", "expected a radius at the end of the line"});
}

TEST(TextLines, RefuseNumbersThatDoNotFit) {
  for (const char* number : {"-1", "4294967296", "99999999999999999999", "+-1", "x"}) {
    TextLines lines("text", number);
    ASSERT_TRUE(lines.next());
    test::expect_input_error([&] { lines.index(); }, {"text, line 1", '"' + std::string(number) + '"'});
  }
  TextLines large("text", "1e999 inf");
  ASSERT_TRUE(large.next());
  test::expect_input_error([&] { large.real(); }, {"text, line 1", "expected a number at"});
  test::expect_input_error([] { TextLines("text", "").fail("is empty"); }, {"text: is empty"});
}

TEST(TextLines, ShowOnlyPrintableTextInTheirMessages) {
  TextLines lines("text", "\x01\x02 strange\n");
  ASSERT_TRUE(lines.next());
  test::expect_input_error([&] { lines.real(); }, {"text, line 1", "\"?? strange\""});
}

}  // namespace
}  // namespace orchard
