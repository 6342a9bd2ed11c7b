#include "rollfix/output/files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>

#include "rollfix/error.hpp"

namespace rollfix::app {
namespace {

namespace fs = std::filesystem;

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

[[noreturn]] void fail(const std::string& path, const std::string& action, int error) {
  throw InputError(fmt::format("{}: can't be {}: {}", path, action, std::strerror(error)));
}

fs::file_status status_of(const std::string& path) {
  std::error_code ignored;
  return fs::status(path, ignored);
}

/// A file as opposed to a device or a pipe, or nothing yet.
bool is_file(const std::string& path) {
  const fs::file_status status = status_of(path);
  return !fs::exists(status) || fs::is_regular_file(status);
}

void write_bytes(const std::string& path, const std::string& bytes, const std::string& shown) {
  File file(std::fopen(path.c_str(), "wb"));
  if (!file) fail(shown, "written", errno);
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
  if (!written || std::fflush(file.get()) != 0) fail(shown, "written", errno);
}

void replace(const OutputFile& file) {
  std::error_code error;
  // A link stays a link.
  const fs::path target =
      fs::is_symlink(file.path, error) ? fs::weakly_canonical(file.path, error) : fs::path(file.path);
  fs::path temporary = target;
  temporary.replace_filename(fmt::format(".{}.{}", target.filename().string(), getpid()));
  try {
    write_bytes(temporary.string(), file.bytes, file.path);
    if (std::rename(temporary.c_str(), target.c_str()) != 0) fail(file.path, "written", errno);
  } catch (const InputError&) {
    std::remove(temporary.c_str());
    throw;
  }
}

}  // namespace

bool holds(const OutputFile& file) {
  if (!fs::is_regular_file(status_of(file.path))) return false;
  const File there(std::fopen(file.path.c_str(), "rb"));
  if (!there) return false;
  std::string bytes(file.bytes.size() + 1, '\0');
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), there.get()));
  return bytes == file.bytes;
}

void require_writable(const std::string& path, bool force) {
  if (path.empty()) throw InputError("-o: expected the name of a file, found nothing");
  const fs::file_status status = status_of(path);
  if (fs::is_directory(status)) throw InputError(fmt::format("{}: is a directory, expected the name of a file", path));
  if (fs::is_regular_file(status) && !force) {
    throw InputError(fmt::format("{}: exists already; give another name, or --force to replace it", path));
  }
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty() && !fs::is_directory(status_of(folder.string()))) {
    throw InputError(fmt::format("{}: there is no folder {}; make it first", path, folder.string()));
  }
}

void write_files(const std::vector<OutputFile>& files) {
  for (const OutputFile& file : files) {
    if (is_file(file.path)) {
      replace(file);
    } else {
      write_bytes(file.path, file.bytes, file.path);
    }
  }
}

}  // namespace rollfix::app
