#pragma once

#include <utility>  // Boost.Asio 1.74 needs it and leaves it out

#include <fmt/format.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "rollfix/watch/watcher.hpp"

namespace rollfix::app {

namespace asio = boost::asio;
using boost::system::error_code;

/// What is heard of a growing log.
enum class Heard {
  line,       // one, without its end; of one longer than kLongestLine only the beginning, which is longer as well
  note,       // something to tell people
  dropped,    // the connection, with a line that had begun; it will be tried again
  resumed,    // the connection, in the same log
  restarted,  // another log begins: the file was replaced, or cut back
  ended       // there will be no more
};

/// Who hears it: with the line, or with what to tell people, which may be nothing.
using Hear = std::function<void(Heard what, std::string_view text)>;

struct SourceOptions {
  bool once = false;       // a file: stop at its end; a connection: when it closes
  unsigned baud = 115200;  // of a serial device
  /// While this holds nothing more is read: another log has to come first. None: never.
  std::function<bool()> waits{};
  /// While this holds, and not for ever, a file that was replaced is not left: lines of it wait for another log.
  std::function<bool()> has_waiting{};
};

/// Where the lines of a growing log come from. As long as it lives, they are heard by whoever runs its io_context,
/// which must not run on without it.
class Source {
 public:
  Source() = default;
  virtual ~Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
};

/// Whether what a source says may have begun before it is heard: a terminal, a server.
bool may_begin_midway(const std::string& name);

/// The source that a user names: "-" standard input; "tcp:HOST:PORT" or "tcp:PORT"; else a path, whose kind decides: a
/// terminal is a serial line, a pipe is read to its end, a file is followed. Throws InputError: no such thing; and when
/// it runs, of what can't be read at all and is not worth another try.
std::unique_ptr<Source> open_source(const std::shared_ptr<asio::io_context>& io, const std::string& name,
                                    const SourceOptions& options, Hear hear);

// Its kinds.

/// A descriptor, which stays open, read to its end: standard input.
std::unique_ptr<Source> read_descriptor(asio::io_context& io, int descriptor, const SourceOptions& options, Hear hear);
/// A named pipe: when its writers are gone the next ones continue.
std::unique_ptr<Source> open_named_pipe(asio::io_context& io, const std::string& path, const SourceOptions& options,
                                        Hear hear);
/// A serial device, in raw mode; when it is pulled out it is awaited.
std::unique_ptr<Source> open_serial(asio::io_context& io, const std::string& path, const SourceOptions& options,
                                    Hear hear);
/// A file that something else writes; survives that it is replaced or cut back.
std::unique_ptr<Source> follow_file(asio::io_context& io, const std::string& path, const SourceOptions& options,
                                    Hear hear);
/// A client of "HOST:PORT" or "PORT"; connects again when the connection drops.
std::unique_ptr<Source> connect_tcp(const std::shared_ptr<asio::io_context>& io, const std::string& address,
                                    const SourceOptions& options, Hear hear);

// What they are made of.

/// The descriptor of a file that was opened for reading, never as the controlling terminal; -1 when it can't be.
int try_to_open(const std::string& path, int more_flags = 0);
/// The same; throws InputError when it can't be.
int open_for_reading(const std::string& path, int more_flags = 0);

/// Throws InputError: "roll.csv: can't be read: Input/output error".
[[noreturn]] void refuse_to_read(const std::string& name, const error_code& error);

/// The lines of one of Asio's streams, in constant memory: a line that has begun waits for its end.
template <class Stream>
class StreamSource : public Source {
 protected:
  StreamSource(asio::io_context& io, Hear hear, std::function<bool()> waits)
      : hear_(std::move(hear)), stream_(io), waits_(std::move(waits)), pause_(io) {
    bytes_.reserve(kBlock);
  }

  /// Hears lines until the stream can't go on.
  void read() {
    if (waits_ && waits_()) {
      pause_.expires_after(kPause);
      pause_.async_wait([this](const error_code& /*error*/) { read(); });
      return;
    }
    asio::async_read_until(stream_, asio::dynamic_buffer(bytes_, kLongestLine + 2), '\n',
                           [this](const error_code& error, std::size_t /*length*/) {
                             if (error && error != asio::error::not_found) return stopped(error);
                             error ? hear_beginning() : hear_lines();
                             read();
                           });
  }
  /// The stream is at its end, asio::error::eof, or broken.
  virtual void stopped(const error_code& why) = 0;

  /// There is no more: what is left without a line end is a line as well.
  void end() {
    if (!bytes_.empty()) hear_line(bytes_);
    hear_(Heard::ended, "");
  }
  /// A line that has begun will not be continued.
  void drop_rest() {
    bytes_.clear();
    skipping_ = false;
  }

  Hear hear_;
  Stream stream_;
  bool has_heard_ = false;  // a line

 private:
  static constexpr std::chrono::milliseconds kPause{1};
  static constexpr std::size_t kBlock = 4096;  // read at once, and then looked for signals: a hundred rows or so

  void hear_lines() {
    std::size_t start = 0;
    for (std::size_t end = 0; (end = bytes_.find('\n', start)) != std::string::npos; start = end + 1) {
      hear_line(std::string_view(bytes_).substr(start, end - start));
    }
    bytes_.erase(0, start);
  }
  void hear_line(std::string_view line) {
    if (std::exchange(skipping_, false)) return;
    if (line.ends_with('\r')) line.remove_suffix(1);
    has_heard_ = true;
    hear_(Heard::line, line);
  }
  void hear_beginning() {
    if (!std::exchange(skipping_, true)) hear_(Heard::line, bytes_);
    bytes_.clear();
  }

  std::function<bool()> waits_;
  asio::steady_timer pause_;
  std::string bytes_;
  bool skipping_ = false;  // until the end of a line that was too long
};

/// How long to wait before the next try: longer after each one that failed, so that a cable that was pulled out is
/// noticed soon and a machine that is off is not pestered.
class BackOff {
 public:
  static constexpr std::chrono::milliseconds kFirst{100};
  static constexpr std::chrono::milliseconds kLongest{5000};

  std::chrono::milliseconds next() { return std::exchange(wait_, wait_ * 2 < kLongest ? wait_ * 2 : kLongest); }
  void reset() { wait_ = kFirst; }

 private:
  std::chrono::milliseconds wait_ = kFirst;
};

/// A connection that may drop: it is tried again, with back-off, until it is there.
template <class Stream>
class ReconnectingSource : public StreamSource<Stream> {
 protected:
  /// `once`: the first time that it closes is the end.
  ReconnectingSource(asio::io_context& io, std::string name, const SourceOptions& options, Hear hear)
      : StreamSource<Stream>(io, std::move(hear), options.waits),
        name_(std::move(name)),
        timer_(io),
        once_(options.once) {}

  /// Tries to connect; sooner or later one of the next two follows.
  virtual void connect() = 0;
  void connected() {
    told_.clear();
    tell(was_connected_ ? Heard::resumed : Heard::note, was_connected_ ? "connected again" : "connected");
    go_on();
  }
  void failed(const std::string& why) {
    if (why != std::exchange(told_, why)) tell(Heard::note, why + "; trying again");
    try_later();
  }
  /// For those who connect at once and refuse what can't be opened at all.
  void go_on() {
    was_connected_ = true;
    this->read();
  }

  const std::string name_;
  asio::steady_timer timer_;

 private:
  void stopped(const error_code& why) final {
    this->drop_rest();
    if (once_) return this->end();
    if (std::exchange(this->has_heard_, false)) back_off_.reset();
    tell(Heard::dropped, (why == asio::error::eof ? "it was closed" : why.message()) + "; connecting again");
    try_later();
  }
  void try_later() {
    error_code ignored;
    this->stream_.close(ignored);
    timer_.expires_after(back_off_.next());
    timer_.async_wait([this](const error_code& /*error*/) { connect(); });
  }
  void tell(Heard what, const std::string& text) { this->hear_(what, name_ + ": " + text); }

  BackOff back_off_;
  bool once_;
  bool was_connected_ = false;
  std::string told_;  // why the last try failed: told once and not at every try
};

}  // namespace rollfix::app
