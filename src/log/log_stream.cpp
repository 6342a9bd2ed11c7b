#include <utility>
#include <vector>

#include "log/log_rows.hpp"
#include "log/roll_rows.hpp"
#include "rollfix/error.hpp"
#include "rollfix/log.hpp"

// A log that grows: a RowReader makes rows of lines or of numbers, RollRows judges and measures them. What a file
// refuses is an answer of kind `malformed` here, so that a stream goes on. Follows docs/rolling.md, "A log that grows".
// Only what leaves every row unreadable ends a stream: no text, a header that can't be taken, fingers that don't go
// with it.
namespace rollfix {

struct LogStream::State {
  State(std::string name, const Part& part, std::vector<Finger> fingers, const Noise& noise, LogOptions options,
        bool robust)
      : rolls(part, std::move(fingers), noise, robust, options.any_part, name),
        reader(std::move(name), in_unit_of(part, std::move(options))) {}

  /// What the reader makes of a row, judged and measured.
  template <class Read>
  LogLine push(const Read& read);

  RollRows rolls;             // judges rows and measures them
  RowReader reader;           // makes rows of what is pushed
  std::size_t malformed = 0;  // rows that were left out

 private:
  /// Tells the rolls what the columns are, whenever a header may have come.
  void start();
  /// Counts a row that is left out, and says why.
  LogLine skip(const InputError& error);

  LogRow row_;  // the one that is pushed
};

void LogStream::State::start() {
  rolls.start(reader.columns(), std::vector<std::string>(reader.columns().size(), reader.name()));
}

template <class Read>
LogLine LogStream::State::push(const Read& read) {
  RowKind found = RowKind::none;
  try {
    found = read(reader, row_);
  } catch (const InputError& error) {
    // The header, or the first row that says what the columns are: without it no row can be read.
    if (!reader.knows_columns()) throw;
    return skip(error);
  }
  // A header gives no row. It can also have come again, with columns in another order.
  const bool may_be_header = found == RowKind::none || !rolls.has_started();
  if (may_be_header && reader.knows_columns()) start();
  if (found == RowKind::none) return {};
  // Contact is lost, or was not there yet: the row's time counts, its cells do not.
  if (found == RowKind::off) {
    reader.accept(row_);
    return rolls.off();
  }
  // Both fingers' cells stand in one line.
  const auto lines = PerFinger<std::size_t>::of(reader.columns().size(), row_.line);
  // A row off the finger's end is left out before accept(): it must not count as the row before the next one.
  try {
    rolls.require_on_finger(row_, lines);
  } catch (const InputError& error) {
    return skip(error);
  }
  reader.accept(row_);
  return rolls.take(row_, lines);
}

LogLine LogStream::State::skip(const InputError& error) {
  ++malformed;
  LogLine result;
  result.kind = LineKind::malformed;
  result.message = error.what();
  result.goes_back = dynamic_cast<const NotLater*>(&error) != nullptr;
  return result;
}

LogStream::LogStream(std::string name, const Part& part, std::vector<Finger> fingers, const Noise& noise,
                     LogOptions options, bool robust)
    : state_(std::make_unique<State>(std::move(name), part, std::move(fingers), noise, std::move(options), robust)) {}
LogStream::~LogStream() = default;
LogStream::LogStream(LogStream&&) noexcept = default;
LogStream& LogStream::operator=(LogStream&&) noexcept = default;

LogLine LogStream::push(std::string_view line) {
  return state_->push([&](RowReader& reader, LogRow& row) { return reader.read(line, row); });
}

LogLine LogStream::push(std::optional<double> time, double u, double psi, std::optional<double> x,
                        std::optional<double> y) {
  // One finger is the same as a list of one.
  return push(time, Touch{u, psi, x, y});
}

LogLine LogStream::push(std::optional<double> time, const PerFinger<Touch>& fingers) {
  return state_->push([&](RowReader& reader, LogRow& row) { return reader.read(time, fingers, row); });
}

LogLine LogStream::push_off(std::optional<double> time) {
  return state_->push([&](RowReader& reader, LogRow& row) { return reader.read(time, std::nullopt, row); });
}

void LogStream::resume() {
  state_->reader.resume();
  // The next row may be far from the last one, and a header may come again.
  state_->rolls.skip();
}

LogKind LogStream::kind() const { return state_->reader.knows_columns() ? state_->reader.kind() : LogKind::contact; }

std::size_t LogStream::fingers() const { return state_->reader.columns().size(); }

std::size_t LogStream::lines() const { return state_->reader.lines(); }

std::size_t LogStream::malformed() const { return state_->malformed; }

}  // namespace rollfix
