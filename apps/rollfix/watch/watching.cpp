#include "rollfix/watch/watching.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "rollfix/error.hpp"
#include "rollfix/output/answer_output.hpp"
#include "rollfix/pulse.hpp"
#include "rollfix/watch/watcher.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

using WorkClock = std::chrono::steady_clock;

}  // namespace

TouchWatcher::TouchWatcher(TouchWatchOptions options, TouchListener& listener)
    : options_(std::move(options)), listener_(listener) {
  options_.table.may_be_empty = true;
  if (options_.no_use_for.empty()) return;
  throw InputError(fmt::format("{}: {} is of touches, which do not roll and have no use for it; leave it out",
                               options_.no_use_for.front(), options_.name));
}

bool TouchWatcher::begins_with(std::string_view line, const TouchTableOptions& table) {
  return line.size() <= kLongestLine && is_touch_table(line, table);
}

void TouchWatcher::push(std::string_view line) {
  ++counts_.lines;
  if (line.size() > kLongestLine) {
    return skip(fmt::format("{}:{}: expected a row of numbers, found more than {} bytes without a line end",
                            options_.name, counts_.lines, kLongestLine));
  }
  if (!header_.empty() && line == header_) return skip("");  // sent again after a reconnection
  const std::string with_it = fmt::format("{}{}\n", text_, line);
  TouchTable table;
  try {
    table = parse_touches(with_it, options_.name, options_.table);
  } catch (const InputError& error) {
    if (!has_begun_) throw;
    return skip(error.what());
  }
  text_ = with_it;
  if (!std::exchange(has_begun_, has_begun_ || begins_with(line, options_.table)) && table.touches.empty()) {
    if (has_begun_) header_ = line;
  }
  if (table.touches.size() > table_.touches.size()) return take(std::move(table));
  table_ = std::move(table);
}

void TouchWatcher::skip(const std::string& why) {
  text_ += "#\n";  // it counts as a line all the same
  if (why.empty()) return;
  ++counts_.malformed;
  listener_.note(why);
}

void TouchWatcher::take(TouchTable table) {
  const bool is_first = table_.touches.empty();
  table_ = std::move(table);
  ++counts_.samples;
  if (is_first) {
    for (const std::string& note : table_.notes) listener_.note(note);
  }
  if (options_.every > 0 && table_.touches.size() % options_.every != 0) return;
  solve_all(false);
  listener_.touched(*last_);
}

void TouchWatcher::solve_all(bool diagnoses) {
  const WorkClock::time_point start = WorkClock::now();
  const Pulse pulse([this](const char* /*doing*/) {
    was_stopped_ = options_.is_stopped && options_.is_stopped();
    if (was_stopped_) throw Stopped{};
  });
  TouchProblem problem = options_.problem;
  problem.touches = table_.touches;
  problem.diagnose = diagnoses;
  TouchNews news{table_.lines.back(), solve(problem)};
  const TouchAnswer& answer = news.answer;
  if (answer.status == Status::complete && answer.verdict.name == Verdict::ambiguous) news.next = next_touch(answer);
  last_.emplace(std::move(news));
  counts_.seconds += std::chrono::duration<double>(WorkClock::now() - start).count();
}

void TouchWatcher::end(RollEnd why) {
  if (table_.touches.empty()) return;
  const bool is_known =
      last_ && last_->line == table_.lines.back() && last_->answer.touches.size() == table_.touches.size();
  const bool is_odd =
      is_known && (last_->answer.verdict.fits_badly || last_->answer.verdict.name == Verdict::inconsistent);
  try {
    if (!was_stopped_ && (!is_known || is_odd)) solve_all(true);
  } catch (const Stopped&) {  // then the last answer is the one before
  }
  if (last_) listener_.no_more_touches(*last_, why);
}

void TouchWatcher::restart() {
  end(RollEnd::restarted);
  text_.clear();
  header_.clear();
  has_begun_ = false;
  table_ = {};
}

void TouchWatcher::finish() { end(RollEnd::ended); }

Watching::Watching(const Part& part, const WatchOptions& options, std::optional<TouchWatchOptions> touches,
                   WatchWriter& writer)
    : writer_(writer),
      touch_options_(std::move(touches)),
      is_of_catalog_(options.catalog != nullptr),
      name_(options.name) {
  try {
    rolls_.emplace(part, options, writer);
  } catch (const InputError& error) {
    if (!touch_options_) throw;
    refused_ = error.what();  // of touches less noise is enough
  }
}

void Watching::push(std::string_view line, std::size_t which) {
  if (!touches_ && begins_touches(line)) {
    writer_.begin_touches();
    touches_.emplace(*touch_options_, writer_);
  }
  if (touches_) return touches_->push(line);
  const bool has_roll = rolls_ && rolls_->last_answer().roll > 0;
  if (is_of_catalog_ && !has_roll && TouchWatcher::begins_with(line, {})) {
    throw InputError(fmt::format(
        "--catalog: {} is a table of touches, which watch takes of one part: give PART, or ask rollfix identify",
        name_));
  }
  if (rolls_) return rolls_->push(line, which);
  const std::string_view text = trimmed(line);
  if (!text.empty() && text.front() != '#') throw InputError(refused_);
}

bool Watching::begins_touches(std::string_view line) const {
  const bool may_be = touch_options_ && !(rolls_ && rolls_->last_answer().roll > 0);
  return may_be && TouchWatcher::begins_with(line, touch_options_->table);
}

void Watching::resume(std::size_t which) {
  if (rolls_) rolls_->resume(which);
  writer_.resumed(counts());
}

void Watching::restart(std::size_t which) {
  if (touches_) return touches_->restart();
  if (rolls_) rolls_->restart(which);
}

void Watching::catch_up() {
  if (!touches_ && rolls_) rolls_->catch_up();
}

void Watching::finish() {
  if (touches_) return touches_->finish();
  if (rolls_) rolls_->finish();
}

void Watching::end(WatchEnd why) {
  if (touches_) return writer_.end_touches(why, touches_->last(), counts());
  writer_.end(why, rolls_ ? rolls_->last_answer() : Tracked{}, counts());
}

bool Watching::has_found() const {
  return touches_ ? touches_->last().has_value() : rolls_ && rolls_->last_answer().roll > 0;
}

ExitCode Watching::exit_code() const {
  if (touches_) return touches_->last() ? exit_code_of(touches_->last()->answer) : ExitCode::fits;
  if (!rolls_) return ExitCode::fits;
  const Tracked& last = rolls_->last_answer();
  if (last.held && last.held->status == Status::incomplete) return ExitCode::incomplete;
  const bool fits = last.verdict.name != Verdict::inconsistent;
  return fits ? ExitCode::fits : ExitCode::nothing_fits;
}

/// Lines before those of touches were heard by what watches rolls, and so is every reconnection.
WatchCounts Watching::counts() const {
  WatchCounts counts = rolls_ ? rolls_->counts() : WatchCounts{};
  if (!touches_) return counts;
  const WatchCounts& touched = touches_->counts();
  counts.lines += touched.lines;
  counts.samples += touched.samples;
  counts.malformed += touched.malformed;
  counts.seconds += touched.seconds;
  return counts;
}

}  // namespace rollfix::app
