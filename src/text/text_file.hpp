#pragma once

#include <cstdio>
#include <memory>
#include <string>

namespace rollfix {

using OpenFile = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// A file that can be read, "-" for standard input. Throws InputError: missing, a directory, or not readable.
OpenFile open_text(const std::string& path);

/// The whole of a file, "-" for standard input. Throws InputError: missing, a directory, or not readable.
std::string read_text(const std::string& path);

}  // namespace rollfix
