// Planted pairs on every smooth closed family of the gallery: theta from the turning function, which the march does not
// know.

#include "march_families.hpp"
#include "march_pairs.hpp"
#include "random.hpp"
#include "rollfix/part.hpp"
#include "shapes.hpp"

namespace march_pairs_gallery_test {
namespace {

using namespace rollfix;
using march::PairMarch;
using march::PairResult;
using march_pairs::Planted;

class MarchPairsGallery : public testing::TestWithParam<std::string> {
 protected:
  Outline outline_ = gallery(GetParam());
  Part part_{outline_};
  PairMarch march_{part_.outline()};

  double phi(double s, double length) const { return shapes::reading_from(part_, s, length).turn; }
  Planted planted(std::mt19937_64& generator) const {
    return {part_.perimeter(), [this](double s, double length) { return phi(s, length); }, generator};
  }
};

INSTANTIATE_TEST_SUITE_P(Gallery, MarchPairsGallery,
                         testing::ValuesIn(march_families::with_others(march_families::kOfTwoFingers)),
                         shapes::as_identifier);

TEST(MarchFamilies, of_two_fingers_are_all_that_the_march_takes) {
  const auto march = [](const Outline& outline) { PairMarch{outline}; };
  EXPECT_EQ(march_families::taken_by(march), march_families::kOfTwoFingers);
}

TEST_P(MarchPairsGallery, planted_pairs_are_found_and_what_is_found_fits) {
  auto generator = test_generator(81);
  int doubtful = 0;
  for (int i = 0; i < test_count(10); ++i) {
    const Planted planted = this->planted(generator);
    SCOPED_TRACE(march_pairs::trace_of(GetParam(), planted.readings));
    const PairResult result = march_pairs::march(march_, planted.readings);
    const bool found = march_pairs::lists(result, planted.at, part_.perimeter());
    EXPECT_TRUE(found || march_pairs::doubts(result, planted.at, part_.perimeter()));
    doubtful += found ? 0 : 1;
    for (const auto& pair : result.pairs) {
      for (const Reading& reading : planted.readings) {
        EXPECT_NEAR(phi(pair.s, reading.length[0]) - phi(pair.t, reading.length[1]), reading.turn, 1e-7);
      }
    }
  }
  EXPECT_LE(doubtful, 1 + test_count(10) / 50);
}

}  // namespace
}  // namespace march_pairs_gallery_test
