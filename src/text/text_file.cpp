#include "text/text_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "rollfix/error.hpp"

namespace rollfix {

namespace {

/// Reads to the end, however long a pipe may be. `expected` is a guess at the size.
std::string read_all(std::FILE* file, std::size_t expected, const std::string& name) {
  constexpr std::size_t kLeastRoom = 1 << 16;
  std::string text;
  std::size_t size = 0;
  text.resize(expected + kLeastRoom);
  while (const std::size_t count = std::fread(text.data() + size, 1, text.size() - size, file)) {
    size += count;
    if (text.size() - size < kLeastRoom) text.resize(2 * text.size());
  }
  if (std::ferror(file) != 0) throw InputError(fmt::format("{}: can't be read: {}", name, std::strerror(errno)));
  text.resize(size);
  return text;
}

}  // namespace

OpenFile open_text(const std::string& path) {
  if (path == "-") return {stdin, [](std::FILE* /*file*/) { return 0; }};  // not ours to close
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(fmt::format("{}: there is no such file", path));
  if (std::filesystem::is_directory(status)) {
    throw InputError(fmt::format("{}: is a directory, expected a file", path));
  }
  OpenFile file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) throw InputError(fmt::format("{}: can't be opened: {}", path, std::strerror(errno)));
  return file;
}

std::string read_text(const std::string& path) {
  const OpenFile file = open_text(path);
  if (path == "-") return read_all(file.get(), 0, "standard input");
  std::error_code error;
  std::size_t expected = 0;
  if (std::filesystem::is_regular_file(path, error)) {
    expected = static_cast<std::size_t>(std::filesystem::file_size(path, error));
    if (error) expected = 0;
  }
  return read_all(file.get(), expected, path);
}

}  // namespace rollfix
