#include "rollfix/watch/watching.hpp"

#include <fmt/format.h>

#include <utility>

#include "rollfix/error.hpp"
#include "rollfix/output/answer_output.hpp"
#include "rollfix/output/touch_text.hpp"
#include "text/text.hpp"

namespace rollfix::app {

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
