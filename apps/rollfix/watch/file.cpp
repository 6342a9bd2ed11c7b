// A file that something else is writing: its new bytes, as they come.
#include <sys/stat.h>
#include <unistd.h>

#include "rollfix/watch/source.hpp"

namespace rollfix::app {
namespace {

// Files don't tell when they grow, and on network drives nothing tells for them. Looking this often costs next to
// nothing and is faster than an eye.
constexpr std::chrono::milliseconds kLookAgain{20};
// Lines of a file that was replaced wait for another log's no longer than so many looks: a second.
constexpr int kMostLooksBack = 50;

class FollowedFile final : public StreamSource<asio::posix::stream_descriptor> {
 public:
  FollowedFile(asio::io_context& io, const std::string& path, const SourceOptions& options, Hear hear)
      : StreamSource(io, std::move(hear), options.waits),
        path_(path),
        once_(options.once),
        has_waiting_(options.has_waiting),
        replacement_(io),
        timer_(io) {
    stream_.assign(open_for_reading(path));
    read();
  }

 private:
  void stopped(const error_code& why) override {
    if (why != asio::error::eof) refuse_to_read(path_, why);
    if (once_) return end();
    if (replacement_.is_open() && stays()) return look_again();
    if (replacement_.is_open()) {
      error_code ignored;
      stream_.close(ignored);
      stream_.assign(replacement_.release());  // moved it could not be assigned to again
      return start_again("was replaced; reading the new one from its start");
    }
    if (find_replacement()) return read();  // what was written to the old file before it was replaced
    if (was_cut_back()) {
      if (stays()) return look_again();
      ::lseek(stream_.native_handle(), 0, SEEK_SET);
      return start_again("was cut back; reading it from its start");
    }
    look_again();
  }

  void look_again() {
    timer_.expires_after(kLookAgain);
    timer_.async_wait([this](const error_code& /*error*/) { read(); });
  }

  bool stays() { return has_waiting_ && has_waiting_() && ++looks_back_ < kMostLooksBack; }

  /// Whether there is another file of the same name by now. One that is gone again, or can't be read yet, is not.
  bool find_replacement() {
    struct stat ours = {};
    struct stat theirs = {};
    if (::fstat(stream_.native_handle(), &ours) != 0 || ::stat(path_.c_str(), &theirs) != 0) return false;
    if (ours.st_dev == theirs.st_dev && ours.st_ino == theirs.st_ino) return false;
    const int descriptor = try_to_open(path_);
    if (descriptor >= 0) replacement_.assign(descriptor);
    return descriptor >= 0;
  }

  bool was_cut_back() {
    struct stat now = {};
    return ::fstat(stream_.native_handle(), &now) == 0 && now.st_size < ::lseek(stream_.native_handle(), 0, SEEK_CUR);
  }

  void start_again(const std::string& why) {
    drop_rest();
    looks_back_ = 0;
    hear_(Heard::restarted, path_ + " " + why);
    read();
  }

  std::string path_;
  bool once_;
  std::function<bool()> has_waiting_;
  int looks_back_ = 0;
  asio::posix::stream_descriptor replacement_;
  asio::steady_timer timer_;
};

}  // namespace

std::unique_ptr<Source> follow_file(asio::io_context& io, const std::string& path, const SourceOptions& options,
                                    Hear hear) {
  return std::make_unique<FollowedFile>(io, path, options, std::move(hear));
}

}  // namespace rollfix::app
