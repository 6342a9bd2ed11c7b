#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "catalogs.hpp"
#include "random.hpp"
#include "rollfix/identify.hpp"
#include "touch/roll_certificates.hpp"

// Which part is it, by several rolls and touches that share its pose: a small catalog, and rolls on one of its parts.
namespace identify_rolls {

using namespace roll_certificates;
using catalogs::Catalog;
using rollfix::IdentifiedByTouches;
using rollfix::PartTouched;

inline const std::vector<std::string> kShapes = {"ellipse,a=2,b=1",
                                                 "cam",
                                                 "limacon",
                                                 "spline,n=9,wobble=0.2,seed=1",
                                                 "spline,n=9,wobble=0.2,seed=2",
                                                 "spline,n=9,wobble=0.2,seed=3"};
inline constexpr std::size_t kCam = 1, kSpline = 3;

class Identified : public testing::Test {
 protected:
  Identified() : catalog_(catalogs::of(kShapes)) {}

  RollCase rolled(std::size_t part, std::size_t rolls, std::size_t touches, std::uint64_t seed, double noise = 1) {
    std::mt19937_64 generator = test_generator(seed);
    Rolling rolling;
    rolling.count = rolls;
    rolling.touches = touches;
    rolling.length = 0.06;
    rolling.rows = 15;
    rolling.contact_sd = rolling.place_sd = 0.001 * noise;
    rolling.angle_sd = 0.005 * noise;
    return random_rolls(catalog_.part(part), rolling, generator);
  }
  std::vector<std::string> names_of(const IdentifiedByTouches& found) const {
    std::vector<std::string> names;
    for (const PartTouched& part : found.parts) names.push_back(catalog_.entry(part.part).name);
    return names;
  }
  std::string all_of(const IdentifiedByTouches& found) const {
    cli::Json document = cli::Json::parse(format_identified(catalog_, found));
    document["catalog"].erase("searched");
    return document.dump();
  }
  void expect_no_loss(const TouchProblem& problem) const {
    rollfix::IdentifyOptions without;
    without.use_index = false;
    EXPECT_EQ(all_of(identify(catalog_, problem)), all_of(identify(catalog_, problem, without)));
  }

  cli::Folder folder_;
  Catalog catalog_;
};

}  // namespace identify_rolls
