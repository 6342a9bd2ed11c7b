#pragma once

#include <unistd.h>

#include <cstddef>
#include <utility>

#include "rollfix/watch_source.hpp"

namespace rollfix::app {

/// An open file descriptor, closed in the end; -1: none.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    if (this != &other) {
      close();
      number_ = std::exchange(other.number_, -1);
    }
    return *this;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  bool is_open() const { return number_ >= 0; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_ = -1;
};

/// What one read() gave, waiting for it until the deadline.
struct ReadResult {
  enum class What { bytes, nothing, end, error } what = What::nothing;
  std::size_t count = 0;
  int error = 0;  // errno
};

ReadResult read_when_ready(int descriptor, char* block, std::size_t size, Deadline deadline, const StopSignal& stop);

/// Opens a file for reading, never as the controlling terminal. Closed when that fails; errno says why.
Descriptor open_for_reading(const std::string& path, int more_flags = 0);

/// Throws the InputError for an errno: "roll.csv: can't be read: Input/output error".
[[noreturn]] void refuse_to_read(const std::string& name, int error);

}  // namespace rollfix::app
