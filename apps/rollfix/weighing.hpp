#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/belief/belief.hpp"
#include "rollfix/belief/pose_spread.hpp"
#include "rollfix/json_output.hpp"
#include "rollfix/locate/locate.hpp"

namespace rollfix::app {

/// How a search with noise is asked for, as typed.
struct NoiseArguments {
  std::string noise;
  std::string prior;
  bool robust = false;
};

/// Adds --noise, --prior and --robust to a command.
void add_noise_arguments(CLI::App& command, NoiseArguments& arguments);

/// Nothing without --noise. Throws InputError, also where --prior or --robust is given without it.
std::optional<BeliefOptions> read_belief_options(const NoiseArguments& arguments);

/// What would have to be otherwise for something to fit; empty where something does.
std::string about(const Diagnosis& diagnosis);

/// The same, null where something fits; and the noise, as JSON.
Json diagnosis_json(const Diagnosis& diagnosis);
Json noise_json(const Noise& noise);

/// What all samples together say, beyond the search. Entry k is of placement k.
struct Weighing {
  BeliefOptions options;
  std::vector<Mode> modes;
  std::vector<std::optional<PoseSpread>> poses;
  std::vector<Placement> improbable;  // within the tolerance for the readings, but not for all the samples
  std::string verdict;
  Diagnosis diagnosis;
  std::size_t samples = 0;
  double excess = 1;
  double rest = 0;  // probability of what is not listed
};

/// "probability", "mean", "sd", ...: what a placement's JSON gets.
void add_weight(const Weighing& weighing, std::size_t k, Json& placement);

/// "noise", "samples", ...: what the document gets.
void add_weighing(const Weighing& weighing, Json& document);

/// "noise      contact 0.1, ..." and what the samples are like.
std::string weighing_lines(const Weighing& weighing);

/// What to do, by the verdict.
std::string advice(const Weighing& weighing);

}  // namespace rollfix::app
