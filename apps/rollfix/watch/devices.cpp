// What is read as it comes: standard input, named pipes, and serial devices.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <boost/asio/serial_port.hpp>

#include "rollfix/error.hpp"
#include "rollfix/watch/source.hpp"

namespace rollfix::app {
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

}  // namespace rollfix::app
