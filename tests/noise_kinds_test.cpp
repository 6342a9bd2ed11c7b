#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "refusal.hpp"
#include "roll/noise.hpp"

// Which kinds of noise a problem takes: those that it names, so that a new one is refused until somebody has thought of
// it.
namespace noise_kinds_test {

using rollfix::kNoiseKinds;
using rollfix::Noise;
using rollfix::NoiseKind;
using rollfix::require_kinds;
using testing::HasSubstr;

TEST(NoiseKinds, that_are_not_named_are_refused_one_by_one) {
  for (const NoiseKind& kind : kNoiseKinds) {
    Noise noise;
    noise.*kind.sd = 0.1;
    if (kind.sd == &Noise::position || kind.sd == &Noise::angle) {
      EXPECT_NO_THROW(require_kinds(noise, {&Noise::position, &Noise::angle}, "touches")) << kind.name;
      continue;
    }
    EXPECT_EQ(refusal_of([&] {
                require_kinds(noise, {&Noise::position, &Noise::angle}, "touches");
              }),
              "noise of touches is position and angle, found " + std::string(kind.name) + "=0.1; leave it out");
  }
}

TEST(NoiseKinds, of_none_are_taken_by_everybody) {
  EXPECT_NO_THROW(require_kinds({}, {&Noise::angle, &Noise::slip}, "none"));
}

}  // namespace noise_kinds_test
