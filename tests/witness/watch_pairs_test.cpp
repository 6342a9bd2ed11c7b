// Two fingers: random logs, watched row by row, end as `locate` says of the same log, to the bit.
#include <gtest/gtest.h>

#include "cli.hpp"
#include "noisy_pairs.hpp"
#include "random.hpp"
#include "watch_child.hpp"

namespace watch_pairs_test {
namespace {

using cli::Json;
using cli::run;
using noisy_pairs::Case;
using rollfix::Part;

Json last_answer(const cli::Ran& ran) {
  Json last;
  std::istringstream lines(ran.out);
  for (std::string line; std::getline(lines, line);) {
    const Json event = Json::parse(line);
    if (event["event"] == "over") last = event;
  }
  return last;
}

/// The most memory that a log of so many rows of two fingers takes, bytes.
long memory_for(std::size_t rows) {
  watching::Child child(watching::words_of(
      "watch gallery:spline,n=9,seed=4,wobble=0.25 --finger disk,r=0.1 --noise contact=0.01,angle=0.01 --jsonl "
      "--every 1000000"));
  child.send("time,u_a,psi_a,u_b,psi_b\n");
  for (std::size_t k = 0; k < rows; k += 1000) {
    std::string text;
    for (std::size_t i = 0; i < 1000; ++i) {
      const double to_and_fro = std::sin(1e-3 * static_cast<double>(k + i));
      text += std::to_string(k + i) + fmt::format(",{:.5f},{:.5f},0,0\n", to_and_fro, -to_and_fro);
    }
    child.send(text);
  }
  child.close_input();
  EXPECT_EQ(child.next_event("end")["counts"]["samples"].get<std::size_t>() + 1, rows + 1);
  child.wait();
  return child.peak_memory();
}

}  // namespace

TEST(WatchPairs, end_as_locate_says_of_the_same_log) {
  const cli::Folder folder;
  std::mt19937_64 random = test_generator();
  const std::vector<std::string> shapes = {"cam", "limacon", "naca", "spline,n=9,seed=7,wobble=0.2"};
  const int count = test_count(50);
  for (int k = 0; k < count; ++k) {
    const std::string shape = shapes[static_cast<std::size_t>(k) % shapes.size()];
    const Part part(rollfix::gallery(shape));
    const double P = part.perimeter();
    const std::size_t rows = 20 + random() % 1500;
    const Case drawn = noisy_pairs::random_pair(part, rows, {5e-4 * P, 2e-3, 0, 0}, random);
    write_log("log.csv", drawn.log);
    const std::string asked = fmt::format(
        " gallery:{} --finger disk,r={:.17g} --finger disk,r={:.17g} --noise contact={:.17g},angle=2e-3 "
        "--log log.csv ",
        shape, drawn.fingers[0].radius, drawn.fingers[1].radius, 5e-4 * P);
    const Json watched = last_answer(run("watch" + asked + "--once --jsonl --every 500"));
    const Json located = run("locate" + asked + "--json").json();
    EXPECT_EQ(watched["verdict"], located["verdict"]) << k;
    ASSERT_EQ(watched["placements"].size(), located["placements"].size()) << k;
    for (std::size_t i = 0; i < watched["placements"].size(); ++i) {
      for (const auto& [field, value] : watched["placements"][i].items()) {
        EXPECT_EQ(value.dump(), located["placements"][i][field].dump()) << field << " in case " << k;
      }
    }
  }
}

TEST(WatchPairs, need_no_more_memory_for_a_longer_log) {
  EXPECT_LT(memory_for(200000), memory_for(40000) + 2 * 1024 * 1024);
}

}  // namespace watch_pairs_test
