#include "rollfix/watch/meaning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

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
  Problem problem{part, kept.log(kind, part), watch.fingers, options.noise};
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

class OnPart final : public Meaning {
 public:
  OnPart(const Part& part, const WatchOptions& options, LogKind kind, const Sample& first)
      : part_(part),
        options_(options),
        kind_(kind),
        belief_(part, kind, as_read(options), contacts_at(first, options.fingers)) {}

  void add(const Sample& sample) override {
    belief_.add(sample);
    kept_.add(sample);
  }

  void look(WatchAnswer& answer) override {
    answer.verdict = belief_.verdict();
    answer.modes = belief_.modes();
    for (Mode& mode : answer.modes) mode.probability = std::min(1.0, mode.probability);  // a sum, with its rounding
    answer.rest = belief_.rest();
    answer.fit = belief_.fit();
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
  Part part_;
  WatchOptions options_;
  LogKind kind_;
  Belief belief_;
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

/// A finger's. Of two fingers only the difference of their turns is known, which goes with the first one.
void add_row(const Sample& sample, std::size_t which, LogKind kind, const Part& part, FingerRows& rows) {
  rows.u_period = std::numeric_limits<double>::infinity();  // a sample's angles are unwrapped
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

Log KeptSamples::log(LogKind kind, const Part& part) const {
  Log log;
  log.kind = kind;
  log.fingers.resize(kept_.empty() ? 1 : kept_.front().reading.fingers());
  for (const Sample& sample : kept_) {
    if (sample.time) log.time.push_back(*sample.time);
    for (std::size_t which = 0; which < log.fingers.size(); ++which) {
      add_row(sample, which, kind, part, log.fingers[which]);
    }
  }
  return log;
}

std::unique_ptr<Meaning> meaning_on_part(const Part& part, const WatchOptions& options, LogKind kind,
                                         const Sample& first) {
  return std::make_unique<OnPart>(part, options, kind, first);
}

std::unique_ptr<Meaning> meaning_on_catalog(const Part& part, const WatchOptions& options, LogKind kind) {
  return std::make_unique<OnCatalog>(part, options, kind);
}

}  // namespace rollfix::app
