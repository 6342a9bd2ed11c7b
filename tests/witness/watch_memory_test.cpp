// rollfix watch takes no more memory for a longer log. Not under the address sanitizer, which keeps what was freed.
#include <gtest/gtest.h>

#include "cli.hpp"
#include "watch_child.hpp"
#include "watch_logs.hpp"

namespace watch_memory_test {
namespace {

using cli::Json;
using watching::Child;
using watching::kHeader;
using watching::kOptions;
using watching::noisy_rows;
using watching::words_of;

/// The most memory that a log of so many rows takes, bytes.
long memory_for(std::size_t rows) {
  Child child(words_of("watch " + kOptions + "--jsonl --every 1000000"));
  child.send(kHeader + "\n");
  const std::vector<std::string> roll = noisy_rows(2, 3, 1000);
  for (std::size_t k = 0; k < rows; k += roll.size()) {
    std::string text;
    // The finger stays where it is in the end, as long as it takes; a line in ten can't be read.
    const std::string psi = roll.back().substr(roll.back().find(','));
    for (std::size_t i = 0; i < roll.size(); ++i) {
      text += k == 0 ? roll[i] + "\n" : i % 10 == 0 ? "?,?\n" : std::to_string(1000 + k + i) + psi + "\n";
    }
    child.send(text);
  }
  child.close_input();
  const Json end = child.next_event("end");
  EXPECT_EQ(end["counts"]["lines"], rows + 1);
  EXPECT_GT(end["counts"]["samples"].get<std::size_t>(), rows / 10 * 9);
  EXPECT_EQ(child.wait(), 0);
  return child.peak_memory();
}

constexpr long kMegabyte = 1024 * 1024;

}  // namespace

TEST(WatchProgram, needs_no_more_memory_for_a_longer_log) {
  EXPECT_LT(memory_for(200000), memory_for(20000) + 2 * kMegabyte);
}

TEST(WatchProgram, slow_needs_no_more_memory_for_a_million_rows) {
  EXPECT_LT(memory_for(1000000), memory_for(20000) + 2 * kMegabyte);
}

}  // namespace watch_memory_test
