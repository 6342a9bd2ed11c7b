#include "watch/kept_samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "answer/finger_corners.hpp"
#include "log/log_rows.hpp"

namespace rollfix {
namespace {

// A roll is looked at as a whole by no more samples than these.
constexpr std::size_t kMostKept = 4096;

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

Problem problem_of(const Followed& followed, LogKind kind, const KeptSamples& kept) {
  const auto& [part, fingers, noise, options] = followed;
  Problem problem{part, kept.log(kind, part, fingers, noise), fingers, noise};
  problem.prior = options.prior;
  problem.pose = followed.belief_options().pose;
  problem.robust = options.robust;
  problem.may_overlap = options.may_overlap;
  if (kind == LogKind::increments) {  // one stands for several, which were off each
    problem.noise->contact *= std::sqrt(static_cast<double>(kept.each()));
    problem.noise->angle *= std::sqrt(static_cast<double>(kept.each()));
  }
  return problem;
}

}  // namespace rollfix
