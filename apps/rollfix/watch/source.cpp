#include "rollfix/watch/source.hpp"

#include <sys/stat.h>

#include <fcntl.h>
#include <unistd.h>
#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/serial_port.hpp>
#include <cerrno>
#include <thread>

#include "rollfix/arguments/arguments.hpp"
#include "rollfix/error.hpp"

// What lines are read from: a file that something else is writing, its new bytes as they come; standard input, named
// pipes and serial devices; a server that sends a log over TCP.
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

namespace {

using asio::serial_port_base;

/// Asio makes what it reads non-blocking for all who have it open as well, which of a terminal may be those who print.
/// So pipes and devices are opened anew. A file has a place in it that must be kept, a socket can't be opened.
int of_our_own(int descriptor) {
  struct stat status = {};
  if (::fstat(descriptor, &status) == 0 && (S_ISFIFO(status.st_mode) || S_ISCHR(status.st_mode))) {
    const int opened = try_to_open(fmt::format("/dev/fd/{}", descriptor), O_NONBLOCK);
    if (opened >= 0) return opened;
  }
  return ::fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
}

class StandardInput final : public StreamSource<asio::posix::stream_descriptor> {
 public:
  StandardInput(asio::io_context& io, int descriptor, const SourceOptions& options, Hear hear)
      : StreamSource(io, std::move(hear), options.waits) {
    error_code error;
    stream_.assign(of_our_own(descriptor), error);
    if (error) refuse_to_read("standard input", error);
    read();
  }

 private:
  void stopped(const error_code& why) override {
    if (why != asio::error::eof) refuse_to_read("standard input", why);
    end();
  }
};

class NamedPipe final : public StreamSource<asio::posix::stream_descriptor> {
 public:
  NamedPipe(asio::io_context& io, std::string path, const SourceOptions& options, Hear hear)
      : StreamSource(io, std::move(hear), options.waits), path_(std::move(path)), once_(options.once) {
    open();
  }

 private:
  /// Before the first writer a pipe is not ready; it is at its end when the last one is gone.
  void open() {
    const int opened = open_for_reading(path_, O_NONBLOCK);  // before it is closed: the next writer may be there
    error_code ignored;
    stream_.close(ignored);
    stream_.assign(opened);
    stream_.async_wait(asio::posix::stream_descriptor::wait_read, [this](const error_code& /*error*/) {
      if (std::exchange(away_, false)) hear_(Heard::resumed, path_ + ": another writer continues");
      read();
    });
  }

  void stopped(const error_code& why) override {
    if (why != asio::error::eof) refuse_to_read(path_, why);
    if (once_) return end();
    drop_rest();
    away_ = true;
    hear_(Heard::dropped, path_ + ": its writer is gone; waiting for the next one");
    open();
  }

  std::string path_;
  bool once_;
  bool away_ = false;  // the writer
};

/// 8 data bits, no parity, one stop bit, nothing translated.
class SerialSource final : public ReconnectingSource<asio::serial_port> {
 public:
  SerialSource(asio::io_context& io, const std::string& path, const SourceOptions& options, Hear hear)
      : ReconnectingSource(io, path, options, std::move(hear)), baud_(options.baud) {
    const std::string failure = open();
    if (!failure.empty()) throw InputError(fmt::format("{}: {}", path, failure));
    go_on();
  }

 private:
  void connect() override {
    const std::string failure = open();
    failure.empty() ? connected() : failed(failure);
  }

  /// Empty, or what went wrong.
  std::string open() {
    error_code error;
    stream_.open(name_, error);  // raw mode, and never the controlling terminal
    if (error) return "can't be opened: " + error.message();
    stream_.set_option(serial_port_base::baud_rate(baud_), error);
    if (error) return fmt::format("--baud {}: {}", baud_, error.message());
    stream_.set_option(serial_port_base::flow_control(serial_port_base::flow_control::none), error);
    stream_.set_option(serial_port_base::stop_bits(serial_port_base::stop_bits::one), error);
    return "";
  }

  unsigned baud_;
};

}  // namespace

std::unique_ptr<Source> read_descriptor(asio::io_context& io, int descriptor, const SourceOptions& options, Hear hear) {
  return std::make_unique<StandardInput>(io, descriptor, options, std::move(hear));
}

std::unique_ptr<Source> open_named_pipe(asio::io_context& io, const std::string& path, const SourceOptions& options,
                                        Hear hear) {
  return std::make_unique<NamedPipe>(io, path, options, std::move(hear));
}

std::unique_ptr<Source> open_serial(asio::io_context& io, const std::string& path, const SourceOptions& options,
                                    Hear hear) {
  return std::make_unique<SerialSource>(io, path, options, std::move(hear));
}

namespace {

using asio::ip::tcp;

constexpr std::chrono::seconds kConnectTimeout{3};  // a host that says nothing at all is tried again

struct TcpAddress {
  std::string host = "127.0.0.1";
  std::string port;
};

/// "PORT", "HOST:PORT", "[IPV6]:PORT".
TcpAddress read_address(const std::string& text) {
  TcpAddress address;
  const std::size_t mark = text.rfind(':');
  address.port = text.substr(mark == std::string::npos ? 0 : mark + 1);
  if (mark != std::string::npos && mark > 0) address.host = text.substr(0, mark);
  std::string& host = address.host;
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  constexpr std::size_t kLastPort = 65535;
  const std::string what = fmt::format("--log tcp:{}: the port", text);
  if (read_count(address.port, what, 1) > kLastPort) {
    throw InputError(
        fmt::format("{} is {}, expected 1 to {}, as in tcp:localhost:7000", what, address.port, kLastPort));
  }
  return address;
}

class TcpSource final : public ReconnectingSource<tcp::socket> {
 public:
  TcpSource(const std::shared_ptr<asio::io_context>& io, const std::string& address, const SourceOptions& options,
            Hear hear)
      : ReconnectingSource(*io, "tcp:" + address, options, std::move(hear)), io_(io), address_(read_address(address)) {
    look_up();
  }

 private:
  void connect() override { look_up(); }

  /// Looks the name up in a thread that nobody waits for: that can take a minute and can't be broken off, and what
  /// async_resolve() has begun would be waited for when its io_context goes.
  void look_up() {
    std::thread([this, io = io_, address = address_] {
      error_code error;
      asio::io_context own;
      const auto found = tcp::resolver(own).resolve(address.host, address.port, error);
      asio::post(*io, [this, error, found] { looked_up(error, found); });  // not run where the source is gone
    }).detach();
  }

  void looked_up(const error_code& error, const tcp::resolver::results_type& found) {
    if (error && !was_known_) {
      throw InputError(fmt::format("{}: the host '{}' can't be found: {}", name_, address_.host, error.message()));
    }
    if (error) return failed("can't connect: " + error.message());
    was_known_ = true;
    timer_.expires_after(kConnectTimeout);
    timer_.async_wait([this](const error_code& /*error*/) {
      if (timer_.expiry() <= asio::steady_timer::clock_type::now()) stream_.close();
    });
    asio::async_connect(stream_, found, [this](const error_code& result, const tcp::endpoint& /*to*/) {
      timer_.expires_at(asio::steady_timer::time_point::max());
      if (result == asio::error::operation_aborted) return failed("no answer");
      if (result) return failed("can't connect: " + result.message());
      error_code ignored;
      stream_.set_option(asio::socket_base::keep_alive(true), ignored);
      connected();
    });
  }

  std::shared_ptr<asio::io_context> io_;
  TcpAddress address_;
  bool was_known_ = false;
};

}  // namespace

std::unique_ptr<Source> connect_tcp(const std::shared_ptr<asio::io_context>& io, const std::string& address,
                                    const SourceOptions& options, Hear hear) {
  return std::make_unique<TcpSource>(io, address, options, std::move(hear));
}

namespace {

constexpr std::string_view kTcp = "tcp:";

error_code last_error() { return {errno, boost::system::generic_category()}; }

bool is_terminal(const std::string& path) {
  const int device = try_to_open(path, O_NONBLOCK);
  if (device < 0) return false;
  const bool answer = ::isatty(device) == 1;
  ::close(device);
  return answer;
}

}  // namespace

int try_to_open(const std::string& path, int more_flags) {
  return ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | more_flags);
}

int open_for_reading(const std::string& path, int more_flags) {
  const int descriptor = try_to_open(path, more_flags);
  if (descriptor < 0) refuse_to_read(path, last_error());
  return descriptor;
}

void refuse_to_read(const std::string& name, const error_code& error) {
  throw InputError(fmt::format("{}: can't be read: {}", name, error.message()));
}

bool may_begin_midway(const std::string& name) {
  struct stat status = {};
  return name.starts_with(kTcp) || (name != "-" && ::stat(name.c_str(), &status) == 0 && S_ISCHR(status.st_mode));
}

std::unique_ptr<Source> open_source(const std::shared_ptr<asio::io_context>& io, const std::string& name,
                                    const SourceOptions& options, Hear hear) {
  if (name == "-") return read_descriptor(*io, STDIN_FILENO, options, std::move(hear));
  if (name.starts_with(kTcp)) return connect_tcp(io, name.substr(kTcp.size()), options, std::move(hear));
  struct stat status = {};
  if (::stat(name.c_str(), &status) != 0) {
    if (errno != ENOENT) refuse_to_read(name, last_error());
    throw InputError(
        fmt::format("{}: no such file; to wait for a log, create the file empty, or use tcp:HOST:PORT", name));
  }
  if (S_ISDIR(status.st_mode)) {
    throw InputError(fmt::format("{}: is a folder; expected a file, a serial device, - or tcp:HOST:PORT", name));
  }
  if (S_ISFIFO(status.st_mode)) return open_named_pipe(*io, name, options, std::move(hear));
  if (S_ISCHR(status.st_mode) && is_terminal(name)) return open_serial(*io, name, options, std::move(hear));
  return follow_file(*io, name, options, std::move(hear));
}

}  // namespace rollfix::app
