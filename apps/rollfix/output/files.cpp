#include "rollfix/output/files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <deque>
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
  bool written = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size() && std::fflush(file.get()) == 0;
  // A name that outlives a power cut must not name less than all of it. Pipes and devices know no such thing.
  written = written && (::fsync(::fileno(file.get())) == 0 || errno == EINVAL || errno == ENOTSUP || errno == EROFS);
  if (!written) fail(shown, "written", errno);
  if (std::fclose(file.release()) != 0) fail(shown, "written", errno);  // some disks say only now that they are full
}

/// As long as it lives signals wait, so that none ends the program with files half written.
class SignalsWait {
 public:
  SignalsWait() {
    sigset_t all;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_BLOCK, &all, &before_);
  }
  ~SignalsWait() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;

 private:
  sigset_t before_ = {};
};

/// A file that is written beside its place, and gone again unless it takes that.
class Waiting {
 public:
  explicit Waiting(const OutputFile& file) : shown_(file.path), target_(target_of(file.path)), beside_(target_) {
    beside_.replace_filename(fmt::format(".{}.{}", target_.filename().string(), getpid()));
    try {
      write_bytes(beside_.string(), file.bytes, shown_);
      keep_permissions();
    } catch (...) {
      std::remove(beside_.c_str());
      throw;
    }
  }
  ~Waiting() {
    if (!is_in_place_) std::remove(beside_.c_str());
  }
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;

  void take_place() {
    if (std::rename(beside_.c_str(), target_.c_str()) != 0) fail(shown_, "written", errno);
    is_in_place_ = true;
  }

 private:
  /// A link stays a link.
  static fs::path target_of(const std::string& path) {
    std::error_code error;
    return fs::is_symlink(path, error) ? fs::weakly_canonical(path, error) : fs::path(path);
  }

  /// What nobody else may read stays so when it is replaced.
  void keep_permissions() const {
    std::error_code ignored;
    const fs::file_status before = fs::status(target_, ignored);
    if (fs::exists(before)) fs::permissions(beside_, before.permissions(), ignored);
  }

  std::string shown_;
  fs::path target_;
  fs::path beside_;
  bool is_in_place_ = false;
};

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
    if (!is_file(file.path)) write_bytes(file.path, file.bytes, file.path);
  }
  const SignalsWait wait;
  std::deque<Waiting> ready;
  for (const OutputFile& file : files) {
    if (is_file(file.path)) ready.emplace_back(file);
  }
  for (Waiting& file : ready) file.take_place();
}

}  // namespace rollfix::app
