// Bytes become lines, however they are cut into pieces, and nothing that comes can fill the memory.
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "random.hpp"
#include "rollfix/watch_limit.hpp"
#include "rollfix/watch_line_buffer.hpp"

namespace watch_lines_test {

namespace {

using rollfix::app::kLongestLine;
using rollfix::app::LineBuffer;
using rollfix::app::NoteLimit;

/// All lines that are complete; "..." instead of one that is too long.
void take_lines(LineBuffer& buffer, std::vector<std::string>& lines) {
  while (const auto line = buffer.next()) lines.emplace_back(line->too_long ? "..." : std::string(line->text));
}

std::vector<std::string> lines_of(const std::vector<std::string>& pieces) {
  LineBuffer buffer;
  std::vector<std::string> lines;
  for (const std::string& piece : pieces) {
    buffer.append(piece);
    take_lines(buffer, lines);
  }
  if (const auto line = buffer.last()) lines.emplace_back(line->text);
  return lines;
}

using Lines = std::vector<std::string>;

}  // namespace

TEST(WatchLines, are_cut_at_either_kind_of_line_end) {
  EXPECT_EQ(lines_of({"a\nb\r\n\nc\r\n"}), (Lines{"a", "b", "", "c"}));
}

TEST(WatchLines, wait_for_their_end) { EXPECT_EQ(lines_of({"1,", "2", "\n3\r", "\n", "4"}), (Lines{"1,2", "3", "4"})); }

TEST(WatchLines, do_not_depend_on_the_pieces_they_come_in) {
  std::mt19937_64 random(test_seed());
  std::uniform_int_distribution<int> length(0, 6);
  for (int count = test_count(50); count > 0; --count) {
    Lines expected;
    Lines pieces;
    for (int k = 0; k < 30; ++k) {
      expected.emplace_back(static_cast<std::size_t>(length(random)), 'x');
      for (const char c : expected.back() + "\n") {
        if (pieces.empty() || length(random) == 0) pieces.emplace_back();
        pieces.back() += c;
      }
    }
    EXPECT_EQ(lines_of(pieces), expected);
  }
}

TEST(WatchLines, that_are_too_long_are_told_once_and_not_kept) {
  const std::string half(kLongestLine / 2 + 1, 'x');
  EXPECT_EQ(lines_of({"a\n", half, half, half, half + "\nb\n"}), (Lines{"a", "...", "b"}));
  EXPECT_EQ(lines_of({"a\n" + half + half + "\nb\n"}), (Lines{"a", "...", "b"}));
  EXPECT_EQ(lines_of({half + half, half}), (Lines{"..."}));
}

TEST(WatchLines, that_have_begun_can_be_given_up) {
  LineBuffer buffer;
  buffer.append("a\nhalf a li");
  Lines lines;
  take_lines(buffer, lines);
  buffer.drop_partial();
  buffer.append("b\n");
  take_lines(buffer, lines);
  EXPECT_EQ(lines, (Lines{"a", "b"}));
}

TEST(WatchNotes, are_let_through_a_few_at_once_and_then_now_and_then) {
  NoteLimit limit;
  const auto start = rollfix::app::Clock::now();
  for (std::size_t k = 0; k < NoteLimit::kAtOnce; ++k) EXPECT_EQ(limit.allow(start), 0U);
  for (int k = 0; k < 7; ++k) EXPECT_EQ(limit.allow(start), std::nullopt);
  EXPECT_EQ(limit.allow(start + NoteLimit::kOneMoreEvery), 7U);
  EXPECT_EQ(limit.allow(start + NoteLimit::kOneMoreEvery), std::nullopt);
  EXPECT_EQ(limit.allow(start + 100 * NoteLimit::kOneMoreEvery), 1U);
}

}  // namespace watch_lines_test
