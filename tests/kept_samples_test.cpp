// Of a roll that does not end a watch keeps samples that are spread over all of it.
#include <gtest/gtest.h>

#include "rollfix/outline/gallery.hpp"
#include "rollfix/watch/meaning.hpp"

namespace kept_samples_test {
namespace {

TEST(KeptSamples, are_every_so_many_of_the_whole_roll) {
  const rollfix::Part part(rollfix::gallery("cam"));
  rollfix::app::KeptSamples kept;
  const std::size_t rows = 100'000;
  for (std::size_t k = 0; k < rows; ++k) {
    rollfix::Sample sample;
    sample.reading = rollfix::Reading(static_cast<double>(k), 0);
    kept.add(sample);
  }
  const rollfix::Log log = kept.log(rollfix::LogKind::travelled, part);
  const std::vector<double>& lengths = log.fingers[0].length;
  ASSERT_GT(kept.each(), 1U);
  ASSERT_EQ(lengths.size(), (rows + kept.each() - 1) / kept.each());
  for (std::size_t k = 0; k < lengths.size(); ++k) EXPECT_EQ(lengths[k], static_cast<double>(k * kept.each()));
}

}  // namespace
}  // namespace kept_samples_test
