// A witness that is not ours: in Box2D, a rigid-body engine, a disk finger rolls on parts of the gallery because
// friction makes it, and its logs are located. Prints the tables of docs/witness.md and writes a log.
//
//   study_physics_witness                 a few rolls on each part
//   study_physics_witness --starts 40     as many as the document has
//   study_physics_witness -o physics.csv  and one log, with the command that locates it
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "physics_trial.hpp"
#include "rollfix/error.hpp"

namespace {

using physics::Stand;
using physics::Surface;
using physics::Trial;

const std::vector<std::string> kParts = {"ellipse",      "cam",     "spline,wobble=0.12", "limacon,a=2.5",
                                         "superellipse", "stadium", "naca,chord=5",       "reuleaux"};

template <typename Test>
std::size_t count_if(const std::vector<Trial>& trials, const Test& test) {
  return static_cast<std::size_t>(std::count_if(trials.begin(), trials.end(), test));
}

template <typename Value>
double largest(const std::vector<Trial>& trials, const Value& value) {
  double most = 0;
  for (const Trial& trial : trials) most = std::max(most, std::abs(value(trial)));
  return most;
}

template <typename Value>
double mean(const std::vector<Trial>& trials, const Value& value) {
  double sum = 0;
  for (const Trial& trial : trials) sum += value(trial);
  return sum / static_cast<double>(trials.size());
}

/// A finger that grips.
void tell_gripping(const std::vector<Stand>& stands, std::size_t starts) {
  fmt::print("| part | slip | contact | angle | modes | among | first | in 95 % | error | search: among | of |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (std::size_t k = 0; k < stands.size(); ++k) {
    const Stand& stand = stands[k];
    const double P = stand.part().perimeter();
    const std::vector<Trial> trials = stand.run_many(starts, Surface{}, physics::noise_of(stand.part()));
    fmt::print("| {} | {:.1e} | {:.0e} P | {:.4f} | {:.1f} | {}/{} | {} | {} | {:.1e} P | {}/{} | {:.1f} |\n",
               kParts[k], largest(trials, [](const Trial& t) { return t.slip; }),
               largest(trials, [](const Trial& t) { return t.contact_error; }) / P,
               largest(trials, [](const Trial& t) { return t.angle_error; }),
               mean(trials, [](const Trial& t) { return static_cast<double>(t.modes); }),
               count_if(trials, [](const Trial& t) { return t.is_among(); }), starts,
               count_if(trials, [](const Trial& t) { return t.is_among() && *t.rank == 0; }),
               count_if(trials, [](const Trial& t) { return t.is_among() && t.in_interval; }),
               largest(trials, [](const Trial& t) { return t.is_among() ? t.error : 0; }) / P,
               count_if(trials, [](const Trial& t) { return t.is_placed; }), starts,
               mean(trials, [](const Trial& t) { return static_cast<double>(t.placements); }));
  }
}

struct Slippery {
  std::string name;
  Surface surface;
};

/// One that slips, on all parts; located as one that grips, and with the slip that there is.
void tell_slipping(const std::vector<Stand>& stands, std::size_t starts) {
  const std::vector<Slippery> cases = {{"friction 0.05", {0.05, 0, 0, 0}},
                                       {"friction 0.10", {0.10, 0, 0, 0}},
                                       {"friction 0.14", {0.14, 0, 0, 0}},
                                       {"oily stretch, 0.03", {1, 0.4, 0.2, 0.03}}};
  fmt::print("| surface | slip | `slip=` | inconsistent | among | elsewhere | farthest | search: among |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Slippery& slippery : cases) {
    for (const bool is_told : {false, true}) {
      std::vector<Trial> trials;
      double slip = physics::kGrippingSlip;
      double farthest = 0;
      for (const Stand& stand : stands) {
        if (is_told) slip = std::abs(stand.run(0, slippery.surface, physics::noise_of(stand.part())).slip);
        for (Trial& trial : stand.run_many(starts, slippery.surface, physics::noise_of(stand.part(), slip))) {
          if (trial.is_elsewhere()) farthest = std::max(farthest, trial.nearest / stand.part().perimeter());
          trials.push_back(std::move(trial));
        }
      }
      fmt::print("| {} | {:.3f} | {} | {}/{} | {} | {} | {:.1e} P | {} |\n", slippery.name,
                 mean(trials, [](const Trial& t) { return t.slip; }), is_told ? "as it is" : "0.0005",
                 count_if(trials, [](const Trial& t) { return t.is_inconsistent(); }), trials.size(),
                 count_if(trials, [](const Trial& t) { return t.is_among(); }),
                 count_if(trials, [](const Trial& t) { return t.is_elsewhere(); }), farthest,
                 count_if(trials, [](const Trial& t) { return t.is_placed; }));
    }
  }
}

void write_log(const std::string& path) {
  const Stand stand("cam");
  const double P = stand.part().perimeter();
  const Trial trial = stand.run(0.3 * P, Surface{}, physics::noise_of(stand.part()));
  std::ofstream(path) << trial.log;
  fmt::print("\n{}: on gallery:cam from s = {:.5f}; to locate it:\n", path, trial.start);
  fmt::print(
      "rollfix locate gallery:cam --log {} --finger disk,r={:.9g} --noise contact={:.2g},angle=0.0015,slip=0.0005\n",
      path, stand.radius(), 5e-5 * P);
}

/// What follows this option, or else the default.
std::string option(const std::vector<std::string>& arguments, std::string_view name, const std::string& by_default) {
  const auto found = std::find(arguments.begin(), arguments.end(), name);
  if (found == arguments.end()) return by_default;
  if (found + 1 == arguments.end()) throw rollfix::InputError(fmt::format("{}: expected something after it", name));
  return found[1];
}

std::size_t read_count(const std::string& text) {
  std::size_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size() || count == 0) {
    throw rollfix::InputError(fmt::format("--starts: expected a whole number above 0, found \"{}\"", text));
  }
  return count;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    const std::size_t starts = read_count(option(arguments, "--starts", "2"));
    const std::string log = option(arguments, "-o", "");
    const std::vector<Stand> stands(kParts.begin(), kParts.end());
    tell_gripping(stands, starts);
    fmt::print("\n");
    tell_slipping(stands, std::max<std::size_t>(1, starts / 4));
    if (!log.empty()) write_log(log);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
