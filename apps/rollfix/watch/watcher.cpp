#include "rollfix/watch/watcher.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "rollfix/answer/solve.hpp"
#include "rollfix/error.hpp"
#include "rollfix/part/boundary.hpp"

namespace rollfix::app {
namespace {

using WorkClock = std::chrono::steady_clock;

// What is known of a roll changes little while it grows by less than this.
constexpr double kGrowth = 0.1;

constexpr double kOtherProbability = 0.1;  // below that nobody decides otherwise
constexpr double kTwiceAsSure = 0.5;       // the new standard deviation, as a share of the old one

// A roll that fits badly is looked at again as a whole, by no more samples than these, evenly spread.
constexpr std::size_t kMostKept = 4096;

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

double distance_on(const Part& part, double a, double b) {
  return part.closed() ? periodic_distance(a, b, part.perimeter()) : std::abs(a - b);
}

/// Of several places that were known the one that this is, or is nearest to.
const Mode& nearest_to(const Mode& mode, const std::vector<Mode>& known, const Part& part) {
  return *std::min_element(known.begin(), known.end(), [&](const Mode& a, const Mode& b) {
    return distance_on(part, a.mean[0], mode.mean[0]) < distance_on(part, b.mean[0], mode.mean[0]);
  });
}

bool is_news_of_a_place(const Mode& said, const Mode& now, const Part& part) {
  return distance_on(part, said.mean[0], now.mean[0]) > said.sd[0] || now.sd[0] < kTwiceAsSure * said.sd[0] ||
         std::abs(now.probability - said.probability) > kOtherProbability;
}

/// The log that these samples are of, as the user gave it.
Log log_of(const std::vector<Sample>& samples, LogKind kind, const Part& part) {
  Log log;
  log.kind = kind;
  FingerRows& rows = log.fingers.front();
  rows.u_period = std::numeric_limits<double>::infinity();  // a sample's angles are unwrapped
  for (const Sample& sample : samples) {
    if (sample.time) log.time.push_back(*sample.time);
    if (kind == LogKind::contact) {
      rows.u.push_back((*sample.contact)[0].u);
      rows.psi.push_back((*sample.contact)[0].psi);
    } else {
      const Reading as_given = in_stored_direction(sample.reading, part);  // back again
      rows.length.push_back(as_given.length[0]);
      rows.turn.push_back(as_given.turn);
    }
    if (!sample.centre) continue;
    rows.x.push_back((*sample.centre)[0].x());
    rows.y.push_back((*sample.centre)[0].y());
  }
  return log;
}

}  // namespace

bool is_news(const WatchAnswer& said, const WatchAnswer& now, const Part& part) {
  if (now.verdict != said.verdict || now.modes.empty() != said.modes.empty()) return true;
  if (now.modes.empty() || now.verdict.name == Verdict::inconsistent) return false;  // no place that is worth telling
  const Mode& best = now.modes.front();
  return is_news_of_a_place(nearest_to(best, said.modes, part), best, part);
}

double WatchCounts::seconds_per_sample() const {
  return samples > 0 ? seconds / static_cast<double>(samples) : std::numeric_limits<double>::quiet_NaN();
}

Watcher::Watcher(const Part& part, WatchOptions options, WatchListener& listener)
    : part_(part), options_(std::move(options)), listener_(listener), stream_(new_stream()) {
  // What can't be right of the noise is said now and not at the first contact.
  const Belief trial(part_, LogKind::contact, options_.belief);
}

void Watcher::push(std::string_view line) {
  const LogLine row = read(line);
  switch (row.kind) {
    case LineKind::nothing:
      return;
    case LineKind::first:
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
      begin_roll(row.sample);
      return;
    case LineKind::stray:
      listener_.note(row.message);
      return;
    case LineKind::malformed:
      ++counts_.malformed;
      listener_.note(row.message);
      return;
  }
}

void Watcher::resume() {
  ++counts_.reconnects;
  stream_.resume();
}

void Watcher::restart() {
  end_roll(RollEnd::restarted);
  stream_ = new_stream();
}

void Watcher::finish() { end_roll(RollEnd::ended); }

LogStream Watcher::new_stream() const {
  return LogStream(options_.name, part_, options_.fingers, options_.belief.noise, options_.log, options_.belief.robust);
}

LogLine Watcher::read(std::string_view line) {
  const WorkTime time(counts_.seconds);
  ++counts_.lines;
  if (line.size() <= kLongestLine) {
    LogLine row = stream_.push(line);
    if (stream_.fingers() < 2) return row;
    throw InputError(fmt::format("{}:{}: this log is of two fingers, expected one with columns 'u' and 'psi'",
                                 options_.name, stream_.lines()));
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

Belief Watcher::new_belief(const Sample& first) const {
  BeliefOptions options = options_.belief;
  if (options.pose && options_.log.mirrored) {  // as the log is read: see LogOptions
    options.pose->mean.x *= -1;
    options.pose->mean.heading *= -1;
  }
  return {part_, stream_.kind(), options, {first.finger_curvature, {}, options_.fingers}};
}

void Watcher::begin_roll(const Sample& sample) {
  require_evidence(sample);
  {
    const WorkTime time(counts_.seconds);
    belief_.emplace(new_belief(sample));
  }
  ++counts_.rolls;
  samples_ = 0;
  kept_.clear();
  kept_every_ = 1;
  take(sample);
  look();
  said_ = answer_;
  has_news_ = false;
  listener_.found(answer_);
}

void Watcher::add(const Sample& sample) {
  take(sample);
  if (options_.every > 0) {
    if (samples_ % options_.every != 0) return;
    look();
    tell();
    return;
  }
  if (is_time_to_look()) look();
  tell_news();
}

void Watcher::take(const Sample& sample) {
  const WorkTime time(counts_.seconds);
  belief_->add(sample);
  ++counts_.samples;
  keep(sample);
  ++samples_;
  last_ = sample;
}

void Watcher::keep(const Sample& sample) {
  if (samples_ % kept_every_ != 0) return;
  kept_.push_back(sample);
  if (kept_.size() < kMostKept) return;
  for (std::size_t k = 0; 2 * k < kept_.size(); ++k) kept_[k] = kept_[2 * k];
  kept_.resize((kept_.size() + 1) / 2);
  kept_every_ *= 2;
}

bool Watcher::is_time_to_look() const {
  const auto grown = static_cast<double>(samples_ - answer_.samples);
  if (grown >= kGrowth * static_cast<double>(answer_.samples)) return true;
  return options_.live && WorkClock::now() - looked_ >= kMostDelay;
}

void Watcher::look() {
  const WorkTime time(counts_.seconds);
  answer_.roll = counts_.rolls;
  answer_.diagnoses.clear();
  answer_.samples = samples_;
  answer_.sample = last_;
  answer_.verdict = belief_->verdict();
  answer_.modes = belief_->modes();
  answer_.rest = belief_->rest();
  answer_.excess = belief_->excess();
  has_news_ = is_news(said_, answer_, part_);
  if (options_.live) looked_ = WorkClock::now();
}

/// Why the rows fit badly, if they do.
void Watcher::look_again() {
  if (!belief_->fit().is_bad()) return;
  Problem problem{part_, log_of(kept_, stream_.kind(), part_), options_.fingers, options_.belief.noise};
  problem.prior = options_.belief.prior;
  problem.pose = options_.belief.pose;
  problem.robust = options_.belief.robust;
  try {
    answer_.diagnoses = solve(problem).diagnoses;
  } catch (const InputError&) {  // so few of its samples are no roll any more: what is wrong is not known
  }
}

void Watcher::end_roll(RollEnd why) {
  if (!belief_) return;
  if (answer_.samples < samples_) look();
  look_again();
  belief_.reset();
  has_news_ = false;
  listener_.over(answer_, why);
}

bool Watcher::is_behind() const {
  if (!belief_ || options_.every > 0) return false;
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
