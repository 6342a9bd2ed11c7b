#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

#include "rollfix/watch_stop.hpp"

namespace rollfix::app {

/// What came of waiting for bytes.
enum class Arrival {
  bytes,      // some
  nothing,    // none before the deadline, or the user wants to stop
  dropped,    // the connection broke off; it will be tried again
  resumed,    // it is there again, and goes on where it was
  restarted,  // another log begins: the file was replaced, or cut back
  ended       // there will be no more
};

struct Arrived {
  Arrival what = Arrival::nothing;
  std::size_t count = 0;  // of bytes
  std::string note;       // for people, where there is something to tell
};

/// Where the bytes of a growing log come from. Each kind of transport is one of these.
class ByteSource {
 public:
  ByteSource() = default;
  virtual ~ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  /// Waits for bytes until the deadline and writes at most `size` of them to `block`. Throws InputError: what can't be
  /// read at all and is not worth another try.
  virtual Arrived read(char* block, std::size_t size, Deadline deadline) = 0;

  /// Whether a line without a line end, when the source has ended, is one all the same.
  virtual bool ends_whole() const { return true; }
};

struct SourceOptions {
  bool once = false;       // a file: stop at its end; a connection: when it closes
  unsigned baud = 115200;  // of a serial device
};

/// The source that a user names: "-" standard input; "tcp:HOST:PORT" or "tcp:PORT"; else a path, whose kind decides: a
/// terminal is a serial line, a pipe is read to its end, a file is followed. Throws InputError: no such thing.
std::unique_ptr<ByteSource> open_source(const std::string& name, const SourceOptions& options, const StopSignal& stop);

// Its kinds, each in a file of its own.

/// A descriptor that is read to its end and then over: standard input.
std::unique_ptr<ByteSource> read_descriptor(int descriptor, const StopSignal& stop);
/// A named pipe: when its writers are gone the next ones continue.
std::unique_ptr<ByteSource> open_named_pipe(const std::string& path, bool once, const StopSignal& stop);
/// A file that something else writes; survives that it is replaced or cut back.
std::unique_ptr<ByteSource> follow_file(const std::string& path, bool once, const StopSignal& stop);
/// A serial device, in raw mode; when it is pulled out it is awaited.
std::unique_ptr<ByteSource> open_serial(const std::string& path, const SourceOptions& options, const StopSignal& stop);
/// A client of "HOST:PORT" or "PORT"; connects again when the connection drops.
std::unique_ptr<ByteSource> connect_tcp(const std::string& address, bool once, const StopSignal& stop);

}  // namespace rollfix::app
