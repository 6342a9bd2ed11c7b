#pragma once

#include <utility>  // before Boost.Asio

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <boost/asio/executor_work_guard.hpp>
#include <cstdlib>
#include <deque>
#include <memory>
#include <stdexcept>
#include <string>

#include "rollfix/watch/source.hpp"

namespace watching {

namespace asio = boost::asio;
using rollfix::app::Heard;

constexpr std::chrono::seconds kLongEnough{20};   // for what is sure to come, on a busy machine
constexpr std::chrono::milliseconds kAWhile{60};  // in which all comes that is there, and files are looked at again

inline void require(bool condition, const char* what) {
  if (!condition) throw std::runtime_error(what);
}

/// An open file descriptor, closed in the end; -1: none.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }

 private:
  int number_ = -1;
};

inline void write_all(const Descriptor& to, const std::string& text) {
  require(::write(to.number(), text.data(), text.size()) == static_cast<ssize_t>(text.size()), "write");
}

inline Descriptor writer_of(const std::string& path) { return Descriptor(::open(path.c_str(), O_WRONLY | O_CLOEXEC)); }

/// Both ends of a pipe.
struct Pipe {
  Pipe() {
    int ends[2] = {-1, -1};
    require(::pipe2(ends, O_CLOEXEC) == 0, "pipe");
    out = Descriptor(ends[0]);
    in = Descriptor(ends[1]);
  }
  Descriptor out;
  Descriptor in;
};

/// Hears a source, one thing after the other.
class Ear {
 public:
  explicit Ear(const std::string& name, const rollfix::app::SourceOptions& options = {})
      : source_(rollfix::app::open_source(io_, name, options, hear())) {}
  explicit Ear(int descriptor) : source_(rollfix::app::read_descriptor(*io_, descriptor, {}, hear())) {}

  /// The next line, or what happened in brackets. Notes alone are passed over, but kept.
  std::string next() { return within(kLongEnough); }

  /// The same without waiting for what is not there yet.
  std::string now() { return within(kAWhile); }

  /// What is told to people next; empty: nothing.
  std::string next_note() {
    note_.clear();
    run_until(kLongEnough, [this] { return !note_.empty(); });
    return note_;
  }

  /// Takes in what is there.
  void listen() { io_->poll(); }

  const std::string& note() const { return note_; }  // the last one

 private:
  rollfix::app::Hear hear() {
    return [this](Heard what, std::string_view text) {
      if (what != Heard::line && !text.empty()) note_ = text;
      const char* const words[] = {"", "", "(dropped)", "(resumed)", "(restarted)", "(ended)"};
      if (what == Heard::line) {
        heard_.emplace_back(text.size() > rollfix::app::kLongestLine ? "(too long)" : text);
      } else if (what != Heard::note) {
        heard_.emplace_back(words[static_cast<int>(what)]);
      }
    };
  }

  template <class Condition>
  void run_until(std::chrono::milliseconds longest, Condition is_enough) {
    const auto deadline = std::chrono::steady_clock::now() + longest;
    while (!is_enough() && std::chrono::steady_clock::now() < deadline) io_->run_one_until(deadline);
  }

  std::string within(std::chrono::milliseconds time) {
    run_until(time, [this] { return !heard_.empty(); });
    if (heard_.empty()) return "(nothing)";
    std::string first = heard_.front();
    if (first != "(ended)") heard_.pop_front();
    return first;
  }

  std::deque<std::string> heard_;
  std::string note_;
  std::shared_ptr<asio::io_context> io_ = std::make_shared<asio::io_context>();
  asio::executor_work_guard<asio::io_context::executor_type> work_ = asio::make_work_guard(*io_);
  std::unique_ptr<rollfix::app::Source> source_;
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
  /// Fails where nobody connects, rather than waiting for ever.
  void accept() {
    pollfd waiting{listening_.number(), POLLIN, 0};
    const auto longest = std::chrono::milliseconds(kLongEnough).count();
    require(::poll(&waiting, 1, static_cast<int>(longest)) == 1, "nobody connects");
    client_ = Descriptor(::accept4(listening_.number(), nullptr, nullptr, SOCK_CLOEXEC));
  }
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
