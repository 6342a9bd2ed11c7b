#include "rollfix/output/report.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <deque>
#include <filesystem>
#include <memory>
#include <set>
#include <system_error>
#include <utility>

#include "rollfix/error.hpp"
#include "work/crew.hpp"

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

/// `shown`: what the user called it.
void write_bytes(File file, const std::string& bytes, const std::string& shown) {
  if (!file) fail(shown, "written", errno);
  bool written = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size() && std::fflush(file.get()) == 0;
  // A name that outlives a power cut must not name less than all of it. Pipes and devices know no such thing.
  written = written && (::fsync(::fileno(file.get())) == 0 || errno == EINVAL || errno == ENOTSUP || errno == EROFS);
  if (!written) fail(shown, "written", errno);
  if (std::fclose(file.release()) != 0) fail(shown, "written", errno);  // some disks say only now that they are full
}

[[noreturn]] void refuse_existing(const std::string& path) {
  throw InputError(fmt::format("{}: exists already; give another name, or --force to replace it", path));
}

/// A name in the same folder that nobody can foresee, however long the file's own is.
fs::path name_beside(const fs::path& target) {
  std::array<unsigned char, 12> random{};
  if (::getentropy(random.data(), random.size()) != 0) fail(target.string(), "written", errno);
  return target.parent_path() / fmt::format(".rollfix-{:02x}", fmt::join(random, ""));
}

/// A new file: what stands there already, a link to elsewhere as well, is not opened.
File create(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  return File(descriptor < 0 ? nullptr : ::fdopen(descriptor, "wb"));
}

/// 0, or the error.
int move_over(const fs::path& from, const fs::path& to) {
  return std::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

/// 0, or the error. Of several programs that do so one succeeds, the others get EEXIST.
int rename_to_nothing(const fs::path& from, const fs::path& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return errno;
  // The file system does not know that.
  if (::link(from.c_str(), to.c_str()) != 0) return errno;
  ::unlink(from.c_str());
  return 0;
}

/// A file that is written beside its place, and gone again unless it takes that.
class Waiting {
 public:
  explicit Waiting(const OutputFile& file)
      : shown_(file.path), target_(target_of(file.path)), beside_(name_beside(target_)), replaces_(file.replace) {
    File opened = create(beside_);
    if (!opened) fail(shown_, "written", errno);
    try {
      write_bytes(std::move(opened), file.bytes, shown_);
      if (replaces_) keep_permissions();
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
    const int error = replaces_ ? move_over(beside_, target_) : rename_to_nothing(beside_, target_);
    if (error == EEXIST && !replaces_) refuse_existing(shown_);
    if (error != 0) fail(shown_, "written", error);
    is_in_place_ = true;
  }
  /// Where another one could not: what replaced nothing goes again.
  void leave_place() const {
    if (is_in_place_ && !replaces_) std::remove(target_.c_str());
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
  bool replaces_;
  bool is_in_place_ = false;
};

/// Throws InputError: one of them would be written over another.
void require_different(const std::vector<OutputFile>& files) {
  std::set<fs::path> names;
  for (const OutputFile& file : files) {
    if (!is_file(file.path)) continue;
    std::error_code ignored;
    if (!names.insert(fs::weakly_canonical(fs::absolute(file.path, ignored), ignored)).second) {
      throw InputError(fmt::format("{}: two files would be written to it, expected a name for each", file.path));
    }
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
    refuse_existing(path);
  }
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty() && !fs::is_directory(status_of(folder.string()))) {
    throw InputError(fmt::format("{}: there is no folder {}; make it first", path, folder.string()));
  }
}

void write_files(const std::vector<OutputFile>& files) {
  require_different(files);
  for (const OutputFile& file : files) {
    if (!is_file(file.path)) write_bytes(File(std::fopen(file.path.c_str(), "wb")), file.bytes, file.path);
  }
  const SignalsWait wait;
  std::deque<Waiting> ready;
  for (const OutputFile& file : files) {
    if (is_file(file.path)) ready.emplace_back(file);
  }
  try {
    for (Waiting& file : ready) file.take_place();
  } catch (...) {
    for (const Waiting& file : ready) file.leave_place();
    throw;
  }
}

}  // namespace rollfix::app
