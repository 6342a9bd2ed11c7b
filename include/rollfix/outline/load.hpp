#pragma once

#include <string>
#include <vector>

#include "rollfix/outline/outline.hpp"
#include "rollfix/outline/points.hpp"

namespace rollfix {

/// An outline from what a user calls it, which becomes its name: "gallery:NAME,key=value,..." (see gallery), a points
/// file ending in .csv, .dat or .txt, or "-" for points from standard input (see read_points). The options are for
/// points; `notes`, where given, is told what was found and done to them. Throws InputError: what the parts throw, and
/// an ending that is not known. Drawings and saved parts need rollfix::files: see rollfix/files/load_part.hpp.
Outline load_outline(const std::string& argument, const OutlineOptions& options = {},
                     std::vector<std::string>* notes = nullptr);

}  // namespace rollfix
