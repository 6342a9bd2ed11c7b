#include "rollfix/watch/watcher.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "part/not_lost.hpp"
#include "rollfix/error.hpp"
#include "rollfix/watch/beginning.hpp"
#include "rollfix/watch/meaning.hpp"
#include "rollfix/watch/two_logs.hpp"

namespace rollfix::app {
namespace {

using WorkClock = std::chrono::steady_clock;

// What is known of a roll changes little while it grows by less than this.
constexpr double kGrowth = 0.25;
// ... and by less than this share of the boundary, where it may be carried to another place meanwhile. Rows on so much
// of it are needed to contradict anything.
constexpr double kFarToLook = 0.01;
constexpr std::size_t kLeastToContradict = 16;

// To find out why rows fit badly takes as long as to take in so many. Nobody waits for all of a log's many short rolls.
constexpr std::size_t kSamplesForWhy = 5000;

// Rows without a header are distance and dturn. Where they have other columns a header may still come: a device that
// sends it now and then does so within that many.
constexpr std::size_t kCellsWithoutHeader = 2;
constexpr std::size_t kMostRowsBeforeHeader = 200;
constexpr const char* kHalfRow = "the end of a row that was not heard whole";
constexpr const char* kNoHeader = "a row before the header, which says what its numbers are";

/// Adds the time that passes while it lives.
class WorkTime {
 public:
  explicit WorkTime(double& seconds) : seconds_(seconds) {}
  ~WorkTime() { seconds_ += std::chrono::duration<double>(WorkClock::now() - start_).count(); }
  WorkTime(const WorkTime&) = delete;
  WorkTime& operator=(const WorkTime&) = delete;

 private:
  double& seconds_;
  WorkClock::time_point start_ = WorkClock::now();
};

/// Throws InputError: what is not taken of a finger beside a wheel, before any row comes.
void require_of_wheel(const BeliefOptions& options) {
  if (!(options.noise.position > 0)) {
    throw InputError(
        "`noise`: expected position=SD beside a wheel, found none: all that a wheel says is where its pin was");
  }
  const auto refuse = [](bool given, const char* name) {
    if (given) throw InputError(fmt::format("`{}` is not taken beside a wheel; leave it out", name));
  };
  refuse(options.prior.has_value(), "prior");
  refuse(options.pose.has_value(), "pose");
  refuse(options.robust, "robust");
}

}  // namespace

double WatchCounts::seconds_per_sample() const {
  return samples > 0 ? seconds / static_cast<double>(samples) : std::numeric_limits<double>::quiet_NaN();
}

Watcher::Watcher(const Part& part, WatchOptions options, WatchListener& listener)
    : part_(part), options_(std::move(options)), listener_(listener), stream_(new_stream()) {
  // What can't be right of the noise is said now and not at the first contact.
  const std::optional<PosePrior>& pose = options_.belief.pose;
  if (pose) require_not_lost(part_, pose->place_sd, "a pose with a standard deviation", "");
  const Belief trial(part_, LogKind::contact, options_.belief);
  if (options_.catalog) require_no_corners(options_.fingers, "identify");
  if (options_.wheel) require_of_wheel(options_.belief);
  if (options_.name_b) two_ = std::make_unique<TwoLogs>(part_, options_);
}
Watcher::~Watcher() = default;

void Watcher::push(std::string_view line, std::size_t which) {
  if (two_) return take_line(line, which);
  if (options_.midway && begins_) return push_beginning(line);
  if (!has_header_ && take_late_header(line)) return;
  take_line(line);
}

void Watcher::push_beginning(std::string_view line) {
  const std::string_view text = from_its_text(line);
  const FirstLine first = first_line(text);
  if (first.kind == FirstLine::Kind::garbage || (text.empty() && !line.empty())) {
    return skip("no text, or the end of a line that was not heard whole");
  }
  if (first.kind == FirstLine::Kind::empty) return take_line(text);
  if (first.kind == FirstLine::Kind::numbers) return push_numbers(text, first.cells);
  if (std::exchange(held_cells_, 0) > 0) skip(kHalfRow);
  begins_ = false;
  take_line(text);
}

void Watcher::push_numbers(std::string_view line, std::size_t cells) {
  const std::string before = std::exchange(held_, std::string(line));
  const std::size_t cells_before = std::exchange(held_cells_, cells);
  if (cells_before == 0) return;
  if (cells_before != cells) return skip(kHalfRow);
  if (cells != kCellsWithoutHeader && ++rows_before_header_ < kMostRowsBeforeHeader) return skip(kNoHeader);
  begins_ = has_header_ = false;
  held_cells_ = 0;
  take_line(before);
  take_line(line);
}

bool Watcher::take_late_header(std::string_view line) {
  if (first_line(line).kind != FirstLine::Kind::words) return false;
  LogStream other = new_stream();
  try {
    for (std::size_t k = 0; k < stream_.lines(); ++k) other.push("#");
    other.push(line);
  } catch (const InputError&) {  // no header of a log: a row like any other
    return false;
  }
  end_roll(RollEnd::restarted);
  stream_ = std::move(other);
  ++counts_.lines;
  has_header_ = true;
  listener_.note(
      fmt::format("{}:{}: a header; the rows before it had been taken without one", options_.name, stream_.lines()));
  return true;
}

void Watcher::skip(const std::string& why) {
  stream_.push("#");  // it counts as a line all the same
  ++counts_.lines;
  ++counts_.malformed;
  listener_.note(fmt::format("{}:{}: skipped: {}", options_.name, stream_.lines(), why));
}

void Watcher::take_line(std::string_view line) { take_row(read(line)); }

void Watcher::take_line(std::string_view line, std::size_t which) {
  std::vector<LogLine> rows;
  {
    const WorkTime time(counts_.seconds);
    ++counts_.lines;
    rows = two_->push(which, line);
  }
  tell_fingers(two_->fingers());
  for (const LogLine& row : rows) take_row(row);
}

void Watcher::tell_fingers(std::size_t count) {
  if (knows_fingers_ || count == 0) return;
  knows_fingers_ = true;
  listener_.knows_fingers(count);
}

LogKind Watcher::kind() const { return two_ ? two_->kind() : stream_.kind(); }

bool Watcher::is_ahead(std::size_t which) const { return two_ && two_->is_ahead(which); }

bool Watcher::has_waiting(std::size_t which) const { return two_ && two_->has_waiting(which); }

void Watcher::take_row(const LogLine& row) {
  if (row.kind != LineKind::malformed && row.kind != LineKind::nothing) rows_back_ = 0;
  switch (row.kind) {
    case LineKind::nothing:
      return;
    case LineKind::first:
      beginning_ = {};
      is_elsewhere_ = false;
      begin_roll(row.sample);
      return;
    case LineKind::sample:
      add(row.sample);
      return;
    case LineKind::lost:
      end_roll(RollEnd::lost);
      return;
    case LineKind::jump:
      listener_.note(row.message);
      end_roll(RollEnd::jump);
      beginning_ = {};
      is_elsewhere_ = false;
      begin_roll(row.sample);
      return;
    case LineKind::stray:
      listener_.note(row.message);
      return;
    case LineKind::malformed:
      ++counts_.malformed;
      note_malformed(row);
      return;
  }
}

/// One row whose time does not grow is a row like any other; after the second in a row it is the clock.
void Watcher::note_malformed(const LogLine& row) {
  const std::size_t before = row.goes_back ? rows_back_++ : std::exchange(rows_back_, 0);
  if (!row.goes_back || before == 0 || two_) return listener_.note(row.message);
  if (before > 1) return;
  listener_.note(fmt::format(
      "{}:{}: time went back: rows are left out, and not told one by one, until their time is after {:.9g} s; "
      "where the clock was set anew, or parts of the log were swapped, what follows is a log of its own",
      options_.name, stream_.lines(), last_.time.value_or(0)));
}

void Watcher::resume(std::size_t which) {
  ++counts_.reconnects;
  two_ ? two_->resume(which) : stream_.resume();
}

void Watcher::restart(std::size_t which) {
  end_roll(RollEnd::restarted);
  if (two_) {
    for (const LogLine& row : two_->restart(which)) take_row(row);
    return;
  }
  stream_ = new_stream();
  begins_ = has_header_ = true;
  held_cells_ = rows_before_header_ = 0;
}

void Watcher::finish() {
  if (std::exchange(held_cells_, 0) > 0) take_line(held_);
  if (two_) {
    for (const LogLine& row : two_->finish()) take_row(row);
  }
  end_roll(RollEnd::ended);
}

LogStream Watcher::new_stream() const {
  return LogStream(options_.name, part_, options_.fingers, options_.belief.noise, options_.log, options_.belief.robust);
}

LogLine Watcher::read(std::string_view line) {
  const WorkTime time(counts_.seconds);
  ++counts_.lines;
  if (line.size() <= kLongestLine) {
    LogLine row = stream_.push(line);
    tell_fingers(stream_.fingers());
    return row;
  }
  stream_.push("#");  // it counts as a line all the same
  LogLine row;
  row.kind = LineKind::malformed;
  row.message = fmt::format("{}:{}: expected a row of numbers, found more than {} bytes without a line end",
                            options_.name, stream_.lines(), kLongestLine);
  return row;
}

void Watcher::require_evidence(const Sample& first) const {
  const BeliefOptions& belief = options_.belief;
  const auto refuse = [&](const char* what) {
    throw InputError(fmt::format("{}: {}, found none", options_.name, what));
  };
  if (belief.noise.position > 0 && !first.centre) {
    refuse("--noise position is of the finger's centre, expected a log of u and psi with columns x and y");
  }
  if (!belief.pose) return;
  if (!first.contact) refuse("--heading and --pose: the finger tells how the part lies by u and psi, expected both");
  if (std::isfinite(belief.pose->place_sd) && !first.centre) {
    refuse("--pose: the finger tells where the part is by its centre, expected columns x and y");
  }
}

void Watcher::begin_roll(const Sample& sample) {
  require_evidence(sample);
  {
    const WorkTime time(counts_.seconds);
    meaning_ = options_.catalog ? meaning_on_catalog(part_, options_, kind())
               : options_.wheel ? meaning_beside_wheel(part_, options_)
                                : meaning_on_part(part_, options_, kind());
  }
  ++counts_.rolls;
  samples_ = 0;
  take(sample);
  look();
  said_ = answer_;
  has_news_ = false;
  listener_.found(answer_);
}

Sample Watcher::from_beginning(Sample sample) const {
  sample.reading.length[0] -= beginning_.length[0];
  sample.reading.turn -= beginning_.turn;
  return sample;
}

// A log of u and psi is measured from a first contact that is a row; any other from where the row before was.
void Watcher::begin_elsewhere(const Sample& sample) {
  is_elsewhere_ = false;
  const Reading before = {last_.reading.length[0] + beginning_.length[0], last_.reading.turn + beginning_.turn};
  beginning_ = stream_.kind() == LogKind::contact ? sample.reading : before;
  begin_roll(from_beginning(sample));
}

void Watcher::add(const Sample& as_logged) {
  if (is_elsewhere_) return begin_elsewhere(as_logged);
  take(from_beginning(as_logged));
  if (options_.every > 0) {
    if (samples_ % options_.every != 0) return;
    look();
    tell();
  } else {
    if (is_time_to_look()) look();
    tell_news();
  }
  if (!is_contradicted()) return;
  listener_.note(fmt::format("{}:{}: the rows contradict the roll so far: a new roll begins, from anywhere",
                             options_.name, stream_.lines()));
  end_roll(RollEnd::elsewhere);
  is_elsewhere_ = true;
}

bool Watcher::is_contradicted() const {
  return options_.again && !answer_.parts && answer_.samples == samples_ && samples_ >= kLeastToContradict &&
         (answer_.verdict.name == Verdict::inconsistent || answer_.verdict.fits_badly);
}

void Watcher::take(const Sample& sample) {
  const WorkTime time(counts_.seconds);
  meaning_->add(sample);
  ++counts_.samples;
  ++samples_;
  last_ = sample;
}

bool Watcher::is_time_to_look() const {
  const auto grown = static_cast<double>(samples_ - answer_.samples);
  if (grown >= kGrowth * static_cast<double>(answer_.samples)) return true;
  const double rolled = std::abs(last_.reading.length[0] - answer_.sample.reading.length[0]);
  if (options_.again && rolled >= kFarToLook * part_.perimeter()) return true;
  return options_.live && WorkClock::now() >= next_look_;
}

void Watcher::begin_answer() {
  answer_ = {};
  answer_.roll = counts_.rolls;
  answer_.samples = samples_;
  answer_.sample = last_;
}

void Watcher::look() {
  const WorkTime time(counts_.seconds);
  const WorkClock::time_point start = WorkClock::now();
  begin_answer();
  meaning_->look(answer_);
  has_news_ = is_news(said_, answer_, part_);
  if (!options_.live) return;
  const WorkClock::time_point now = WorkClock::now();
  // Looking takes no more than half of the time.
  next_look_ = now + std::max<WorkClock::duration>(kMostDelay, now - start);
}

void Watcher::end_roll(RollEnd why) {
  if (!meaning_) return;
  const bool is_asked = why != RollEnd::elsewhere;  // else it is known what is wrong
  const bool explains = is_asked && (options_.live || why == RollEnd::ended || explained_ == 0 ||
                                     counts_.samples >= explained_ + kSamplesForWhy);
  begin_answer();
  meaning_->conclude(answer_, explains);
  if (!answer_.diagnoses.empty()) explained_ = counts_.samples;
  meaning_.reset();
  has_news_ = false;
  listener_.over(answer_, why);
}

bool Watcher::is_behind() const {
  if (!meaning_ || options_.every > 0) return false;
  return has_news_ || (options_.live && answer_.samples < samples_);
}

void Watcher::catch_up() {
  if (!is_behind()) return;
  if (answer_.samples < samples_) look();
  tell_news();
}

void Watcher::tell_news() {
  if (has_news_ && listener_.is_ready()) tell();
}

void Watcher::tell() {
  said_ = answer_;
  has_news_ = false;
  listener_.changed(answer_);
}

}  // namespace rollfix::app
