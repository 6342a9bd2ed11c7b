// What a finger with skin and a wheel without measure, while they hold a part that moves: docs/rig.md.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "rollfix/hold.hpp"
#include "watch/kept_samples.hpp"

namespace rollfix {
namespace {

// A first contact alone is no log yet.
constexpr std::size_t kLeastRows = 2;

PerFinger<double> both(const HoldPlacement& one, double HoldContact::*number) {
  return {one.contacts[0].*number, one.contacts[1].*number};
}

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
  void ask(Tracked& answer, bool explains) {
    answer.verdict = {Verdict::unobservable};
    answer.rest = 1;
    if (kept_.size() < kLeastRows) return;
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
    answer.held = held;
  }

  TrackOptions options_;
  HoldProblem problem_;
  KeptSamples kept_;
  Sample last_;
};

}  // namespace

std::unique_ptr<Meaning> meaning_beside_wheel(const Followed& followed) {
  return std::make_unique<BesideWheel>(followed);
}

}  // namespace rollfix
