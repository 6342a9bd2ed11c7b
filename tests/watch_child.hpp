#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "paths.hpp"
#include "watch_helpers.hpp"

namespace watching {

inline std::vector<std::string> words_of(const std::string& line) {
  std::istringstream words(line);
  return {std::istream_iterator<std::string>(words), {}};
}

/// The program itself, in a process of its own, with its input and output as pipes.
class Child {
 public:
  explicit Child(const std::vector<std::string>& arguments) {
    int in[2] = {-1, -1};
    int out[2] = {-1, -1};
    require(::pipe2(in, O_CLOEXEC) == 0 && ::pipe2(out, O_CLOEXEC) == 0, "pipe");
    std::vector<char*> words = {const_cast<char*>(kProgram)};
    for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    id_ = ::fork();
    require(id_ >= 0, "fork");
    if (id_ == 0) {
      ::dup2(in[0], STDIN_FILENO);
      ::dup2(out[1], STDOUT_FILENO);
      const int nowhere = ::open("/dev/null", O_WRONLY);
      ::dup2(nowhere, STDERR_FILENO);
      ::execv(kProgram, words.data());
      ::_exit(127);
    }
    in_ = Descriptor(in[1]);
    out_ = Descriptor(out[0]);
    ::close(in[0]);
    ::close(out[1]);
  }
  ~Child() {
    if (id_ > 0) {
      ::kill(id_, SIGKILL);
      ::waitpid(id_, nullptr, 0);
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// All of it, however long that takes.
  void send(const std::string& text) const {
    for (std::size_t sent = 0; sent < text.size();) {
      const ssize_t count = ::write(in_.number(), text.data() + sent, text.size() - sent);
      require(count > 0, "write to the program");
      sent += static_cast<std::size_t>(count);
    }
  }
  void close_input() { in_.close(); }
  void signal(int number) const { ::kill(id_, number); }

  /// The next line that it prints, empty at the end.
  std::string next_line() {
    for (;;) {
      const std::size_t end = printed_.find('\n');
      if (end != std::string::npos) {
        const std::string line = printed_.substr(0, end);
        printed_.erase(0, end + 1);
        return line;
      }
      char block[4096];
      pollfd ready = {out_.number(), POLLIN, 0};
      require(::poll(&ready, 1, static_cast<int>(std::chrono::milliseconds(kLongEnough).count())) > 0, "no output");
      const ssize_t count = ::read(out_.number(), block, sizeof block);
      if (count <= 0) return "";
      printed_.append(block, static_cast<std::size_t>(count));
    }
  }

  /// The next event of this name, of JSON lines; null when there is none.
  nlohmann::json next_event(const std::string& name) {
    for (std::string line = next_line(); !line.empty(); line = next_line()) {
      nlohmann::json event = nlohmann::json::parse(line);
      if (event["event"] == name) return event;
    }
    return nullptr;
  }

  /// Its exit code, or -1 when a signal ended it.
  int wait() {
    int status = 0;
    ::wait4(id_, &status, 0, &usage_);
    id_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  /// After wait(): the most memory that it had at once, bytes.
  long peak_memory() const { return usage_.ru_maxrss * 1024; }

 private:
  pid_t id_ = -1;
  Descriptor in_;
  Descriptor out_;
  std::string printed_;
  rusage usage_ = {};
};

}  // namespace watching
