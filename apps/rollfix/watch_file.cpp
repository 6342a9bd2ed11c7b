// A file that something else is writing: its new bytes, as they come.
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "rollfix/watch_descriptor.hpp"
#include "rollfix/watch_source.hpp"

namespace rollfix::app {
namespace {

// Files don't tell when they grow, and on network drives nothing tells for them. Looking this often costs next to
// nothing and is faster than an eye.
constexpr std::chrono::milliseconds kLookAgain{20};

class FollowedFile : public ByteSource {
 public:
  FollowedFile(std::string path, bool once, const StopSignal& stop) : path_(std::move(path)), once_(once), stop_(stop) {
    file_ = open_for_reading(path_);
    if (!file_.is_open()) refuse_to_read(path_, errno);
  }

  Arrived read(char* block, std::size_t size, Deadline deadline) override {
    for (;;) {
      // Looked at before the bytes: what was written to the old file before it was replaced is still read.
      Descriptor replacement = once_ ? Descriptor() : replaced_by();
      const ssize_t count = ::read(file_.number(), block, size);
      if (count < 0) refuse_to_read(path_, errno);
      if (count > 0) return {Arrival::bytes, static_cast<std::size_t>(count), ""};
      if (once_) return {Arrival::ended, 0, ""};
      if (replacement.is_open()) return replace(std::move(replacement));
      if (was_cut_back()) return start_again();
      if (stop_.came() || Clock::now() >= deadline) return {};
      stop_.sleep(std::min(deadline, Clock::now() + kLookAgain));
    }
  }

  // Somebody may be in the middle of the last line; of a file that is only read once nobody is.
  bool ends_whole() const override { return once_; }

 private:
  /// Another file of the same name, where there is one by now.
  Descriptor replaced_by() const {
    struct stat ours = {};
    struct stat theirs = {};
    if (::fstat(file_.number(), &ours) != 0 || ::stat(path_.c_str(), &theirs) != 0) return Descriptor();
    if (ours.st_dev == theirs.st_dev && ours.st_ino == theirs.st_ino) return Descriptor();
    return open_for_reading(path_);
  }

  bool was_cut_back() const {
    struct stat now = {};
    return ::fstat(file_.number(), &now) == 0 && now.st_size < ::lseek(file_.number(), 0, SEEK_CUR);
  }

  Arrived replace(Descriptor replacement) {
    file_ = std::move(replacement);
    return {Arrival::restarted, 0, path_ + " was replaced; reading the new one from its start"};
  }

  Arrived start_again() {
    ::lseek(file_.number(), 0, SEEK_SET);
    return {Arrival::restarted, 0, path_ + " was cut back; reading it from its start"};
  }

  std::string path_;
  bool once_;
  const StopSignal& stop_;
  Descriptor file_;
};

}  // namespace

std::unique_ptr<ByteSource> follow_file(const std::string& path, bool once, const StopSignal& stop) {
  return std::make_unique<FollowedFile>(path, once, stop);
}

}  // namespace rollfix::app
