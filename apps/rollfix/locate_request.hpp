#pragma once

#include <string>
#include <vector>

#include "rollfix/contact/log.hpp"
#include "rollfix/march/locate_by_march.hpp"
#include "rollfix/output_argument.hpp"
#include "rollfix/part_argument.hpp"
#include "rollfix/report.hpp"
#include "rollfix/tolerance.hpp"
#include "rollfix/weighing.hpp"

namespace rollfix::app {

/// What `rollfix locate` was given, as typed.
struct LocateArguments {
  PartArgument part;
  std::vector<std::string> readings;
  std::vector<std::string> logs;
  std::vector<std::string> fingers;
  std::string roll;
  std::string facing;
  std::string instants;
  std::string tolerance;
  std::string budget;
  NoiseArguments noise;
  bool json = false;
  bool explain = false;
  OutputArgument output;
  MarchArguments march;
};

/// One finger on a part at rest: from --reading L,THETA or from its log, which is then the only one in `logs`.
Report locate_one(const LocateArguments& arguments, const std::vector<Log>& logs);

/// Two fingers on a part that is free to move: from --reading LA,LB,THETA or from their logs.
Report locate_two(const LocateArguments& arguments, const std::vector<Log>& logs);

/// As typed, or else what the rounding of the readings makes of it. Throws InputError.
Tolerance tolerance_of(const LocateArguments& arguments, const Part& part, const std::vector<Rounding>& roundings);

/// --budget as typed, or else the default. Throws InputError.
std::size_t budget_of(const LocateArguments& arguments, std::size_t by_default);

/// What a search that is over tells whoever called the program.
ExitCode exit_code_of(bool complete, bool anything_fits);

/// Notes on a part that is stored the other way round than its file has it, and on a log that follows it.
void add_direction_notes(const Part& part, bool lengths_turned_round, Report& report);

}  // namespace rollfix::app
