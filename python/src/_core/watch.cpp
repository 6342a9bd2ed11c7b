#include <chrono>
#include <mutex>
#include <sstream>

#include "bindings.hpp"
#include "handles.hpp"
#include "rollfix/question.hpp"
#include "rollfix/watch/watcher.hpp"
#include "rollfix/watch/writer.hpp"
#include "signals.hpp"

namespace rollfix::python {
namespace {

constexpr std::chrono::milliseconds kBetweenSignals{20};

/// The program's watcher, whose events are kept as the lines that it would print until somebody takes them. Any thread
/// can call it: whoever works without the interpreter's lock has this one's.
class Watch {
 public:
  Watch(const PartHandle& handle, app::WatchOptions options)
      : part_(handle.part()),
        writer_(app::watch_jsonl(part_, events_, notes_, [] { return true; })),
        watcher_(part_, begun(std::move(options)), *writer_) {}

  void push(const std::string& lines, std::size_t which) {
    const std::lock_guard alone(mutex_);
    std::istringstream stream(lines);
    auto last = std::chrono::steady_clock::now();
    for (std::string line; std::getline(stream, line);) {
      watcher_.push(line, which);
      // Between lines: what is half taken would be lost.
      if (const auto now = std::chrono::steady_clock::now(); now - last > kBetweenSignals) {
        last = now;
        hear_signals();
      }
    }
  }
  void catch_up() {
    const std::lock_guard alone(mutex_);
    watcher_.catch_up();
  }
  void finish() {
    const std::lock_guard alone(mutex_);
    watcher_.finish();
    writer_->show();
    writer_->end(app::WatchEnd::stream, watcher_.last_answer(), watcher_.counts());
  }
  void resume(std::size_t which) {
    const std::lock_guard alone(mutex_);
    watcher_.resume(which);
    writer_->resumed(watcher_.counts());
  }
  /// What was written since the last time: events and notes.
  std::pair<std::string, std::string> take() {
    const std::lock_guard alone(mutex_);
    std::pair<std::string, std::string> taken(events_.str(), notes_.str());
    events_.str("");
    notes_.str("");
    return taken;
  }

 private:
  app::WatchOptions begun(app::WatchOptions options) {
    writer_->begin(part_, options);
    return options;
  }

  std::mutex mutex_;
  Part part_;
  std::ostringstream events_;
  std::ostringstream notes_;
  std::unique_ptr<app::WatchWriter> writer_;
  app::Watcher watcher_;
};

}  // namespace

template <>
inline constexpr bool kIsPythonClass<Watch> = true;

namespace {

/// `asked`: of a part and of contacts that are still to come.
std::unique_ptr<Watch> watch(const PartHandle& part, const Question& asked, const std::vector<std::string>& names,
                             std::size_t every, bool live,
                             const std::vector<std::tuple<std::string, std::string, std::string>>& columns,
                             const std::string& angles, const std::optional<bool>& wrapped,
                             const std::optional<CatalogHandle>& catalog, const std::optional<double>& wheel) {
  app::WatchOptions options;
  options.name = names[0];
  if (names.size() == 2) options.name_b = names[1];
  options.fingers = asked.fingers;
  options.noise = asked.noise.value_or(Noise{});
  options.prior = asked.prior;
  options.pose = asked.pose;
  options.robust = asked.robust;
  options.every = every;
  options.may_overlap = asked.may_overlap;
  options.log.unit = part.part().unit();
  options.log.angles = angles;
  options.log.wrapped = wrapped;
  options.log.clockwise = asked.direction == Direction::clockwise;
  options.wheel = wheel;
  options.squeezed = asked.squeezed;
  options.mirrored = asked.mirrored;
  options.live = live;
  if (catalog) options.catalog = catalog->catalog;
  options.log.any_part = catalog.has_value();
  for (const auto& [column, called, unit] : columns) options.log.columns.push_back({column, called, unit});
  return std::make_unique<Watch>(part, std::move(options));
}

}  // namespace

void bind_watch(py::module_& module) {
  py::class_<Watch>(module, "Watch")
      .def(py::init(&watch))
      .def("push", &Watch::push, py::call_guard<py::gil_scoped_release>())
      .def("catch_up", &Watch::catch_up, py::call_guard<py::gil_scoped_release>())
      .def("finish", &Watch::finish, py::call_guard<py::gil_scoped_release>())
      .def("resume", &Watch::resume, py::call_guard<py::gil_scoped_release>())
      .def("take", &Watch::take, py::call_guard<py::gil_scoped_release>());
}

}  // namespace rollfix::python
