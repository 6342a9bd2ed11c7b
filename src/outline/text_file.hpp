#pragma once

#include <string>

namespace rollfix {

/// The whole of a file, "-" for standard input. Throws InputError: missing, a directory, or not readable.
std::string read_text(const std::string& path);

}  // namespace rollfix
