#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "rollfix/arguments/part_argument.hpp"
#include "rollfix/identify.hpp"

namespace rollfix::app {

/// --catalog FILE, instead of a PART.
void add_catalog_argument(CLI::App& command, std::string& argument);

/// Throws InputError: a PART and a catalog, neither, or what says how a PART is loaded next to a catalog.
void require_part_or_catalog(const std::string& command, const PartArgument& part, const std::string& catalog);

/// Throws InputError: --prior was given, where it is asked which part it is.
void require_no_prior(const std::string& prior);

}  // namespace rollfix::app
