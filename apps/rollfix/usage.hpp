#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace rollfix::app {

/// A flag without a value.
CLI::Option* add_switch(CLI::App& command, const std::string& name, bool& value, const std::string& meaning);

/// Throws InputError for whatever the parser left over: an unknown option or command, with the nearest valid one,
/// or a word too many.
void refuse_leftovers(const CLI::App& program);

/// What a parse error means, in one line.
std::string explain(const CLI::ParseError& error);

}  // namespace rollfix::app
