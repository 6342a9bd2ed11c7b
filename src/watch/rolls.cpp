#include "watch/rolls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "part/part_data.hpp"
#include "rollfix/error.hpp"

namespace rollfix {
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
  const Belief trial(followed_.part, LogKind::contact, followed_.belief_options());
}

std::vector<Tracked> Rolls::push(const LogLine& row, LogKind kind) {
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

std::vector<Tracked> Rolls::take_told() { return std::exchange(told_, {}); }

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

void Rolls::begin_anew(const Sample& sample) {
  beginning_ = {};
  is_elsewhere_ = false;
  begin_roll(sample);
}

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
  sample.reading = further(sample.reading, beginning_, -1);
  return sample;
}

// A log of u and psi is measured from a first contact that is a row; any other from where the row before was.
void Rolls::begin_elsewhere(const Sample& sample) {
  is_elsewhere_ = false;
  beginning_ = kind_ == LogKind::contact ? sample.reading : further(last_.reading, beginning_, 1);
  begin_roll(from_beginning(sample));
}

void Rolls::add(const Sample& as_logged) {
  if (is_elsewhere_) return begin_elsewhere(as_logged);
  take(from_beginning(as_logged));
  const std::size_t every = followed_.options.every;
  if (every > 0) {
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

bool Rolls::is_contradicted() const {
  return followed_.options.again && !answer_.parts && answer_.samples == samples_ && samples_ >= kLeastToContradict &&
         (answer_.verdict.name == Verdict::inconsistent || answer_.verdict.fits_badly);
}

void Rolls::take(const Sample& sample) {
  meaning_->add(sample);
  ++samples_;
  ++all_samples_;
  last_ = sample;
}

bool Rolls::is_time_to_look() const {
  const auto grown = static_cast<double>(samples_ - answer_.samples);
  if (grown >= kGrowth * static_cast<double>(answer_.samples)) return true;
  const double rolled = std::abs(last_.reading.length[0] - answer_.sample.reading.length[0]);
  if (followed_.options.again && rolled >= kFarToLook * followed_.part.perimeter()) return true;
  return followed_.options.live && WorkClock::now() >= next_look_;
}

void Rolls::begin_answer() {
  answer_ = {};
  answer_.roll = rolls_;
  answer_.samples = samples_;
  answer_.sample = last_;
}

void Rolls::look() {
  const WorkClock::time_point start = WorkClock::now();
  begin_answer();
  meaning_->look(answer_);
  has_news_ = meaning_->is_news(said_, answer_);
  if (!followed_.options.live) return;
  const WorkClock::time_point now = WorkClock::now();
  // Looking takes no more than half of the time.
  next_look_ = now + std::max<WorkClock::duration>(kMostDelay, now - start);
}

void Rolls::end_roll(RollEnd why) {
  if (!meaning_) return;
  const bool is_asked = why != RollEnd::elsewhere;  // else it is known what is wrong
  const bool explains = is_asked && (followed_.options.live || why == RollEnd::ended || explained_ == 0 ||
                                     all_samples_ >= explained_ + kSamplesForWhy);
  begin_answer();
  answer_.over = why;
  meaning_->conclude(answer_, explains);
  if (!answer_.diagnoses.empty()) explained_ = all_samples_;
  meaning_.reset();
  has_news_ = false;
  told_.push_back(answer_);
}

const Tracked& Rolls::now() {
  if (meaning_ && answer_.samples < samples_) look();
  return answer_;
}

bool Rolls::is_behind() const {
  if (!meaning_ || followed_.options.every > 0) return false;
  return has_news_ || (followed_.options.live && answer_.samples < samples_);
}

std::vector<Tracked> Rolls::catch_up() {
  if (!is_behind()) return {};
  now();
  tell_news();
  return take_told();
}

void Rolls::tell_news() {
  const std::function<bool()>& is_ready = followed_.options.is_ready;
  if (has_news_ && (!is_ready || is_ready())) tell();
}

void Rolls::tell() {
  said_ = answer_;
  has_news_ = false;
  told_.push_back(answer_);
}

}  // namespace rollfix
