#pragma once

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>

#include "rollfix/watch_descriptor.hpp"
#include "rollfix/watch_lines.hpp"

namespace watching {

using rollfix::app::Clock;
using rollfix::app::Descriptor;
using rollfix::app::Heard;

constexpr std::chrono::seconds kLongEnough{20};  // for what is sure to come, on a busy machine

inline void require(bool condition, const char* what) {
  if (!condition) throw std::runtime_error(what);
}

inline void write_all(const Descriptor& to, const std::string& text) {
  require(::write(to.number(), text.data(), text.size()) == static_cast<ssize_t>(text.size()), "write");
}

/// Hears a source, one thing after the other.
class Ear {
 public:
  explicit Ear(const std::string& name, const rollfix::app::SourceOptions& options = {})
      : bytes_(rollfix::app::open_source(name, options, stop_)), lines_(*bytes_) {}
  explicit Ear(int descriptor) : bytes_(rollfix::app::read_descriptor(descriptor, stop_)), lines_(*bytes_) {}

  /// The next line, or what happened in brackets. Notes alone are passed over, but kept.
  std::string next() {
    const auto deadline = Clock::now() + kLongEnough;
    for (;;) {
      const std::string heard = at(deadline);
      if (heard != "(nothing)" || Clock::now() >= deadline || stop_.came()) return heard;
    }
  }

  /// The same without waiting for what is not there yet.
  std::string now() { return at(Clock::now()); }

  const std::string& note() const { return note_; }  // the last one
  const rollfix::app::StopSignal& stop() const { return stop_; }

 private:
  std::string at(rollfix::app::Deadline deadline) {
    const Heard heard = lines_.next(deadline);
    if (!lines_.note().empty()) note_ = lines_.note();
    switch (heard) {
      case Heard::line:
        return lines_.line().too_long ? "(too long)" : std::string(lines_.line().text);
      case Heard::nothing:
        return "(nothing)";
      case Heard::dropped:
        return "(dropped)";
      case Heard::resumed:
        return "(resumed)";
      case Heard::restarted:
        return "(restarted)";
      case Heard::ended:
        break;
    }
    return "(ended)";
  }

  rollfix::app::StopSignal stop_;
  std::unique_ptr<rollfix::app::ByteSource> bytes_;
  rollfix::app::LineSource lines_;
  std::string note_;
};

/// A TCP server on a free port of this machine, for one client at a time.
class Server {
 public:
  Server() : listening_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    address_.sin_family = AF_INET;
    address_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    auto* address = reinterpret_cast<sockaddr*>(&address_);
    socklen_t size = sizeof address_;
    require(::bind(listening_.number(), address, size) == 0, "bind");
    require(::listen(listening_.number(), 4) == 0, "listen");
    require(::getsockname(listening_.number(), address, &size) == 0, "getsockname");
  }

  std::string name() const { return "tcp:127.0.0.1:" + port(); }
  std::string port() const { return std::to_string(ntohs(address_.sin_port)); }
  void accept() { client_ = Descriptor(::accept4(listening_.number(), nullptr, nullptr, SOCK_CLOEXEC)); }
  void send(const std::string& text) const { write_all(client_, text); }
  void drop() { client_.close(); }
  /// No more clients.
  void close() {
    drop();
    listening_.close();
  }

 private:
  Descriptor listening_;
  Descriptor client_;
  sockaddr_in address_ = {};
};

/// A serial line: what is sent comes out of the device `name()`.
class SerialLine {
 public:
  SerialLine() : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    require(::grantpt(master_.number()) == 0 && ::unlockpt(master_.number()) == 0, "no pseudo terminal");
    name_ = ::ptsname(master_.number());
  }

  const std::string& name() const { return name_; }
  void send(const std::string& text) const { write_all(master_, text); }
  void pull_out() { master_.close(); }

  /// Whether the device sent anything back.
  bool has_echo() const {
    pollfd back = {master_.number(), POLLIN, 0};
    return ::poll(&back, 1, 0) > 0;
  }
  termios settings() const {
    termios found = {};
    require(::tcgetattr(master_.number(), &found) == 0, "tcgetattr");
    return found;
  }

 private:
  Descriptor master_;
  std::string name_;
};

}  // namespace watching
