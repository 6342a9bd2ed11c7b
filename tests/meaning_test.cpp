// Of a roll that does not end a watch keeps samples that are spread over all of it.
#include <gtest/gtest.h>

#include <memory>

#include "catalog/on_catalog.hpp"
#include "catalogs.hpp"
#include "rollfix/outline.hpp"
#include "watch/meaning.hpp"

namespace meaning_test {
namespace {

TEST(KeptSamples, are_every_so_many_of_the_whole_roll) {
  const rollfix::Part part(rollfix::gallery("cam"));
  rollfix::KeptSamples kept;
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

/// Increments of a roll from s = 1, added up.
rollfix::Sample summed(const rollfix::Part& part, double length) {
  rollfix::Sample sample;
  sample.reading = {length, part.turning().angle(1 + length) - part.turning().angle(1)};
  sample.finger_curvature = 0.0;
  return sample;
}

double sd_of(const rollfix::Identified& found) {
  return found.parts.size() == 1 ? found.parts[0].answer.placements.at(0).sd[0] : std::nan("");
}

TEST(KeptSamples, of_increments_leave_the_place_as_sure_as_all_of_them) {
  const cli::Folder folder;
  const auto catalog = std::make_shared<const rollfix::Catalog>(catalogs::of({"cam"}));
  const rollfix::Followed followed{catalog->part(0), {}, {1e-6, 1e-4}, {}};
  const rollfix::Part& part = followed.part;
  rollfix::Log all;
  all.kind = rollfix::LogKind::increments;
  const auto kept = rollfix::catalog::meaning_on_catalog(catalog, followed, all.kind);
  for (int row = 0; row < 5000; ++row) {
    const rollfix::Sample sample = summed(part, 0.0005 * row);
    kept->add(sample);
    all.fingers[0].length.push_back(sample.reading.length[0]);
    all.fingers[0].turn.push_back(sample.reading.turn);
  }
  rollfix::Tracked answer;
  kept->conclude(answer, true);
  const double sd = sd_of(rollfix::identify(*catalog, {part, all, {}, followed.noise}));
  EXPECT_NEAR(sd_of(*answer.parts), sd, 0.02 * sd);
}

}  // namespace
}  // namespace meaning_test
