#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "belief/posterior.hpp"
#include "held_rows.hpp"
#include "hold_fit.hpp"
#include "locate/remaining.hpp"
#include "outline/turn.hpp"
#include "rollfix/hold.hpp"
#include "steps.hpp"
#include "touch/posterior.hpp"
#include "work/pulse.hpp"

// Notation:
//   n               error of a contact along the boundary: s = z + L / (1 + e) - n; its row's normal tells of it
//   u, C            unknowns and their covariance at a node: HoldNode::covariance; g: change of a number with u
//   w_k             weight of node k: `weights_of`
// Follows docs/two_fingers.md, "How three fingers are searched", step 3.
// Idea: at each node every number is normal, with variance g^T C g and what is left with u given. Over a mode it is a
// mixture of these: mean = sum of w_k m_k, second moment = sum of w_k (v_k + m_k^2).
namespace rollfix::hold {
namespace {

constexpr double kShareOfInterval = 0.95;

/// A number at one node: mean and variance.
struct AtNode {
  double mean = 0;
  double variance = 0;
};

/// Where a contact was at a row: s = z + L / (1 + e) - n, with n as the row's normal tells it.
AtNode place_at(const HoldFit& fit, const HoldNode& node, std::size_t row, std::size_t finger) {
  const auto count = static_cast<Eigen::Index>(fit.fingers());
  const auto k = static_cast<Eigen::Index>(finger);
  const PoseAtRow pose = fit.pose_at(node.state, row);
  const HoldFit::ContactError error = fit.contact_error(node.state, row, finger);
  // d s / du: 1 by the first contact, -L by the stretch.
  Unknowns by = Unknowns::Zero(fit.size());
  by(k) = 1;
  if (fit.has_stretches()) by(count + k) = -fit.rows().rows[row].contacts[finger].travelled;
  // d phi / du; r = tau - phi - Theta(s) changes by -(kappa ds + dphi), and the error n by by_turn times that.
  const Unknowns turned = pose.by_unknowns.row(2).transpose();
  const Unknowns all = by + error.by_turn * (error.curvature * by + turned);
  AtNode at;
  // The place less the error of its contact that the normal shows.
  at.mean = fit.place_of(node.state, row, finger) - error.mean;
  // By the unknowns; by the heading with these given; and what is left of n.
  at.variance = all.dot(node.covariance * all) + error.by_turn * error.by_turn * pose.covariance(2, 2) + error.variance;
  return at;
}

/// Where a wheel touched at a row: by the pose of the row, with and without the unknowns given.
AtNode wheel_place_at(const HoldFit& fit, const HoldNode& node, std::size_t row, std::size_t wheel) {
  const PoseAtRow pose = fit.pose_at(node.state, row);
  const HoldFit::WheelAt there = fit.wheel_at(node.state, row, wheel);
  const Eigen::Matrix3d covariance =
      pose.covariance + pose.by_unknowns * node.covariance * pose.by_unknowns.transpose();
  return {there.s, there.variance + there.by_pose.dot(covariance * there.by_pose.transpose())};
}

/// Weights of a mode's nodes, together 1.
std::vector<double> weights_of(const HoldMode& mode) {
  std::vector<double> weights;
  double sum = 0;
  for (const HoldNode& node : mode.nodes) {
    // The mode's own weight is only taken out against overflow: the sum is divided by below.
    weights.push_back(node.width * std::exp(node.log_density - mode.log_weight));
    sum += weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// Mean and standard deviation of a finger's stretch or a wheel's radius over the nodes, as a factor. Nothing if it
/// is no unknown.
void add_length_scale(HoldContact& contact, const HoldFit& fit, const HoldMode& mode,
                      const std::vector<double>& weights, std::size_t contact_number) {
  const auto unknown = fit.scale_unknown(contact_number);
  if (!unknown) return;
  const Eigen::Index k = *unknown;
  double mean = 0, second = 0;
  for (std::size_t node = 0; node < weights.size(); ++node) {
    // Mixture of normals: second moments add.
    const double stretch = mode.nodes[node].state.unknowns(k);
    mean += weights[node] * stretch;
    second += weights[node] * (stretch * stretch + mode.nodes[node].covariance(k, k));
  }
  std::tie(contact.length_scale, contact.length_scale_sd) =
      fit.scale_of_lengths(contact_number, mean, std::sqrt(std::max(0.0, second - mean * mean)));
}

/// The part's pose at a row over all nodes: mean and covariance, about a pose so that headings don't wrap.
PoseSpread spread_of(const HoldFit& fit, const HoldMode& mode, const std::vector<double>& weights, std::size_t row,
                     const Pose& about) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const PoseAtRow at = fit.pose_at(mode.nodes[k].state, row);
    const Eigen::Vector3d off(at.pose.x - about.x, at.pose.y - about.y, nearest_angle(at.pose.heading - about.heading));
    const Eigen::Matrix3d covariance =
        at.covariance + at.by_unknowns * mode.nodes[k].covariance * at.by_unknowns.transpose();
    mean += weights[k] * off;
    second += weights[k] * (covariance + off * off.transpose());
  }
  PoseSpread spread;
  spread.mean = {about.x + mean(0), about.y + mean(1), about.heading + mean(2)};
  spread.covariance = second - mean * mean.transpose();
  return spread;
}

/// A contact's place at a row: mean in [0, P), standard deviation and 95 % interval.
struct Summary {
  double mean = 0;
  double sd = 0;
  Interval interval;
};

/// `contact`: a finger's number, or fingers() and a wheel's number behind them.
Summary summary_of(const HoldFit& fit, const HoldMode& mode, const std::vector<double>& weights, std::size_t row,
                   std::size_t contact, const Boundary& boundary) {
  const bool is_wheel = contact >= fit.fingers();
  // Places are averaged as offsets from the best one, so that s = 0 is no seam.
  const double about =
      is_wheel ? fit.wheel_at(mode.best, row, contact - fit.fingers()).s : fit.place_of(mode.best, row, contact);
  std::vector<MixtureTerm> terms;
  double mean = 0, second = 0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const AtNode at = is_wheel ? wheel_place_at(fit, mode.nodes[k], row, contact - fit.fingers())
                               : place_at(fit, mode.nodes[k], row, contact);
    const double off = boundary.offset(about, at.mean);
    terms.push_back({weights[k], about + off, std::sqrt(at.variance)});
    mean += weights[k] * off;
    second += weights[k] * (at.variance + off * off);
  }
  Summary summary;
  summary.mean = boundary.canonical(about + mean);
  summary.sd = std::sqrt(std::max(0.0, second - mean * mean));
  // Equal shares of probability are left out on both sides.
  const Interval range = touch::middle_share(terms, kShareOfInterval);
  summary.interval = boundary.closed ? boundary.arc(range.lo, range.hi)
                                     : Interval{std::clamp(range.lo, 0.0, boundary.perimeter),
                                                std::clamp(range.hi, 0.0, boundary.perimeter)};
  return summary;
}

/// Where a wheel touches in a state.
HoldContact described_wheel(const HoldFit& fit, const Part& part, const HeldState& state, std::size_t wheel,
                            const Interval& extent) {
  const std::size_t last = fit.rows().rows.size() - 1;
  const Boundary boundary = part.boundary();
  HoldContact contact;
  contact.start = boundary.canonical(fit.wheel_at(state, 0, wheel).s);
  contact.end = boundary.canonical(fit.wheel_at(state, last, wheel).s);
  contact.extent = extent;
  contact.point = part.point(contact.start);
  contact.tangent = part.tangent(contact.start);
  for (std::size_t row = 0; row <= last; ++row) {
    // Distance from the path of pins, and the encoder's angle.
    const ContactResidual off = fit.wheel_residual(state, row, wheel);
    contact.distance = std::max(contact.distance, off.place.norm());
    contact.turn = std::max(contact.turn, std::abs(off.turn));
  }
  return contact;
}

}  // namespace

/// With noise a contact is shown where its normal has it, z + L / (1 + e) - n; without noise where its length has it.
/// Residuals are the largest over the rows.
HoldPlacement described(const HoldFit& fit, const Part& part, const HeldState& state, const HeldSet& set) {
  HoldPlacement placement;
  const Boundary boundary = part.boundary();
  const std::size_t last = fit.rows().rows.size() - 1;
  for (std::size_t k = 0; k < fit.fingers(); ++k) {
    HoldContact contact;
    // Without noise contacts are known to their digits, and n is not estimated.
    const double first_error = fit.rows().has_noise ? fit.contact_error(state, 0, k).mean : 0;
    const double last_error = fit.rows().has_noise ? fit.contact_error(state, last, k).mean : 0;
    contact.start = boundary.canonical(fit.place_of(state, 0, k) - first_error);
    contact.end = boundary.canonical(fit.place_of(state, last, k) - last_error);
    contact.extent = set.extent[k];
    contact.point = part.point(contact.start);
    contact.tangent = part.tangent(contact.start);
    for (std::size_t row = 0; row <= last; ++row) {
      const ContactResidual off = fit.residual(state, row, k);
      if (fit.rows().errors[k].has_place) contact.distance = std::max(contact.distance, off.place.norm());
      contact.turn = std::max(contact.turn, std::abs(off.turn));
    }
    placement.residual.length = std::max(placement.residual.length, contact.distance);
    placement.residual.turn = std::max(placement.residual.turn, contact.turn);
    placement.contacts.push_back(contact);
  }
  for (std::size_t k = 0; k < fit.wheels(); ++k) {
    placement.contacts.push_back(described_wheel(fit, part, state, k, set.wheels[k]));
    placement.residual.length = std::max(placement.residual.length, placement.contacts.back().distance);
    placement.residual.turn = std::max(placement.residual.turn, placement.contacts.back().turn);
  }
  placement.first = fit.pose_at(state, 0).pose;
  placement.last = fit.pose_at(state, last).pose;
  // In (-pi, pi].
  placement.first.heading = nearest_angle(placement.first.heading);
  placement.last.heading = nearest_angle(placement.last.heading);
  // With noise chi-square says how well it fits.
  placement.worst = fit.rows().has_noise ? 0 : fit.worst(state);
  placement.chi_square = state.right_square;
  return placement;
}

/// Means, standard deviations and intervals at the first and at the last row, and the spreads of both poses.
void add_posterior(HoldPlacement& placement, const HoldFit& fit, const Part& part, const HoldMode& mode) {
  const std::vector<double> weights = weights_of(mode);
  const std::size_t last = fit.rows().rows.size() - 1;
  const Boundary boundary = part.boundary();
  for (std::size_t k = 0; k < fit.fingers() + fit.wheels(); ++k) {
    const Summary start = summary_of(fit, mode, weights, 0, k, boundary);
    const Summary end = summary_of(fit, mode, weights, last, k, boundary);
    HoldContact& contact = placement.contacts[k];
    contact.mean = start.mean;
    contact.sd = start.sd;
    contact.interval = start.interval;
    contact.end_mean = end.mean;
    contact.end_sd = end.sd;
    add_length_scale(contact, fit, mode, weights, k);
  }
  placement.first_spread = spread_of(fit, mode, weights, 0, placement.first);
  placement.last_spread = spread_of(fit, mode, weights, last, placement.last);
  placement.continuum = mode.continuum;
}

/// Chi-square without outliers, and without what was known of the first contact and the pose. Without freedom p stays
/// 1: nothing can contradict.
TouchFit fit_of(const HoldFit& fit, const HeldState& state) {
  TouchFit result;
  result.chi_square = state.right_square;
  const double freedom = fit.freedom(state);
  result.freedom = std::max(0, static_cast<int>(std::lround(freedom)));
  if (result.freedom > 0) result.p = belief::p_of_chi_square(result.chi_square, result.freedom);
  return result;
}

}  // namespace rollfix::hold

// ---- all steps
// Notation:
//   row, instant    of the logs; of them one that is searched with
//   box, set        an arc of first contacts for each finger; boxes that hang together: one placement or more
//   glance          a quick look for the likeliest place, by hold_mistakes.cpp
// Follows docs/two_fingers.md, "Three and more fingers", and docs/rig.md.
// Idea: boxes of first contacts are searched by some instants (box_search.cpp). With noise the posterior by all rows is
// taken over the sets that are left (weigh_holds.cpp). Without noise each set needs first contacts that fit
// (held_question.cpp). Boxes that can't be decided are reported, and make the answer incomplete.
namespace rollfix {
namespace hold {
namespace {

constexpr double kFreeHold = 0.05;  // of the perimeter: without noise what is confined no better is a continuum

/// One problem whose logs are aligned and checked; of a part face down as a mirror shows it.
class HoldSolver {
 public:
  HoldSolver(const HoldProblem& problem, const std::vector<Log>& logs, const WheelPaths& wheels, Care care,
             HoldAnswer& answer)
      : problem_(problem),
        care_(care),
        answer_(answer),
        boundary_(problem.part.boundary()),
        wheels_(wheels),
        question_(problem, held_rows(problem, logs), rows_to_search(problem, logs.front()), wheels),
        apart_(problem, question_.rows()) {}

  /// Search, then placements, then the verdict.
  void run() {
    for (const HeldRow& row : question_.searched().rows) answer_.instants.push_back(row.time);
    // Wheels keep length 0: theirs was not measured.
    for (std::size_t k = 0; k < question_.rows().fingers(); ++k) {
      answer_.rolls[k].length = question_.searched().rows.back().contacts[k].travelled;
    }
    const HeldRows& rows = question_.rows();
    // Without places as evidence the pose is by a finger's centre, or its position is unknown.
    if (!rows.any_place) answer_.place = rows.reference ? PlaceKnown::reference : PlaceKnown::unknown;
    Boxes boxes = question_.search().search();
    // At a glance boxes that the budget left are taken as they are: nothing is proved.
    if (care_ == Care::glance) {
      boxes.fit.insert(boxes.fit.end(), boxes.undecided.begin(), boxes.undecided.end());
      boxes.undecided.clear();
    }
    if (rows.has_noise) {
      weigh(problem_, rows, question_.searched(), question_.sets(boxes.fit), question_.search(), wheels_, care_,
            answer_);
      add_unresolved(boxes.undecided);
    } else {
      add_witnessed(std::move(boxes));
    }
    answer_.comparisons = question_.search().comparisons();
    conclude();
  }

 private:
  /// Without noise: a placement for each set with a witness, and for each other pose at the ends that fits as well.
  void add_witnessed(Boxes boxes) {
    HoldFit fit(problem_.part, question_.searched(), wheels_);
    Witnessed found = witnessed(question_, fit, std::move(boxes), &apart_);
    for (const WitnessedSet& one : found.sets) {
      if (one.overlaps) {
        ++answer_.overlap;
        continue;
      }
      for (const HeldState& state : fit.poses_at_ends(one.state)) {
        // Another pose at an end may be beyond its tolerance.
        if (fit.worst(state) > 1) continue;
        answer_.placements.push_back(described(fit, problem_.part, state, one.set));
        answer_.placements.back().continuum = is_free(fit, state, one.set);
      }
    }
    // A box in which nothing was found, but that can't be excluded, is undecided as well.
    found.undecided.insert(found.undecided.end(), found.doubtful.begin(), found.doubtful.end());
    add_unresolved(found.undecided);
    std::sort(answer_.placements.begin(), answer_.placements.end(),
              [](const HoldPlacement& a, const HoldPlacement& b) { return a.contacts[0].start < b.contacts[0].start; });
  }

  /// Whether the instants confine the first contacts no better than to a large share of the boundary.
  bool is_free(const HoldFit& fit, const HeldState& state, const HeldSet& set) const {
    double widest = 0;
    for (const Interval& arc : set.extent) widest = std::max(widest, arc.width());
    const UnknownsMatrix information = fit.reduced(state).matrix;
    const auto fingers = static_cast<Eigen::Index>(fit.fingers());  // an encoder's zero is no place
    const UnknownsMatrix places = information.topLeftCorner(fingers, fingers);
    // The information on the direction that is known worst, 1 / length^2 in units of the tolerances.
    const double weakest = Eigen::SelfAdjointEigenSolver<UnknownsMatrix>(places).eigenvalues()(0);
    const double confined = kFreeHold * boundary_.perimeter;
    return widest > 1e-3 * boundary_.perimeter && !(weakest > 1 / (confined * confined));
  }

  /// Arcs, of each finger and wheel, where an unlisted placement may be: one entry for each set of connected boxes.
  void add_unresolved(const std::vector<Box>& boxes) {
    if (boxes.empty()) return;
    for (const FoundSet& one : question_.sets(boxes)) {
      answer_.unresolved.push_back(one.set.extent);
      answer_.unresolved.back().insert(answer_.unresolved.back().end(), one.set.wheels.begin(), one.set.wheels.end());
    }
  }

  /// The verdict, by what is listed; incomplete wins over everything.
  void conclude() {
    const bool fits_badly = answer_.is_contradicted();
    if (!answer_.unresolved.empty()) {
      answer_.status = Status::incomplete;
      answer_.verdict = {Verdict::undecided, 0, 0, fits_badly};
      return;
    }
    // A continuum that goes all the way round some finger's boundary: such a roll does not determine it.
    const auto is_anywhere = [&](const HoldPlacement& one) {
      return one.continuum && std::any_of(one.contacts.begin(), one.contacts.end(), [&](const HoldContact& contact) {
               return boundary_.is_full(contact.extent);
             });
    };
    answer_.verdict = verdict_of(answer_.placements, is_anywhere, fits_badly);
  }

  const HoldProblem& problem_;
  Care care_;
  HoldAnswer& answer_;
  Boundary boundary_;
  const WheelPaths& wheels_;
  HeldQuestion question_;
  FingersApart apart_;
};

/// Of all fingers and wheels, for the answer.
TouchTolerance largest_tolerance(const HeldRows& rows) {
  TouchTolerance most;
  for (const HeldErrors& errors : rows.errors) {
    most.length = std::max(most.length, errors.has_place ? errors.place : 0);
    most.angle = std::max(most.angle, errors.angle);
  }
  for (const HeldWheel& wheel : rows.wheels) most.length = std::max(most.length, wheel.place);
  return most;
}

}  // namespace

/// Refusals come before the search: the problem itself, wheels and fingers inside each other, angles that may be
/// wrapped.
HoldAnswer solve_plain(const HoldProblem& problem, Care care) {
  require_valid(problem);
  const WheelPaths wheels = paths_of(problem);
  std::vector<Log> logs = logs_of(problem);
  require_wheels_apart(problem, logs);
  HoldAnswer answer{problem.part, {}};
  if (problem.robust) answer.jumps = leave_out_jumps(problem, logs);
  require_clear(problem, logs);
  for (std::size_t k = 0; k < logs.size(); ++k) answer.rolls.push_back(roll_of(problem, logs[k], k));
  answer.rows = logs.front().rows();
  answer.noise = problem.noise;
  answer.squeezed = problem.squeezed;
  answer.mirrored = problem.mirrored;
  answer.robust = problem.robust;
  answer.prior = problem.prior;
  answer.pose = problem.pose;
  // By x and y in the world, as given: a mirror changes no distance.
  require_apart(problem, logs);
  // A part face down is searched in a mirror, and the answer taken back.
  const HoldProblem seen = problem.mirrored ? in_mirror(problem, logs) : problem;
  if (!problem.noise) answer.tolerance = largest_tolerance(held_rows(seen, logs));
  HoldSolver(seen, logs, wheels, care, answer).run();
  if (problem.mirrored) out_of_mirror(answer);
  return answer;
}

}  // namespace hold

/// Mistakes are looked for only where the search is complete, and nothing fits or the noise is contradicted.
HoldAnswer solve(const HoldProblem& problem) {
  const Doing doing("looking for places that fit all fingers");
  HoldAnswer answer = hold::solve_plain(problem);
  const bool is_wrong = answer.placements.empty() || answer.verdict.fits_badly;
  if (!problem.diagnose || answer.status != Status::complete || !is_wrong) return answer;
  const Doing looking("looking for what explains the misfit");
  answer.diagnoses = hold::mistakes(problem, answer);
  answer.was_diagnosed = true;
  return answer;
}

std::string HoldAnswer::verdict_text() const { return text_of_verdict(verdict, "measurements"); }

}  // namespace rollfix
