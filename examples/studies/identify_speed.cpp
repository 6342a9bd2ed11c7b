// How long does it take to say which part of a catalog a roll was on? By what is known of the roll, on one core.
// Prints docs/identify.md's table: study_identify_speed parts.db 20, with as many rolls for each line. Without a
// catalog it makes one of 200 splines; without a number it takes 3.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "identify_times.hpp"
#include "rollfix/error.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/rolling.hpp"

namespace {

using rollfix::Catalog;
using rollfix::Part;

constexpr double kShare = 0.3;  // of the perimeter is rolled over
constexpr std::size_t kRows = 200;

/// What is known of a roll: readings with a tolerance, or a log with noise as shares of the perimeter.
struct Question {
  std::string name;
  std::size_t readings = 0;
  double tolerance = 0;
  rollfix::Noise noise{};
};

const std::vector<Question> kQuestions = {{"3 readings within 0.005 rad", 3, 0.005},
                                          {"10 readings within 1e-6 rad", 10, 1e-6},
                                          {"10 readings within 0.005 rad", 10, 0.005},
                                          {"10 readings within 0.0225 rad", 10, 0.0225},
                                          {"200 rows, contact 5e-5 P, angle 0.002", 0, 0, {5e-5, 0.002}},
                                          {"200 rows, contact 1e-4 P, angle 0.005", 0, 0, {1e-4, 0.005}},
                                          {"the same with slip 0.002", 0, 0, {1e-4, 0.005, 0.002}}};

rollfix::Problem problem_of(const Question& question, const Part& part, double s, std::uint64_t seed) {
  const double P = part.perimeter();
  rollfix::Problem problem{part, std::vector<rollfix::Reading>{}};
  for (std::size_t k = 1; k <= question.readings; ++k) {
    const double length = kShare * P * static_cast<double>(k) / static_cast<double>(question.readings);
    problem.measured.readings.emplace_back(length, part.turning().angle(s + length) - part.turning().angle(s));
  }
  if (question.readings > 0) {
    problem.tolerance = question.tolerance;
    return problem;
  }
  problem.fingers = {rollfix::DiskFinger{0.025 * P}};
  problem.noise = rollfix::Noise{question.noise.contact * P, question.noise.angle, question.noise.slip};
  rollfix::RollPlan plan;
  plan.start = s;
  plan.distance = kShare * P;
  plan.rows = kRows;
  problem.measured.log = rollfix::noisy_roll(part, problem.fingers[0], plan, *problem.noise, seed).log;
  return problem;
}

void look(const Catalog& catalog, std::size_t number, const rollfix::Problem& problem, Seen& seen) {
  rollfix::IdentifyOptions options;
  options.threads = 1;
  const double start = processor_seconds();
  const rollfix::Identified found = rollfix::identify(catalog, problem, options);
  seen.milliseconds.push_back(1e3 * (processor_seconds() - start));
  seen.searched += static_cast<double>(found.searched + found.searched_widely);
  seen.listed += static_cast<double>(found.parts.size());
  seen.found +=
      static_cast<std::size_t>(std::any_of(found.parts.begin(), found.parts.end(),
                                           [&](const rollfix::PartFound& one) { return one.weight.part == number; }));
}

Seen look(const Catalog& catalog, const Question& question, std::size_t rolls) {
  std::mt19937_64 random(7);
  Seen seen;
  while (seen.milliseconds.size() < rolls) {
    const std::size_t number = std::uniform_int_distribution<std::size_t>(0, catalog.size() - 1)(random);
    const Part part = catalog.part(number);
    const double s = std::uniform_real_distribution<double>(0, part.closed() ? part.perimeter() : 0)(random);
    try {
      look(catalog, number, problem_of(question, part, s, random()), seen);
    } catch (const rollfix::InputError&) {  // a finger that does not fit in there
    }
  }
  std::sort(seen.milliseconds.begin(), seen.milliseconds.end());
  return seen;
}

}  // namespace

int main(int count, char** values) {
  const std::string own = (std::filesystem::temp_directory_path() / "rollfix-identify-speed.db").string();
  const double start = processor_seconds();
  const Catalog catalog = count > 1 ? Catalog(values[1]) : splines(own);
  const std::size_t rolls = count > 2 ? std::stoul(values[2]) : 3;
  fmt::print("{} parts; {} in {:.2f} s\n\n", catalog.size(), count > 1 ? "opened" : "built",
             processor_seconds() - start);
  fmt::print("| what is known | median [ms] | most [ms] | bounds leave | listed | true part among them |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- |\n");
  for (const Question& question : kQuestions) {
    look(catalog, question, 1);  // parts are read from the file once
    const Seen seen = look(catalog, question, rolls);
    const auto n = static_cast<double>(rolls);
    fmt::print("| {} | {:.3g} | {:.3g} | {:.1f} | {:.1f} | {} of {} |\n", question.name, seen.milliseconds[rolls / 2],
               seen.milliseconds.back(), seen.searched / n, seen.listed / n, seen.found, rolls);
    std::fflush(stdout);
  }
  if (count <= 1) std::filesystem::remove(own);
}
