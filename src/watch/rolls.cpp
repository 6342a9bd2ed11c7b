#include "watch/rolls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "part/part_data.hpp"
#include "rollfix/error.hpp"

// Notation:
//   sample          a row of a roll, measured from the roll's first contact: `samples_` of this roll so far
//   look            to work out what all samples so far mean: `answer_`, which holds after `answer_.samples` of them
//   said            the answer that was told last: `said_`; news is an answer that differs enough from it
//   beginning       where in the log's own measure this roll begins: `beginning_`; (0, 0) unless the roll before was
//                   contradicted and contact was not lost since
// Follows docs/watch.md.
// Idea: a look comes when a roll has grown by a share, so that the number of looks grows with the logarithm of the
// roll's length. Live they come by the clock as well, for at most half of the time.
namespace rollfix {
namespace {

using WorkClock = std::chrono::steady_clock;

// What is known of a roll changes little while it grows by less than this. Smaller: news comes sooner, and looks take
// more time.
constexpr double kGrowth = 0.25;
// ... and by less than this share of the boundary, where it may be carried to another place meanwhile. Rows on so much
// of it are needed to contradict anything.
constexpr double kFarToLook = 0.01;
constexpr std::size_t kLeastToContradict = 16;

// To find out why rows fit badly takes as long as to take in so many samples. In a log of many short rolls it is asked
// again only after as many more.
constexpr std::size_t kSamplesForWhy = 5000;

/// The reading and so many times the way `by`, of each finger.
Reading further(Reading reading, const Reading& by, double times) {
  for (std::size_t k = 0; k < by.length.size(); ++k) reading.length[k] += times * by.length[k];
  reading.turn += times * by.turn;
  return reading;
}

}  // namespace

Rolls::Rolls(Followed followed, MakeMeaning make) : followed_(std::move(followed)), make_(std::move(make)) {
  // What can't be right of the noise is said now and not at the first contact.
  const std::optional<PosePrior>& pose = followed_.options.pose;
  if (pose) require_not_lost(followed_.part, pose->place_sd, "a pose with a standard deviation", "");
  // Throws what a belief would at the first contact.
  const Belief trial(followed_.part, LogKind::contact, followed_.belief_options());
}

std::vector<Tracked> Rolls::push(const LogLine& row, LogKind kind) {
  // A row that was left out, or none, changes nothing here.
  kind_ = kind;
  switch (row.kind) {
    case LineKind::first:
      begin_anew(row.sample);
      break;
    case LineKind::sample:
      add(row.sample);
      break;
    case LineKind::lost:
      end_roll(RollEnd::lost);
      break;
    case LineKind::jump:
      end_roll(RollEnd::jump);
      begin_anew(row.sample);
      break;
    case LineKind::nothing:
    case LineKind::stray:
    case LineKind::malformed:
      break;
  }
  return take_told();
}

std::vector<Tracked> Rolls::finish(RollEnd why) {
  end_roll(why);
  return take_told();
}

/// What is to be told of the row that was pushed; nothing of it stays.
std::vector<Tracked> Rolls::take_told() { return std::exchange(told_, {}); }

/// Throws InputError: noise or a pose that is about a finger's centre or its u and psi, in a log without them. Known at
/// the first contact only, because the columns are.
void Rolls::require_evidence(const Sample& first) const {
  const TrackOptions& options = followed_.options;
  const auto refuse = [&](const char* what) {
    throw InputError(fmt::format("{}: {}, found none", options.name, what));
  };
  if (followed_.noise.position > 0 && !first.centre) {
    refuse("--noise position is of the finger's centre, expected a log of u and psi with columns x and y");
  }
  if (!options.pose) return;
  if (!first.contact) refuse("--heading and --pose: the finger tells how the part lies by u and psi, expected both");
  if (std::isfinite(options.pose->place_sd) && !first.centre) {
    refuse("--pose: the finger tells where the part is by its centre, expected columns x and y");
  }
}

/// A roll that the log itself begins: its rows are measured from this contact.
void Rolls::begin_anew(const Sample& sample) {
  beginning_ = {};
  is_elsewhere_ = false;
  begin_roll(sample);
}

/// The first sample of a roll is told at once.
void Rolls::begin_roll(const Sample& sample) {
  require_evidence(sample);
  meaning_ = make_(kind_);
  ++rolls_;
  samples_ = 0;
  take(sample);
  look();
  tell();
}

Sample Rolls::from_beginning(Sample sample) const {
  // Readings add up along a roll, lengths and turns.
  sample.reading = further(sample.reading, beginning_, -1);
  return sample;
}

// A log of u and psi is measured from a first contact that is a row; any other from where the row before was.
void Rolls::begin_elsewhere(const Sample& sample) {
  is_elsewhere_ = false;
  // last_ is measured from the old beginning: with that added it is as the log has it.
  beginning_ = kind_ == LogKind::contact ? sample.reading : further(last_.reading, beginning_, 1);
  begin_roll(from_beginning(sample));
}

/// A further row: it is taken, then looked at if it is time, then told if there is news. With `again` a roll that it
/// contradicts is over, and the next row begins another one elsewhere.
void Rolls::add(const Sample& as_logged) {
  if (is_elsewhere_) return begin_elsewhere(as_logged);
  take(from_beginning(as_logged));
  const std::size_t every = followed_.options.every;
  if (every > 0) {
    // Told after every so many samples, news or not; without a look in between.
    if (samples_ % every != 0) return;
    look();
    tell();
  } else {
    if (is_time_to_look()) look();
    tell_news();
  }
  if (!is_contradicted()) return;
  end_roll(RollEnd::elsewhere);
  is_elsewhere_ = true;
}

/// Only by an answer that holds for all samples by now, of at least kLeastToContradict of them, on one part.
bool Rolls::is_contradicted() const {
  return followed_.options.again && !answer_.parts && answer_.samples == samples_ && samples_ >= kLeastToContradict &&
         (answer_.verdict.name == Verdict::inconsistent || answer_.verdict.fits_badly);
}

/// Takes a sample in, which costs the same however long the roll is.
void Rolls::take(const Sample& sample) {
  meaning_->add(sample);
  ++samples_;
  ++all_samples_;
  last_ = sample;
}

/// When the samples have grown by kGrowth; with `again`, far enough along the boundary, where the finger may be carried
/// elsewhere; live, when the clock says so.
bool Rolls::is_time_to_look() const {
  const auto grown = static_cast<double>(samples_ - answer_.samples);
  if (grown >= kGrowth * static_cast<double>(answer_.samples)) return true;
  const double rolled = std::abs(last_.reading.length[0] - answer_.sample.reading.length[0]);
  if (followed_.options.again && rolled >= kFarToLook * followed_.part.perimeter()) return true;
  return followed_.options.live && WorkClock::now() >= next_look_;
}

/// An answer with nothing in it but which samples it is of.
void Rolls::begin_answer() {
  answer_ = {};
  answer_.roll = rolls_;
  answer_.samples = samples_;
  answer_.sample = last_;
}

/// Works out what the samples mean, and whether it is news. Without `live` the clock does not matter.
void Rolls::look() {
  const WorkClock::time_point start = WorkClock::now();
  begin_answer();
  meaning_->look(answer_);
  has_news_ = meaning_->is_news(said_, answer_);
  // Only live looks have a time of their own.
  if (!followed_.options.live) return;
  const WorkClock::time_point now = WorkClock::now();
  // Looking takes no more than half of the time.
  next_look_ = now + std::max<WorkClock::duration>(kMostDelay, now - start);
}

/// The last answer of a roll, told whether it is news or not. Nothing if there is no roll. Why rows fit badly is asked
/// live, at the end of the log, and as long as it was never answered; after that only when kSamplesForWhy more samples
/// came. It is not asked of a roll that ended elsewhere.
void Rolls::end_roll(RollEnd why) {
  if (!meaning_) return;
  const bool is_asked = why != RollEnd::elsewhere;  // else it is known what is wrong
  const bool explains = is_asked && (followed_.options.live || why == RollEnd::ended || explained_ == 0 ||
                                     all_samples_ >= explained_ + kSamplesForWhy);
  begin_answer();
  answer_.over = why;
  meaning_->conclude(answer_, explains);
  if (!answer_.diagnoses.empty()) explained_ = all_samples_;
  // No roll goes on until the next first contact.
  meaning_.reset();
  has_news_ = false;
  told_.push_back(answer_);
}

const Tracked& Rolls::now() {
  // Samples came since the last look.
  if (meaning_ && answer_.samples < samples_) look();
  return answer_;
}

/// With `every` nothing is kept back: what is told depends on counts only.
bool Rolls::is_behind() const {
  if (!meaning_ || followed_.options.every > 0) return false;
  return has_news_ || (followed_.options.live && answer_.samples < samples_);
}

std::vector<Tracked> Rolls::catch_up() {
  // Nothing was kept back.
  if (!is_behind()) return {};
  now();
  tell_news();
  return take_told();
}

/// Tells news where somebody is ready to hear it; else it stays, and what is told later is what is known by then.
void Rolls::tell_news() {
  const std::function<bool()>& is_ready = followed_.options.is_ready;
  if (has_news_ && (!is_ready || is_ready())) tell();
}

/// Tells the answer; from now on news is what differs from it.
void Rolls::tell() {
  said_ = answer_;
  has_news_ = false;
  told_.push_back(answer_);
}

}  // namespace rollfix
