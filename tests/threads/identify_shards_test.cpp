// Shards of one search that know the likeliest part of all, and look widely only where none fits well, merge to the
// same answer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "catalogs.hpp"
#include "random.hpp"
#include "refusal.hpp"
#include "rollfix/catalog/documents.hpp"
#include "rollfix/error.hpp"

namespace identify_shards_test {
namespace {

using namespace catalogs;

constexpr std::size_t kShards = 4;

class Shards : public testing::Test {
 protected:
  Shards() : catalog_(of(mixed_shapes(11))), random_(test_generator()) {}

  /// Thirty readings over half of a part; off by so many times the noise that is said, contact as a share of P.
  Problem roll_on_some_part(double off, const Noise& noise = {2e-4, 0.004}) {
    std::normal_distribution<double> normal;
    const Part part = catalog_.part(std::uniform_int_distribution<std::size_t>(0, catalog_.size() - 1)(random_));
    const double P = part.perimeter();
    std::vector<double> lengths;
    for (int row = 1; row <= 30; ++row) lengths.push_back(0.5 * P * row / 30);
    Problem problem{part, roll_on(part, std::uniform_real_distribution<double>(0, 0.4 * P)(random_), lengths)};
    problem.noise = Noise{noise.contact * P, noise.angle};
    for (Reading& reading : problem.felt.readings) {
      reading.length[0] += off * problem.noise->contact * normal(random_);
      reading.turn += off * problem.noise->angle * normal(random_);
    }
    return problem;
  }

  std::vector<Identified> in_shards(const Problem& problem, IdentifyOptions options) {
    std::vector<Identified> shards;
    options.shards = kShards;
    for (options.shard = 1; options.shard <= kShards; ++options.shard)
      shards.push_back(identify(catalog_, problem, options));
    return shards;
  }

  std::string merged(const std::vector<Identified>& shards) {
    std::vector<std::string> texts;
    for (std::size_t k = 0; k < shards.size(); ++k) {
      IdentifyOptions options;
      options.shard = k + 1;
      options.shards = kShards;
      texts.push_back(format_shard(catalog_, shards[k], options));
    }
    return merge_shards(catalog_, texts, {"1", "2", "3", "4"});
  }

  /// The likeliest of what each shard holds for the likeliest.
  std::optional<PartWeight> rival_of(const Problem& problem) {
    std::vector<PartWeight> likely;
    IdentifyOptions options;
    options.shards = kShards;
    for (options.shard = 1; options.shard <= kShards; ++options.shard) {
      if (const std::optional<PartWeight> one = likeliest(catalog_, problem, options)) likely.push_back(*one);
    }
    if (likely.empty()) return std::nullopt;
    return best_of(likely);
  }

  static std::size_t weighed(const std::vector<Identified>& shards) {
    std::size_t count = 0;
    for (const Identified& one : shards) count += one.weights.size();
    return count;
  }

  cli::Folder folder_;
  Catalog catalog_;
  std::mt19937_64 random_;
};

TEST_F(Shards, that_know_the_likeliest_part_say_the_same_and_weigh_fewer) {
  std::size_t with_rival = 0;
  std::size_t alone = 0;
  for (int count = test_count(12); count > 0; --count) {
    const Problem problem = roll_on_some_part(1, {4e-3, 0.1});  // so that bounds leave many
    IdentifyOptions options;
    alone += weighed(in_shards(problem, options));
    options.rival = rival_of(problem);
    const std::vector<Identified> shards = in_shards(problem, options);
    with_rival += weighed(shards);
    EXPECT_EQ(merged(shards), format_identified(catalog_, identify(catalog_, problem)));
  }
  EXPECT_LT(with_rival, alone);
}

TEST_F(Shards, asked_narrowly_say_the_same_where_a_part_fits_well) {
  for (int count = test_count(12); count > 0; --count) {
    const Problem problem = roll_on_some_part(1);
    const Identified whole = identify(catalog_, problem);
    if (!fits_well(whole.weights)) continue;
    IdentifyOptions narrowly;
    narrowly.narrowly = true;
    EXPECT_EQ(merged(in_shards(problem, narrowly)), format_identified(catalog_, whole));
  }
}

TEST_F(Shards, that_know_the_likeliest_part_say_the_same_where_all_fit_badly) {
  for (int count = test_count(4); count > 0; --count) {
    const Problem problem = roll_on_some_part(1.9);
    IdentifyOptions options;
    options.rival = rival_of(problem);
    EXPECT_EQ(merged(in_shards(problem, options)), format_identified(catalog_, identify(catalog_, problem)));
  }
}

TEST_F(Shards, asked_narrowly_are_refused_where_nothing_fits_well) {
  const Problem problem = roll_on_some_part(1.9);
  IdentifyOptions narrowly;
  narrowly.narrowly = true;
  const std::vector<Identified> shards = in_shards(problem, narrowly);
  EXPECT_THAT(refusal_of([&] { merged(shards); }), testing::HasSubstr("ask them without `narrowly`"));
}

TEST_F(Shards, know_no_likeliest_part_without_noise) {
  Problem problem = roll_on_some_part(0);
  problem.noise.reset();
  EXPECT_FALSE(likeliest(catalog_, problem));
}

}  // namespace
}  // namespace identify_shards_test
