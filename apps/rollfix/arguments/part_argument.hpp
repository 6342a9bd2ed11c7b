#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "rollfix/files.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/part.hpp"

namespace rollfix::app {

/// PART and the options that say how to take it, as typed; empty: not given.
struct PartArgument {
  std::string part;
  std::string corner_angle;
  std::string smooth;
  std::string loop;
  std::string gap;
  std::string layer;
  std::string unit;
  std::string decimal;
  bool open = false;
  bool outer = false;
  bool allow_crossing = false;
};

/// Adds PART and these options to a command.
void add_part_argument(CLI::App& command, PartArgument& argument);

/// Adds the options alone, but --loop.
void add_load_arguments(CLI::App& command, PartArgument& argument);
/// What they say. Throws InputError: an option that is not what it should be.
LoadOptions read_load_options(const PartArgument& argument);

/// Adds --decimal, unless the command has it.
void add_decimal_argument(CLI::App& command, std::string& decimal);
/// Whether that says that numbers have commas. Throws InputError: neither a comma nor a point.
std::optional<bool> has_decimal_comma(const std::string& decimal);

/// Adds --unit alone.
void add_unit_argument(CLI::App& command, std::string& unit);

/// The part and what its file says besides. Throws InputError: no PART, an option that is not what it should be, or
/// what rollfix::load_part throws.
LoadedPart load(const PartArgument& argument);
/// Throws InputError: none is given.
void require_part(const PartArgument& argument);

/// Of a drawing what it holds besides the part: its other loops.
std::vector<Outline> other_loops(const LoadedPart& loaded);

/// The part alone, and what else its drawing holds where that is asked for. What the user should know of how it was
/// taken is added to the notes.
Part load_part(const PartArgument& argument, std::vector<std::string>& notes, std::vector<Outline>* others = nullptr);

/// That a part was given clockwise, and what follows from it.
std::string reversed_note(const Part& part);

/// --catalog FILE, instead of a PART.
void add_catalog_argument(CLI::App& command, std::string& argument);

/// Throws InputError: a PART and a catalog, neither, or what says how a PART is loaded next to a catalog.
void require_part_or_catalog(const std::string& command, const PartArgument& part, const std::string& catalog);

/// Throws InputError: --prior was given, where it is asked which part it is.
void require_no_prior(const std::string& prior);

}  // namespace rollfix::app
