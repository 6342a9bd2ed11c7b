// rollfix paper: what the paper says, and what is computed when the command runs.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"

namespace cli_paper_test {
namespace {

using cli::Json;

constexpr const char* kSpline = "gallery:spline,n=9,seed=7,wobble=0.2";

const Json& claims() {
  static const Json document = cli::run("paper --json").json();
  return document.at("claims");
}

std::vector<Json> claims_of(const std::string& where) {
  std::vector<Json> found;
  std::copy_if(claims().begin(), claims().end(), std::back_inserter(found),
               [&](const Json& claim) { return claim.at("where") == where; });
  return found;
}

std::size_t placements(const std::string& arguments) {
  const cli::Ran ran = cli::run(fmt::format("locate {} {} --json", kSpline, arguments));
  EXPECT_EQ(ran.code, 0) << ran.err;
  return ran.json().at("placements").size();
}

TEST(CliPaper, has_a_row_for_every_theorem_lemma_and_figure_that_can_be_computed) {
  for (const char* where : {"Lemma 2", "Theorem 4", "Theorem 5", "Figure 2a", "Figure 2b", "Figure 3", "Figure 5",
                            "Figure 6", "Figure 7", "Figure 8"}) {
    EXPECT_FALSE(claims_of(where).empty()) << where;
  }
}

TEST(CliPaper, everything_agrees_but_the_odd_number_of_pairs) {
  for (const Json& claim : claims()) {
    const bool odd = claim.at("says") == "15 pairs of feasible locations";
    EXPECT_EQ(claim.at("agrees"), !odd) << claim;
  }
}

TEST(CliPaper, the_counts_are_below_the_bounds_of_the_theorems_and_not_far_below) {
  const Json convex = claims_of("Theorem 4").front().at("figures");
  EXPECT_LE(convex.at("marching"), 2.0);
  EXPECT_GT(convex.at("marching"), 1.9);  // each endpoint goes round once
  EXPECT_LE(convex.at("start"), 1.0);
  const Json any = claims_of("Theorem 5").front().at("figures");
  EXPECT_LE(any.at("total"), 5.0);
  EXPECT_GT(any.at("total"), 2.0);  // preprocessing is one of them
}

TEST(CliPaper, lemma_2_is_measured_on_many_limits) {
  const Json figures = claims_of("Lemma 2").front().at("figures");
  EXPECT_GT(figures.at("limits"), 50);
  EXPECT_LT(figures.at("slowest"), 1.0);
  EXPECT_TRUE(figures.at("lemma_1_holds"));
}

TEST(CliPaper, figure_7_counts_what_the_production_search_counts) {
  const rollfix::Part part(rollfix::load_outline(kSpline));
  const double turn = part.turning().angle(7.2) - part.turning().angle(6.2);
  EXPECT_EQ(claims_of("Figure 7").front().at("figures").at("segments"),
            placements(fmt::format("--reading 1,{:.17g}", turn)));
}

TEST(CliPaper, figure_8_counts_what_the_production_search_counts) {
  const std::vector<Json> rows = claims_of("Figure 8");
  ASSERT_EQ(rows.size(), 3U);
  const std::string two = "--reading 0.58,0.94,-0.725248 --reading 1.01,1.92,-1.99849";
  EXPECT_EQ(rows[1].at("figures").at("pairs"), placements(two));
  EXPECT_EQ(rows[2].at("figures").at("left"), placements(two + " --reading 1.25,2.37,-1.966238"));
}

TEST(CliPaper, the_table_has_a_line_for_every_claim_of_the_document) {
  const cli::Ran ran = cli::run("paper");
  EXPECT_EQ(ran.code, 0);
  for (const Json& claim : claims()) {
    EXPECT_NE(ran.out.find(claim.at("says").get<std::string>()), std::string::npos) << claim;
    EXPECT_NE(ran.out.find(claim.at("get").get<std::string>()), std::string::npos) << claim;
  }
}

TEST(CliPaper, takes_no_part) { EXPECT_EQ(cli::run("paper gallery:cam").code, 2); }

}  // namespace
}  // namespace cli_paper_test
