// Sources that are plain descriptors: standard input and named pipes.
#include <fcntl.h>

#include <cerrno>
#include <utility>

#include "rollfix/watch_descriptor.hpp"
#include "rollfix/watch_source.hpp"

namespace rollfix::app {
namespace {

class DescriptorSource : public ByteSource {
 public:
  DescriptorSource(int descriptor, const StopSignal& stop) : descriptor_(descriptor), stop_(stop) {}

  Arrived read(char* block, std::size_t size, Deadline deadline) override {
    const ReadResult result = read_when_ready(descriptor_, block, size, deadline, stop_);
    if (result.what == ReadResult::What::error) refuse_to_read("standard input", result.error);
    if (result.what == ReadResult::What::end) return {Arrival::ended, 0, ""};
    return {result.count > 0 ? Arrival::bytes : Arrival::nothing, result.count, ""};
  }

 private:
  int descriptor_;
  const StopSignal& stop_;
};

class NamedPipe : public ByteSource {
 public:
  NamedPipe(std::string path, bool once, const StopSignal& stop) : path_(std::move(path)), once_(once), stop_(stop) {
    open();
  }

  Arrived read(char* block, std::size_t size, Deadline deadline) override {
    const ReadResult result = read_when_ready(pipe_.number(), block, size, deadline, stop_);
    if (result.what == ReadResult::What::error) refuse_to_read(path_, result.error);
    if (result.what == ReadResult::What::bytes) return had(result.count);
    // Before the first writer a pipe is not ready; it is at its end when the last one is gone.
    if (result.what != ReadResult::What::end) return {};
    if (once_) return {Arrival::ended, 0, ""};
    open();
    away_ = true;
    return {Arrival::dropped, 0, path_ + ": its writer is gone; waiting for the next one"};
  }

 private:
  void open() {
    pipe_ = open_for_reading(path_, O_NONBLOCK);
    if (!pipe_.is_open()) refuse_to_read(path_, errno);
  }

  /// The first bytes of the next writer are told apart from those that continue.
  Arrived had(std::size_t count) {
    if (!std::exchange(away_, false)) return {Arrival::bytes, count, ""};
    return {Arrival::resumed, count, path_ + ": another writer continues"};
  }

  std::string path_;
  bool once_;
  const StopSignal& stop_;
  Descriptor pipe_;
  bool away_ = false;
};

}  // namespace

std::unique_ptr<ByteSource> read_descriptor(int descriptor, const StopSignal& stop) {
  return std::make_unique<DescriptorSource>(descriptor, stop);
}

std::unique_ptr<ByteSource> open_named_pipe(const std::string& path, bool once, const StopSignal& stop) {
  return std::make_unique<NamedPipe>(path, once, stop);
}

}  // namespace rollfix::app
