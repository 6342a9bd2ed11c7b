#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "rollfix/arguments/part_argument.hpp"
#include "rollfix/plan.hpp"

namespace rollfix::app {

/// What `rollfix plan` was given, as typed. Entry 0 of a list is finger a's, entry 1 finger b's.
struct PlanArguments {
  PartArgument part;
  std::vector<std::string> fingers;
  std::vector<std::string> starts;
  std::vector<std::string> lengths;
  std::vector<std::string> contact_angles;
  std::vector<std::string> contacts;
  std::string friction;
  std::string margin;
  std::string clearance;
  std::string limits;
  std::string duration;
  std::string pose;
  std::string part_rotation;
  std::string stays;
  std::string samples;
  std::vector<std::string> files;
  bool mirror = false;
  bool may_overlap = false;
  bool json = false;
  bool force = false;
};

/// Of -o the figure, .svg, .png or .pdf, and the tables.
struct PlanFiles {
  std::vector<std::string> tables;
  std::vector<std::string> figures;
};
PlanFiles files_of(const PlanArguments& arguments);

/// Adds all of them to a command.
void add_plan_arguments(CLI::App& command, PlanArguments& arguments);

/// The problem that is meant. Throws InputError.
PlanProblem read_plan_problem(const PlanArguments& arguments, const Part& part);

}  // namespace rollfix::app
