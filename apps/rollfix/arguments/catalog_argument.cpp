#include "rollfix/arguments/catalog_argument.hpp"

#include <fmt/format.h>

#include "rollfix/error.hpp"

namespace rollfix::app {

void add_catalog_argument(CLI::App& command, std::string& argument) {
  command.add_option("--catalog", argument, "instead of a PART: which of the parts of this catalog is it?")
      ->type_name("FILE");
}

void require_part_or_catalog(const std::string& command, const PartArgument& part, const std::string& catalog) {
  if (part.part.empty() == catalog.empty()) {
    throw InputError(command + (catalog.empty() ? ": expected a PART, or --catalog FILE, found neither"
                                                : ": expected a PART or --catalog FILE, found both"));
  }
  if (catalog.empty()) return;
  const std::string said = part.corner_angle + part.smooth + part.loop + part.gap + part.layer + part.unit;
  if (part.open || part.outer || part.allow_crossing || !said.empty()) {
    throw InputError(
        "--catalog: its parts were loaded when it was built: leave --corner-angle, --smooth, --loop, --gap, --layer, "
        "--outer, --unit, --open and --allow-crossing out");
  }
}

void require_no_prior(const std::string& prior) {
  if (!prior.empty()) throw InputError("--prior: is about a place on one part: leave it out");
}

}  // namespace rollfix::app
