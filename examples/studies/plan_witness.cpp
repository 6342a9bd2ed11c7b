// A witness that is not ours: plans of two disks on parts that are free to move, carried out in Box2D, a rigid-body
// engine, with friction. Prints the table of docs/plan.md.
//
//   study_plan_witness               a few parts
//   study_plan_witness --parts 50    as many as the document has
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "plan_trial.hpp"

namespace {

using namespace plan_trial;  // NOLINT(google-build-using-namespace): the words of this study

template <class Value>
double quantile(const std::vector<Played>& all, double share, const Value& value) {
  std::vector<double> values;
  for (const Played& one : all) values.push_back(value(one));
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

void tell(const std::string& name, const std::vector<Played>& all) {
  if (all.empty()) return;
  const auto held = std::count_if(all.begin(), all.end(), &holds);
  fmt::print("| {} | {} | {} | {:.1e} P | {:.1e} P | {:.1e} P | {:.1e} P | {:.3f} | {:.3f} |\n", name, all.size(), held,
             quantile(all, 0.5, slip_of), quantile(all, 1, slip_of),
             quantile(all, 0.5, [](const Played& one) { return one.place; }),
             quantile(all, 1, [](const Played& one) { return one.place; }),
             quantile(all, 0.5, [](const Played& one) { return one.heading; }) * 180 / std::numbers::pi,
             quantile(all, 1, [](const Played& one) { return one.heading; }) * 180 / std::numbers::pi);
}

std::size_t read_parts(const std::vector<std::string>& arguments) {
  const auto found = std::find(arguments.begin(), arguments.end(), "--parts");
  if (found == arguments.end()) return 4;
  std::size_t count = 0;
  const std::string text = found + 1 == arguments.end() ? "" : found[1];
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size() || count == 0) {
    throw rollfix::InputError(fmt::format("--parts: expected a whole number above 0, found \"{}\"", text));
  }
  return count;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::size_t parts = read_parts({argv + 1, argv + argc});
    std::mt19937_64 generator(2024);
    std::vector<Played> feasible;
    std::vector<Played> refused;
    std::vector<Played> oily;
    for (std::size_t k = 0; k < parts; ++k) {
      const Case done = feasible_case(generator, k);
      feasible.push_back(play(done));
      const double needed = std::max(done.plan.friction_needed[0], done.plan.friction_needed[1]);
      if (needed > 0.15) oily.push_back(play(done, 0.5 * needed));
      if (const auto other = refused_case(done)) refused.push_back(play(*other));
    }
    fmt::print(
        "| roll | parts | holds | slip, median | most | place off, median | most | heading off, median | most |\n");
    fmt::print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    tell("planned, 3 deg inside the cones", feasible);
    tell("refused, 5 deg or more outside", refused);
    tell("planned, with half the friction that it needs", oily);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
