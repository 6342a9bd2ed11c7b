#include "rollfix/watch/touch_watcher.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "rollfix/error.hpp"
#include "rollfix/pulse.hpp"

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

}  // namespace rollfix::app
