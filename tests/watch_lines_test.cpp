// Bytes become lines, however they are cut into pieces, and nothing that comes can fill the memory.
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "cli.hpp"
#include "random.hpp"
#include "watch_helpers.hpp"

namespace watch_lines_test {

namespace {

using rollfix::app::kLongestLine;
using watching::Ear;

using Lines = std::vector<std::string>;

/// What is heard of them, each read by itself.
Lines lines_of(const Lines& pieces) {
  watching::Pipe pipe;
  ::fcntl(pipe.in.number(), F_SETPIPE_SZ, 1 << 20);
  Ear ear(pipe.out.number());
  for (const std::string& piece : pieces) {
    watching::write_all(pipe.in, piece);
    ear.listen();
  }
  pipe.in.close();
  Lines lines;
  for (std::string line = ear.next(); line != "(ended)"; line = ear.next()) lines.push_back(line);
  return lines;
}

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
  EXPECT_EQ(lines_of({"a\n", half, half, half, half + "\nb\n"}), (Lines{"a", "(too long)", "b"}));
  EXPECT_EQ(lines_of({"a\n" + half + half + "\nb\n"}), (Lines{"a", "(too long)", "b"}));
  EXPECT_EQ(lines_of({half + half, half}), (Lines{"(too long)"}));
}

TEST(WatchLines, that_are_too_long_end_with_their_connection) {
  const cli::Folder folder;
  watching::require(::mkfifo("roll", 0600) == 0, "mkfifo");
  Ear ear("roll");
  watching::Descriptor writer = watching::writer_of("roll");
  ::fcntl(writer.number(), F_SETPIPE_SZ, 1 << 20);
  watching::write_all(writer, "a\n" + std::string(2 * kLongestLine, 'x'));
  EXPECT_EQ(ear.next(), "a");
  EXPECT_EQ(ear.next(), "(too long)");
  writer.close();
  EXPECT_EQ(ear.next(), "(dropped)");
  writer = watching::writer_of("roll");
  watching::write_all(writer, "b\n");
  EXPECT_EQ(ear.next(), "(resumed)");
  EXPECT_EQ(ear.next(), "b");
}

}  // namespace watch_lines_test
