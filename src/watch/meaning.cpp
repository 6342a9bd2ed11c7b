#include "watch/meaning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "answer/steps.hpp"
#include "log/log_rows.hpp"
#include "outline/turn.hpp"
#include "rollfix/error.hpp"
#include "rollfix/hold.hpp"
#include "rollfix/solve.hpp"

// What the samples of a roll mean: of one finger or two on a known part, and of a finger with skin beside a wheel
// without, which measure together while they hold a part that moves: docs/watch.md and docs/rig.md. Some rows are kept
// for the answer at the end of the roll.
// Notation:
//   base            the first sample off all corners of the fingers: readings that are weighed are measured from it
//   way             from the first contact to the base, nothing if these are the same: `way_`
//   weighed, last   readings of the last sample off corners, and of the last one
//   kept            of every `each` samples the first, fewer than kMostKept: what the roll is solved with at its end
// Idea: of one finger or two the posterior grows with each sample (Belief), in memory that does not. A roll of fewer
// than kMostKept samples is solved as `locate` would at its end. Beside a wheel there is no such posterior: kept
// samples are solved again at every look.
namespace rollfix {
namespace {

// A roll is solved as a whole by fewer samples than these. More take longer, at every look beside a wheel.
constexpr std::size_t kMostKept = 4096;

/// How far u is from the nearest corner of such a finger.
double from_corner(const Finger& finger, double u) {
  double least = std::numeric_limits<double>::infinity();
  for (const Corner& corner : finger.outline()->corners()) {
    // Convex ones; a joint that turns less than kJointTurn is no corner.
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
  // Within the reach that noise has they count as on corners without any digits; else reach_of_corners takes twice the
  // rounding.
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
    // A sample is in the stored direction, a log as the user gave the outline; the conversion is its own inverse.
    const Reading as_given = in_stored_direction(sample.reading, part);  // back again
    rows.length.push_back(as_given.length[which]);
    rows.turn.push_back(which == 0 ? as_given.turn : 0);
  }
  if (!sample.centre) return;
  rows.x.push_back((*sample.centre)[which].x());
  rows.y.push_back((*sample.centre)[which].y());
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
FingerGeometry contacts_at(const Sample& first, const std::vector<Finger>& fingers) {
  FingerGeometry contacts{first.finger_curvature, {}, fingers};
  // One finger, or a log without u and psi: no facing.
  if (first.reading.fingers() != 2 || !first.contact) return contacts;
  contacts.facing = nearest_angle(normal_direction(*finger_of(fingers, 0), (*first.contact)[0]) -
                                  normal_direction(*finger_of(fingers, 1), (*first.contact)[1]));
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
  OnPart(const Followed& followed, LogKind kind) : followed_(followed), kind_(kind) {}

  /// Memory does not grow beyond kMostKept samples. A sample on a corner is kept for the end, and not weighed.
  void add(const Sample& sample) override {
    kept_.add(sample);
    last_ = sample.reading;
    if (is_on_corner(sample)) return;
    if (!belief_) begin(sample);
    weighed_ = sample.reading;
    belief_->add(from_base(sample));
  }

  /// What the posterior says of all samples off corners. Its modes are moved to the first contacts and to the last
  /// ones. Before there is such a sample any place fits.
  void look(Tracked& answer) override {
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
  void conclude(Tracked& answer, bool explains) override {
    try {
      Problem problem = problem_of(followed_, kind_, kept_);
      problem.diagnose = explains;
      const Answer located = solve(problem);
      answer.diagnoses = located.diagnoses;
      // Why rows fit badly is asked of the kept ones.
      const bool is_bad = located.verdict.fits_badly || located.verdict.name == Verdict::inconsistent;
      // Of a long roll only some samples were kept: where they fit, all of them say more.
      if (kept_.each() > 1 && !is_bad) return look(answer);
      answer.verdict = located.verdict;
      answer.impossible = located.impossible.size();
      answer.rest = located.weighing->rest;
      answer.fit = located.weighing->fit;
      // The answer of `solve`, as modes.
      answer.modes.clear();
      for (const Placement& placement : located.placements) answer.modes.push_back(mode_of(placement));
    } catch (const InputError&) {  // so few of its samples are no roll any more: what is wrong is not known
      look(answer);
    }
  }

  bool is_news(const Tracked& said, const Tracked& now) const override {
    return rollfix::is_news(said, now, followed_.part);
  }

 private:
  /// Starts the posterior at the first sample off corners. A prior of the start is moved along with it.
  void begin(const Sample& base) {
    BeliefOptions options = followed_.belief_options();
    if (kept_.size() > 1) way_ = base.reading;
    if (options.prior && way_) options.prior->s += way_->length[0];
    belief_.emplace(followed_.part, kind_, options, contacts_at(base, followed_.fingers));
  }

  /// The sample as measured from the base.
  Sample from_base(Sample sample) const {
    if (way_) sample.reading = between(*way_, sample.reading);
    return sample;
  }

  /// From the rows that were weighed to the first contacts and the last ones.
  void to_ends(Mode& mode) const {
    const auto& [part, fingers, noise, options] = followed_;
    if (way_) to_first_contacts(*way_, part, noise, mode);
    const Reading further = between(weighed_, last_);
    const bool is_further = std::any_of(further.length.begin(), further.length.end(), [](double l) { return l != 0; });
    // If not, the last contacts are those that were weighed.
    if (is_further) to_last_contacts(further, part, noise, mode);
  }

  Followed followed_;
  LogKind kind_;
  std::optional<Belief> belief_;  // none before the first row off all corners
  std::optional<Reading> way_{};  // to that row, where it is not the first
  Reading weighed_{};             // of the last row off them
  Reading last_{};                // of the last row
  KeptSamples kept_;
};

// A first contact alone is no log yet.
constexpr std::size_t kLeastRows = 2;

/// One number of both contacts of a placement.
PerFinger<double> both(const HoldPlacement& one, double HoldContact::*number) {
  return {one.contacts[0].*number, one.contacts[1].*number};
}

/// The placement as a mode: finger a's and the wheel's contact.
Mode mode_of(const HoldPlacement& one) {
  Mode mode;
  mode.start = both(one, &HoldContact::start);
  mode.end = both(one, &HoldContact::end);
  mode.tangent = both(one, &HoldContact::tangent);
  mode.probability = one.probability;
  mode.mean = both(one, &HoldContact::mean);
  mode.sd = both(one, &HoldContact::sd);
  mode.interval = {one.contacts[0].interval, one.contacts[1].interval};
  mode.end_mean = both(one, &HoldContact::end_mean);
  mode.end_sd = both(one, &HoldContact::end_sd);
  return mode;
}

/// A pin's log has no psi without an encoder, and its u says nothing.
PinLog pin_log_of(Log rows) {
  std::vector<double>& psi = rows.fingers.front().psi;
  if (std::isnan(psi.front())) psi.clear();
  return {std::move(rows)};
}

/// Where the part lies in an instant leaves nothing behind that the next one could go on with, as long as the first
/// contact is not known: so rows are kept, and what `locate` says of them is asked again and again.
class BesideWheel final : public Meaning {
 public:
  explicit BesideWheel(const Followed& followed)
      : options_(followed.options), problem_{followed.part, {}, followed.fingers} {
    const TrackOptions& options = followed.options;
    problem_.noise = followed.noise;
    problem_.mirrored = options.mirrored;
    problem_.squeezed = options.squeezed;
    problem_.may_overlap = options.may_overlap;
  }

  void add(const Sample& sample) override {
    kept_.add(sample);
    last_ = sample;
  }

  void look(Tracked& answer) override { ask(answer, false); }
  void conclude(Tracked& answer, bool explains) override { ask(answer, explains); }
  bool is_news(const Tracked& said, const Tracked& now) const override {
    return rollfix::is_news(said, now, problem_.part);
  }

 private:
  /// Solves the kept rows and the last one as `locate` would. With fewer than kLeastRows any place fits.
  void ask(Tracked& answer, bool explains) {
    answer.verdict = {Verdict::unobservable};
    answer.rest = 1;
    if (kept_.size() < kLeastRows) return;
    // A copy: the last sample belongs to this look only.
    KeptSamples rows = kept_;
    rows.end_with(last_);
    const Log log = rows.log(LogKind::contact, problem_.part);
    problem_.logs = {one_finger(log, 0)};
    problem_.logs.front().name = options_.name;
    Log pin = one_finger(log, 1);
    pin.name = *options_.name_b;
    problem_.wheels = {{pin_log_of(std::move(pin)), *options_.wheel}};
    problem_.diagnose = explains;
    const auto held = std::make_shared<const HoldAnswer>(solve(problem_));
    answer.verdict = held->verdict;
    answer.verdict.fits_badly = held->is_contradicted();
    answer.rest = held->rest;
    for (const HoldPlacement& one : held->placements) answer.modes.push_back(mode_of(one));
    // All that `solve` says, the part's pose included.
    answer.held = held;
  }

  TrackOptions options_;
  HoldProblem problem_;  // its logs are filled in when it is asked
  KeptSamples kept_;
  Sample last_;  // whether it is kept or not
};

}  // namespace

void KeptSamples::add(const Sample& sample) {
  if (seen_++ % every_ != 0) return;
  kept_.push_back(sample);
  if (kept_.size() < kMostKept) return;
  // Every other one stays, and from now on only half as many samples are kept: still evenly spread. So at least half of
  // kMostKept stay.
  for (std::size_t k = 0; 2 * k < kept_.size(); ++k) kept_[k] = kept_[2 * k];
  kept_.resize((kept_.size() + 1) / 2);
  every_ *= 2;
}

/// Its line tells whether it is kept already.
void KeptSamples::end_with(const Sample& sample) {
  if (kept_.empty() || kept_.back().line != sample.line) kept_.push_back(sample);
}

/// As a log that `solve` takes: unwrapped angles, lengths as the user gave them.
Log KeptSamples::log(LogKind kind, const Part& part, const std::vector<Finger>& fingers, const Noise& noise) const {
  Log log;
  log.kind = kind;
  // A sample has a curvature for each finger, a pin included.
  log.fingers.resize(kept_.empty() ? 1 : kept_.front().finger_curvature.size());
  for (const Sample& sample : kept_) {
    if (sample.time) log.time.push_back(*sample.time);
    for (std::size_t which = 0; which < log.fingers.size(); ++which) {
      add_row(sample, which, kind, part, log.fingers[which]);
    }
  }
  // Digits are not kept: where they put a row on a corner the log states a rounding that does it again.
  for (std::size_t which = 0; which < log.fingers.size(); ++which) {
    const Finger* const finger = finger_of(fingers, which);
    if (finger == nullptr || !finger->has_corners()) continue;
    log.fingers[which].place_rounding = rounding_on_corners(kept_, which, *finger, noise);
  }
  return log;
}

/// All that is known before and that was measured, as one problem of `solve`. Of increments each kept sample stands for
/// `each` of them, whose independent errors add up by the square root.
Problem problem_of(const Followed& followed, LogKind kind, const KeptSamples& kept) {
  const auto& [part, fingers, noise, options] = followed;
  Problem problem{part, kept.log(kind, part, fingers, noise), fingers, noise};
  problem.prior = options.prior;
  problem.pose = followed.belief_options().pose;
  problem.robust = options.robust;
  problem.may_overlap = options.may_overlap;
  if (kind == LogKind::increments) {  // one stands for several, each with its own error
    problem.noise->contact *= std::sqrt(static_cast<double>(kept.each()));
    problem.noise->angle *= std::sqrt(static_cast<double>(kept.each()));
  }
  return problem;
}

BeliefOptions Followed::belief_options() const {
  BeliefOptions belief{noise, options.prior, options.robust};
  belief.pose = options.pose;
  if (belief.pose && options.log.mirrored) {
    // The mirror image of the world has x and headings with the other sign.
    belief.pose->mean.x *= -1;
    belief.pose->mean.heading *= -1;
  }
  return belief;
}

std::unique_ptr<Meaning> meaning_on_part(const Followed& followed, LogKind kind) {
  return std::make_unique<OnPart>(followed, kind);
}

std::unique_ptr<Meaning> meaning_beside_wheel(const Followed& followed) {
  return std::make_unique<BesideWheel>(followed);
}

}  // namespace rollfix
