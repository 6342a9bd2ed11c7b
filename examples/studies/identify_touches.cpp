// How long does it take to say which part of a catalog was touched? By what is known of the touches, on one core, with
// bounds and without. Prints docs/identify.md's table: study_identify_touches parts.db 20 2, with as many questions for
// each line, and so many of them without bounds. Without a catalog it makes one of 200 splines; without numbers it
// takes 3 and 1.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "identify_times.hpp"
#include "rollfix/error.hpp"
#include "rollfix/identify.hpp"

namespace {

using rollfix::Catalog;
using rollfix::Part;
using rollfix::Vec2;

/// What is known of a part: so many touches of a point, the standard deviations as shares of the perimeter and in
/// radians; 0: no normals.
struct Question {
  std::string name;
  std::size_t touches = 0;
  double position = 0;
  double angle = 0;
};

const std::vector<Question> kQuestions = {{"3 with normals, 0.0003 P, 0.5 deg", 3, 3e-4, 0.0087},
                                          {"4 with normals, 0.0003 P, 0.5 deg", 4, 3e-4, 0.0087},
                                          {"5 with normals, 0.001 P, 2 deg", 5, 1e-3, 0.035},
                                          {"6 without normals, 0.0003 P", 6, 3e-4, 0},
                                          {"8 without normals, 0.0003 P", 8, 3e-4, 0}};

rollfix::TouchProblem problem_of(const Question& question, const Part& part, std::mt19937_64& random) {
  const auto uniform = [&](double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(random); };
  std::normal_distribution<double> normal;
  const double P = part.perimeter();
  const rollfix::Pose pose{uniform(-P, P), uniform(-P, P), uniform(-std::numbers::pi, std::numbers::pi)};
  rollfix::TouchProblem problem{part, {}};
  rollfix::Noise noise;
  noise.position = question.position * P;
  noise.angle = question.angle;
  for (std::size_t k = 0; k < question.touches; ++k) {
    const double s = uniform(0, P);
    rollfix::MeasuredTouch touch;
    touch.at = pose.world(part.point(s)) + noise.position * Vec2(normal(random), normal(random));
    if (question.angle > 0) {
      touch.normal = part.tangent(s) - 0.5 * std::numbers::pi + pose.heading + noise.angle * normal(random);
    }
    problem.touches.push_back(touch);
  }
  problem.noise = noise;
  return problem;
}

Seen look(const Catalog& catalog, const Question& question, std::size_t count, bool use_index) {
  std::mt19937_64 random(7);
  Seen seen;
  rollfix::IdentifyOptions options;
  options.threads = 1;
  options.use_index = use_index;
  while (seen.milliseconds.size() < count) {
    const std::size_t number = std::uniform_int_distribution<std::size_t>(0, catalog.size() - 1)(random);
    const rollfix::TouchProblem problem = problem_of(question, catalog.part(number), random);
    const double start = processor_seconds();
    const rollfix::IdentifiedByTouches found = rollfix::identify(catalog, problem, options);
    seen.milliseconds.push_back(1e3 * (processor_seconds() - start));
    seen.searched += static_cast<double>(found.searched);
    seen.listed += static_cast<double>(found.parts.size());
    seen.found += static_cast<std::size_t>(std::any_of(
        found.parts.begin(), found.parts.end(), [&](const rollfix::PartTouched& one) { return one.part == number; }));
  }
  std::sort(seen.milliseconds.begin(), seen.milliseconds.end());
  return seen;
}

}  // namespace

int main(int count, char** values) {
  const std::string own = (std::filesystem::temp_directory_path() / "rollfix-identify-touches.db").string();
  const Catalog catalog = count > 1 ? Catalog(values[1]) : splines(own);
  const std::size_t questions = count > 2 ? std::stoul(values[2]) : 3;
  const std::size_t without = count > 3 ? std::stoul(values[3]) : 1;
  const double start = processor_seconds();
  look(catalog, kQuestions[1], 1, true);  // middles of cells are computed once
  fmt::print("{} parts; the first question takes {:.3g} ms\n\n", catalog.size(), 1e3 * (processor_seconds() - start));
  fmt::print(
      "| touches | median [ms] | most [ms] | bounds leave | listed | true part among them | without bounds [ms] "
      "|\n");
  fmt::print("| --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Question& question : kQuestions) {
    const Seen seen = look(catalog, question, questions, true);
    const auto n = static_cast<double>(questions);
    fmt::print("| {} | {:.3g} | {:.3g} | {:.1f} | {:.1f} | {} of {} |", question.name, seen.milliseconds[questions / 2],
               seen.milliseconds.back(), seen.searched / n, seen.listed / n, seen.found, questions);
    std::fflush(stdout);
    if (without > 0) fmt::print(" {:.3g} |", look(catalog, question, without, false).milliseconds[without / 2]);
    fmt::print("\n");
    std::fflush(stdout);
  }
  if (count <= 1) std::filesystem::remove(own);
}
