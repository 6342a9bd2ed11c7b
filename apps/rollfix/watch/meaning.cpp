#include "rollfix/watch/meaning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "answer/finger_corners.hpp"
#include "contact/log_rows.hpp"
#include "outline/turn.hpp"
#include "rollfix/answer/solve.hpp"
#include "rollfix/error.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

// A roll is looked at as a whole by no more samples than these.
constexpr std::size_t kMostKept = 4096;
// While so many parts remain they are only counted: to weigh them all takes longer than a roll is.
constexpr std::size_t kMostWeighed = 500;
// Fewer samples are no roll yet.
constexpr std::size_t kLeastSamples = 3;

/// As the log is read: see LogOptions.
BeliefOptions as_read(const WatchOptions& watch) {
  BeliefOptions options = watch.belief;
  if (options.pose && watch.log.mirrored) {
    options.pose->mean.x *= -1;
    options.pose->mean.heading *= -1;
  }
  return options;
}

/// What is asked of all samples together.
Problem problem_of(const Part& part, const WatchOptions& watch, LogKind kind, const KeptSamples& kept) {
  const BeliefOptions options = as_read(watch);
  Problem problem{part, kept.log(kind, part, watch.fingers, options.noise), watch.fingers, options.noise};
  problem.prior = options.prior;
  problem.pose = options.pose;
  problem.robust = options.robust;
  problem.may_overlap = watch.may_overlap;
  if (kind == LogKind::increments) {  // one stands for several, which were off each
    problem.noise->contact *= std::sqrt(static_cast<double>(kept.each()));
    problem.noise->angle *= std::sqrt(static_cast<double>(kept.each()));
  }
  return problem;
}

/// A placement of an answer with noise, as the mode that it was of.
Mode mode_of(const Placement& placement) {
  Mode mode;
  mode.start = placement.start;
  mode.end = placement.end;
  mode.tangent = placement.tangent;
  mode.probability = placement.probability;
  mode.mean = placement.mean;
  mode.sd = placement.sd;
  mode.interval = placement.interval;
  mode.end_mean = placement.end_mean;
  mode.end_sd = placement.end_sd;
  mode.covariance = placement.covariance;
  return mode;
}

/// What is known of the fingers at their first contacts, as `solve` has it.
Contacts contacts_at(const Sample& first, const std::vector<Finger>& fingers) {
  Contacts contacts{first.finger_curvature, {}, fingers};
  if (first.reading.fingers() != 2 || !first.contact) return contacts;
  contacts.facing = nearest_angle(facing(*finger_of(fingers, 0), (*first.contact)[0]) -
                                  facing(*finger_of(fingers, 1), (*first.contact)[1]));
  return contacts;
}

/// On a corner of a finger, where u does not tell how its normal is turned.
bool is_on_corner(const Sample& sample) {
  return std::any_of(sample.finger_curvature.begin(), sample.finger_curvature.end(),
                     [](double curvature) { return std::isinf(curvature); });
}

/// The way from one row to another.
Reading between(const Reading& from, Reading to) {
  for (std::size_t k = 0; k < to.length.size(); ++k) to.length[k] -= from.length[k];
  to.turn -= from.turn;
  to.pivot = 0;
  return to;
}

/// Rows on corners of the fingers are not weighed: all others are measured from the first of these, as `solve` does.
class OnPart final : public Meaning {
 public:
  OnPart(const Part& part, const WatchOptions& options, LogKind kind) : part_(part), options_(options), kind_(kind) {}

  void add(const Sample& sample) override {
    kept_.add(sample);
    last_ = sample.reading;
    if (is_on_corner(sample)) return;
    if (!belief_) begin(sample);
    weighed_ = sample.reading;
    belief_->add(from_base(sample));
  }

  void look(WatchAnswer& answer) override {
    answer.verdict = {Verdict::unobservable};
    answer.rest = 1;
    if (!belief_) return;
    answer.verdict = belief_->verdict();
    answer.modes = belief_->modes();
    for (Mode& mode : answer.modes) mode.probability = std::min(1.0, mode.probability);  // a sum, with its rounding
    for (Mode& mode : answer.modes) to_ends(mode);
    answer.rest = belief_->rest();
    answer.fit = belief_->fit();
  }

  /// What `locate` says of the same rows.
  void conclude(WatchAnswer& answer, bool explains) override {
    try {
      Problem problem = problem_of(part_, options_, kind_, kept_);
      problem.diagnose = explains;
      const Answer located = solve(problem);
      answer.diagnoses = located.diagnoses;
      const bool is_bad = located.verdict.fits_badly || located.verdict.name == Verdict::inconsistent;
      // Of a long roll only some samples were kept: where they fit, all of them say more.
      if (kept_.each() > 1 && !is_bad) return look(answer);
      answer.verdict = located.verdict;
      answer.impossible = located.impossible.size();
      answer.rest = located.weighing->rest;
      answer.fit = located.weighing->fit;
      answer.modes.clear();
      for (const Placement& placement : located.placements) answer.modes.push_back(mode_of(placement));
    } catch (const InputError&) {  // so few of its samples are no roll any more: what is wrong is not known
      look(answer);
    }
  }

 private:
  void begin(const Sample& base) {
    BeliefOptions options = as_read(options_);
    if (kept_.size() > 1) way_ = base.reading;
    if (options.prior && way_) options.prior->s += way_->length[0];
    belief_.emplace(part_, kind_, options, contacts_at(base, options_.fingers));
  }

  Sample from_base(Sample sample) const {
    if (way_) sample.reading = between(*way_, sample.reading);
    return sample;
  }

  /// From the rows that were weighed to the first contacts and the last ones.
  void to_ends(Mode& mode) const {
    const Noise& noise = options_.belief.noise;
    if (way_) to_first_contacts(*way_, part_, noise, mode);
    const Reading further = between(weighed_, last_);
    const bool is_further = std::any_of(further.length.begin(), further.length.end(), [](double l) { return l != 0; });
    if (is_further) to_last_contacts(further, part_, noise, mode);
  }

  Part part_;
  WatchOptions options_;
  LogKind kind_;
  std::optional<Belief> belief_;  // none before the first row off all corners
  std::optional<Reading> way_{};  // to that row, where it is not the first
  Reading weighed_{};             // of the last row off them
  Reading last_{};                // of the last row
  KeptSamples kept_;
};

/// Which parts remain: those that were ruled out are not looked at again before the roll is over.
class OnCatalog final : public Meaning {
 public:
  OnCatalog(const Part& part, const WatchOptions& options, LogKind kind)
      : part_(part), options_(options), kind_(kind) {}

  void add(const Sample& sample) override { kept_.add(sample); }

  void look(WatchAnswer& answer) override {
    IdentifyOptions options;
    options.among = left_;
    options.most_searched = kMostWeighed;
    look(answer, options);
    if (answer.parts->counted || !answer.parts->parts.empty()) left_ = answer.parts->left;
  }

  void conclude(WatchAnswer& answer, bool /*explains*/) override { look(answer, {}); }

 private:
  void look(WatchAnswer& answer, const IdentifyOptions& options) const {
    const Problem problem = problem_of(part_, options_, kind_, kept_);
    try {
      answer.parts = std::make_shared<const Identified>(identify(*options_.catalog, problem, options));
    } catch (const InputError&) {  // so short a roll says nothing yet, or the rows are no roll on any part
      Identified nothing;
      nothing.counted = kept_.size() < kLeastSamples;
      nothing.verdict = "none";
      if (nothing.counted) {
        nothing.left.resize(options_.catalog->size());
        std::iota(nothing.left.begin(), nothing.left.end(), std::size_t{0});
        nothing.verdict = counted(nothing.left.size(), "part", "parts");
      }
      answer.parts = std::make_shared<const Identified>(std::move(nothing));
    }
    const Identified& found = *answer.parts;
    const bool is_one = found.parts.size() == 1 && found.parts.front().answer.placements.size() == 1;
    answer.verdict = {found.verdict == "none" ? Verdict::inconsistent : is_one ? Verdict::unique : Verdict::ambiguous};
    answer.rest = found.rest;
  }

  Part part_;
  WatchOptions options_;
  LogKind kind_;
  KeptSamples kept_;
  std::vector<std::size_t> left_;  // empty: all
};

}  // namespace

namespace {

/// How far u is from the nearest corner of such a finger.
double from_corner(const Finger& finger, double u) {
  double least = std::numeric_limits<double>::infinity();
  for (const Corner& corner : finger.outline()->corners()) {
    if (corner.turn > kJointTurn) least = std::min(least, finger.outline()->distance(u, corner.s));
  }
  return least;
}

/// The digits of u that put these samples on corners of their finger where the noise does not; 0: there are none.
double rounding_on_corners(const std::vector<Sample>& samples, std::size_t which, const Finger& finger,
                           const Noise& noise) {
  double farthest = 0;
  for (const Sample& sample : samples) {
    if (std::isinf(sample.finger_curvature[which]))
      farthest = std::max(farthest, from_corner(finger, (*sample.contact)[which].u));
  }
  return farthest > reach_of_corners(0, noise) ? 0.5 * farthest : 0;
}

/// A finger's. Of two fingers only the difference of their turns is known, which goes with the first one.
void add_row(const Sample& sample, std::size_t which, LogKind kind, const Part& part, FingerRows& rows) {
  rows.u_period = std::numeric_limits<double>::infinity();
  rows.u_wrapped = rows.psi_wrapped = false;  // a sample's angles are unwrapped
  if (kind == LogKind::contact) {
    rows.u.push_back((*sample.contact)[which].u);
    rows.psi.push_back((*sample.contact)[which].psi);
  } else {
    const Reading as_given = in_stored_direction(sample.reading, part);  // back again
    rows.length.push_back(as_given.length[which]);
    rows.turn.push_back(which == 0 ? as_given.turn : 0);
  }
  if (!sample.centre) return;
  rows.x.push_back((*sample.centre)[which].x());
  rows.y.push_back((*sample.centre)[which].y());
}

}  // namespace

void KeptSamples::add(const Sample& sample) {
  if (seen_++ % every_ != 0) return;
  kept_.push_back(sample);
  if (kept_.size() < kMostKept) return;
  for (std::size_t k = 0; 2 * k < kept_.size(); ++k) kept_[k] = kept_[2 * k];
  kept_.resize((kept_.size() + 1) / 2);
  every_ *= 2;
}

void KeptSamples::end_with(const Sample& sample) {
  if (kept_.empty() || kept_.back().line != sample.line) kept_.push_back(sample);
}

Log KeptSamples::log(LogKind kind, const Part& part, const std::vector<Finger>& fingers, const Noise& noise) const {
  Log log;
  log.kind = kind;
  log.fingers.resize(kept_.empty() ? 1 : kept_.front().finger_curvature.size());
  for (const Sample& sample : kept_) {
    if (sample.time) log.time.push_back(*sample.time);
    for (std::size_t which = 0; which < log.fingers.size(); ++which) {
      add_row(sample, which, kind, part, log.fingers[which]);
    }
  }
  for (std::size_t which = 0; which < log.fingers.size(); ++which) {
    const Finger* const finger = finger_of(fingers, which);
    if (finger == nullptr || !finger->has_corners()) continue;
    log.fingers[which].place_rounding = rounding_on_corners(kept_, which, *finger, noise);
  }
  return log;
}

std::unique_ptr<Meaning> meaning_on_part(const Part& part, const WatchOptions& options, LogKind kind) {
  return std::make_unique<OnPart>(part, options, kind);
}

std::unique_ptr<Meaning> meaning_on_catalog(const Part& part, const WatchOptions& options, LogKind kind) {
  return std::make_unique<OnCatalog>(part, options, kind);
}

}  // namespace rollfix::app
