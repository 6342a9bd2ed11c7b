#include "searches.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "outline/turn.hpp"
#include "part/part_data.hpp"
#include "rollfix/locate.hpp"

// Notation:
//   s0, t0          first contacts of a and b; s_k, t_k: at reading k. One finger starts at s and is at t
//   kappa           curvature there: SlopeSample
//   f_k             residual of reading k, of length L_k and turn theta_k: eqs. (4), (5), of two fingers (8), (9)
//   J               derivatives of the f_k by the first contacts: `jacobian`; J^-1 also of least squares: `inverse`
//   d/dtheta_k = J^-1 e_k, d/dL_k = -(df_k/dL_k) J^-1 e_k   of the first contacts: Sensitivity
// Follows docs/search.md, "ACCURACY" and "MULTIPLE SOLUTIONS".
// Idea: a simple root moves as the implicit function theorem says, and is as exact as f's rounding, kRootTurn, over its
// least slope. A contact that stands at a corner has no slope: it holds its finger, and tells where the other is.
namespace rollfix::locating {
namespace {

// In sensitivities: not defined.
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The size of the curvatures whose differences J's entries are, of two fingers: below kNoSlope times it a singular
/// value is rounding. 1 / P stands in where all curvatures are 0.
double curvature_scale(const ContactEquations& question, const SlopeSample* samples) {
  double scale = 0;
  for (std::size_t k = 0; k < question.readings.size(); ++k) {
    double start = 1 / question.part.perimeter();
    double end = 0;
    for (const double curvature : samples[k].start_curvature) start += std::abs(curvature);
    for (const double curvature : samples[k].end_curvature) end += std::abs(curvature);
    scale = std::max({scale, start, end});
  }
  return scale;
}

/// Error and sensitivity of one finger's crossing: ds/dtheta = 1 / (kappa(t) - kappa(s)) and ds/dL = -kappa(t) /
/// (kappa(t) - kappa(s)); of several readings by least squares. A double root (no slope) keeps an infinite error and an
/// empty sensitivity.
void describe_slopes_of_one(const ContactEquations& question, const SlopeSample* samples, Placement& placement) {
  double square = 0;
  double scale = 0;  // the curvatures whose differences the slopes are
  // Where a reading says no more than an interval, nothing moves with it.
  const auto slope = [&](std::size_t k) {
    return question.readings[k].is_exact() ? samples[k].end_curvature[0] - samples[k].start_curvature[0] : 0;
  };
  for (std::size_t k = 0; k < question.readings.size(); ++k) {
    square += slope(k) * slope(k);
    scale = std::max(scale, std::abs(samples[k].start_curvature[0]) + std::abs(samples[k].end_curvature[0]));
  }
  // |J| as a column: its only singular value.
  const double size = std::sqrt(square);
  if (!(size > kNoSlope * (scale + 1 / question.part.perimeter()))) return;
  placement.error = std::max(kRootLength * question.part.perimeter(), kRootTurn / size);
  for (std::size_t k = 0; k < question.readings.size(); ++k) {
    // df_k/ds = slope(k), df_k/dtheta_k = -1, df_k/dL_k = kappa(t_k). A least-squares root moves by -J^+ times the
    // change of f, J^+ = slope(k) / square.
    placement.sensitivity.per_turn[0].push_back(slope(k) / square);
    placement.sensitivity.per_length[0].push_back(-samples[k].end_curvature[0] * slope(k) / square);
  }
}

/// Error and sensitivity of two fingers' crossing. J by rows [kappa(s_k) - kappa(s0), -(kappa(t_k) - kappa(t0))], the
/// facing row [kappa(s0), -kappa(t0)] last. The error is kRootTurn over the least singular value of J, but at least
/// kRootLength P; where that value is rounding it stays infinite.
template <int Rows>
void describe_slopes_of_two(const ContactEquations& question, const SlopeSample* samples, Placement& placement) {
  const std::size_t count = question.readings.size();
  const auto rows = static_cast<Eigen::Index>(question.rows());
  Eigen::Matrix<double, Rows, 2> jacobian(rows, 2);
  const PerFinger<double>& start = samples[0].start_curvature;
  for (std::size_t k = 0; k < count; ++k) {
    const PerFinger<double>& end = samples[k].end_curvature;
    jacobian.row(static_cast<Eigen::Index>(k)) << end[0] - start[0], -(end[1] - start[1]);
  }
  if (question.facing) jacobian.row(rows - 1) << start[0], -start[1];
  // Singular values by J^T J: 2 by 2 however many rows.
  const Eigen::Matrix2d normal = jacobian.transpose() * jacobian;
  // The eigenvalues of J^T J are the squared singular values: the larger one from trace and determinant, the smaller
  // one as determinant / larger.
  const double trace = normal.trace();
  const double determinant = normal.determinant();
  const double largest = 0.5 * trace + std::sqrt(std::max(0.0, 0.25 * trace * trace - determinant));
  const double smallest = largest > 0 ? std::sqrt(std::max(0.0, determinant / largest)) : 0;
  if (!(smallest > kNoSlope * curvature_scale(question, samples))) return;
  // (J^T J)^-1 J^T: J^-1 itself where there are two rows.
  const Eigen::Matrix<double, 2, Rows> inverse = normal.inverse() * jacobian.transpose();
  placement.error = std::max(kRootLength * question.part.perimeter(), kRootTurn / smallest);
  Sensitivity& sensitivity = placement.sensitivity;
  sensitivity = {PerFinger<ShortList<double>>::of(2), PerFinger<ShortList<PerFinger<double>>>::of(2), {0.0, 0.0}};
  for (const std::size_t finger : {0U, 1U}) {
    const auto row = static_cast<Eigen::Index>(finger);
    for (std::size_t k = 0; k < count; ++k) {
      // d/dtheta_k = J^-1 e_k, d/dLa_k = -kappa(s_k) J^-1 e_k, d/dLb_k = kappa(t_k) J^-1 e_k
      const double by_turn = inverse(row, static_cast<Eigen::Index>(k));
      const PerFinger<double>& end = samples[k].end_curvature;
      sensitivity.per_turn[finger].push_back(by_turn);
      sensitivity.per_length[finger].push_back({-end[0] * by_turn, end[1] * by_turn});
    }
    if (question.facing) sensitivity.per_facing[finger] = inverse(row, rows - 1);
  }
}

/// Which contacts stand at a convex corner.
class CornerContacts {
 public:
  /// `at`: first contacts.
  CornerContacts(const ContactEquations& question, const PerFinger<double>& at) {
    for (std::size_t finger = 0; finger < at.size(); ++finger) {
      first_[finger] = angle_set(question.part, at[finger]).pivot;
      for (const Reading& reading : question.readings) {
        last_[finger].push_back(angle_set(question.part, at[finger] + reading.length[finger]).pivot);
      }
    }
  }

  /// Does the first contact stand there, or the one at the end of a reading?
  bool at_start(std::size_t finger) const { return first_[finger]; }
  bool at_end(std::size_t finger, std::size_t reading) const { return last_[finger][reading]; }
  /// Does any contact of this finger stand at a convex corner?
  bool holds(std::size_t finger) const {
    return first_[finger] || std::find(last_[finger].begin(), last_[finger].end(), true) != last_[finger].end();
  }
  std::size_t readings() const { return last_[0].size(); }

 private:
  // [finger], and [finger][reading].
  std::array<bool, 2> first_{};
  std::array<boost::container::small_vector<bool, 4>, 2> last_;
};

/// Sensitivity of a finger that a corner holds. With its start there, s does not move. With an end there, s + L is the
/// corner, so that ds/dL = -1. With both, L is the length between two corners, and a reading with another L has no such
/// placement: NaN.
void describe_held(const CornerContacts& contacts, std::size_t finger, Sensitivity& sensitivity) {
  const bool start = contacts.at_start(finger);
  for (std::size_t k = 0; k < contacts.readings(); ++k) {
    const bool end = contacts.at_end(finger, k);
    PerFinger<double> per_length = PerFinger<double>::of(sensitivity.per_turn.size());
    per_length[finger] = start ? (end ? kNaN : 0) : (end ? -1 : 0);
    sensitivity.per_turn[finger].push_back(start && end ? kNaN : 0);
    sensitivity.per_length[finger].push_back(per_length);
  }
}

/// The other finger of two is held. Readings whose other end pivots tell nothing; a pivot w of the other's first
/// contact is one more unknown: with sign +1 for finger a and -1 for b
///   sign (kappa(s_k) - kappa(s0)) ds + w = dtheta_k - sum over both of sign kappa_k dL_k,  sign kappa(s0) ds - w = dC.
void describe_free(const ContactEquations& question, const PerFinger<double>& at, const CornerContacts& contacts,
                   std::size_t finger, Sensitivity& sensitivity) {
  const std::size_t other = 1 - finger;
  const std::size_t count = question.readings.size();
  const double sign = finger == 0 ? 1 : -1;
  const bool pivots = contacts.at_start(other);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(question.rows()), pivots ? 2 : 1);
  Eigen::VectorXd of_other = Eigen::VectorXd::Zero(rows.rows());  // by the other finger's start
  std::vector<SlopeSample> samples;
  for (std::size_t k = 0; k < count; ++k) {
    samples.push_back(slope_sample(question.part, question.readings[k], at));
    // Its equation is met by the pivot at that end, whatever the free finger does.
    if (contacts.at_end(other, k)) continue;
    const SlopeSample& sample = samples.back();
    const auto row = static_cast<Eigen::Index>(k);
    rows(row, 0) = sign * (sample.end_curvature[finger] - sample.start_curvature[finger]);
    if (pivots) rows(row, 1) = 1;
    // df_k by the other finger's first contact.
    of_other[row] = -sign * (sample.end_curvature[other] - sample.start_curvature[other]);
  }
  if (question.facing) {
    rows(rows.rows() - 1, 0) = sign * samples[0].start_curvature[finger];
    if (pivots) rows(rows.rows() - 1, 1) = -1;
    of_other[rows.rows() - 1] = -sign * samples[0].start_curvature[other];
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(rows);
  // Fewer independent rows than unknowns: the finger is not determined, all its entries are NaN.
  qr.setThreshold(kNoSlope);
  if (qr.rank() < rows.cols()) rows.setConstant(kNaN);
  // Row 0 of the pseudo-inverse: how the free finger's contact follows each row's right side.
  const Eigen::VectorXd inverse = (rows.transpose() * rows).inverse().row(0) * rows.transpose();
  for (std::size_t k = 0; k < count; ++k) {
    const double by_turn = inverse[static_cast<Eigen::Index>(k)];
    PerFinger<double> per_length(0.0, 0.0);
    per_length[finger] = -sign * samples[k].end_curvature[finger] * by_turn;
    // The other finger stays at its corner: where its end stands there, a longer roll starts further back.
    per_length[other] = contacts.at_end(other, k) ? inverse.dot(of_other)  // there dt = -dL
                                                  : sign * samples[k].end_curvature[other] * by_turn;
    sensitivity.per_turn[finger].push_back(by_turn);
    sensitivity.per_length[finger].push_back(per_length);
  }
  if (question.facing) sensitivity.per_facing[finger] = inverse[rows.rows() - 1];
}

}  // namespace

SlopeSample slope_sample(const Part& part, const Reading& reading, const PerFinger<double>& at) {
  SlopeSample sample{-reading.turn, at, at};
  for (std::size_t finger = 0; finger < at.size(); ++finger) {
    const Turning start = part.turning().at(at[finger]);
    const Turning end = part.turning().at(at[finger] + reading.length[finger]);
    sample.value += (finger == 0 ? 1 : -1) * (end.angle - start.angle);
    sample.start_curvature[finger] = start.curvature;
    sample.end_curvature[finger] = end.curvature;
  }
  return sample;
}

void describe_slopes(const ContactEquations& question, const SlopeSample* samples, Placement& placement) {
  placement.error = kInfinity;
  // A double root, a near miss or a continuum has no derivative: the extent says how far it reaches.
  if (placement.kind != Kind::crossing) return;
  if (question.fingers() == 1) {
    describe_slopes_of_one(question, samples, placement);
  } else if (question.is_overdetermined()) {
    describe_slopes_of_two<Eigen::Dynamic>(question, samples, placement);
  } else {
    // Two rows: matrices of fixed size, without allocation.
    describe_slopes_of_two<2>(question, samples, placement);
  }
}

/// Error and sensitivity need no further evaluation: f and both curvatures at the root are the search's sample.
void PlacementMaker::make_crossing(double root, std::size_t panel, const Interval& extent, const SlopeSample& sample,
                                   Placement& placement) const {
  placement.kind = Kind::crossing;
  place(root, panel, placement);
  placement.extent[0] = question_.part.boundary().arc(extent.lo, extent.hi);
  placement.roots.push_back(placement.start);
  placement.residual = std::abs(sample.value);
  describe_slopes(question_, &sample, placement);
}

void PlacementMaker::make(FoundSet&& found, Placement& placement) const {
  const Boundary boundary = question_.part.boundary();
  placement.kind = found.kind;
  place(found.start, 0, placement);
  placement.whole_loop = found.whole_loop;
  placement.extent = found.extent;
  for (std::size_t finger = 0; finger < question_.fingers(); ++finger) {
    const Interval& extent = found.extent[finger];
    // Places and arcs get their one name: in [0, P), an arc's end perhaps beyond P.
    placement.extent[finger] = found.whole_loop[finger] ? boundary.full_arc() : boundary.arc(extent.lo, extent.hi);
  }
  for (PerFinger<double> root : found.roots) {
    for (double& s : root) s = boundary.canonical(s);
    placement.roots.push_back(root);
  }
  placement.family = std::move(found.family);
  placement.family_error = found.family_error;
  // Theta is set-valued at a corner: residual, error and sensitivity are those of pivots, not of slopes.
  if (placement.kind == Kind::corner) {
    placement.residual = residual_at(question_, found.start);
    describe_corner(found, placement);
  } else {
    describe_contacts(found.start, placement);
  }
}

/// Residual and slopes; all contacts are looked up once.
void PlacementMaker::describe_contacts(const PerFinger<double>& start, Placement& placement) const {
  const TurningFunction& turning = question_.part.turning();
  std::array<Tangents, 2> tangents;
  boost::container::small_vector<SlopeSample, 4> samples;
  for (const Reading& reading : question_.readings) samples.push_back({-reading.turn, start, start});
  for (std::size_t finger = 0; finger < start.size(); ++finger) {
    // Theta and kappa of a contact are used for the residual and for the slopes of every reading.
    const Turning first = turning.at(start[finger]);
    tangents[finger].push_back(first.angle);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const Turning last = turning.at(start[finger] + question_.readings[k].length[finger]);
      tangents[finger].push_back(last.angle);
      samples[k].start_curvature[finger] = first.curvature;
      samples[k].end_curvature[finger] = last.curvature;
    }
  }
  // One finger's residual checks for corners by itself, and so does that of two on a part with corners.
  const bool plain = start.size() == 2 && question_.part.corners().empty();
  placement.residual = plain ? residual_of(question_, tangents[0], tangents[1]) : residual_at(question_, start);
  describe_slopes(question_, samples.data(), placement);
}

void PlacementMaker::place(const PerFinger<double>& start, std::size_t likely_panel, Placement& placement) const {
  const Reading& last = question_.readings.back();
  placement.start = placement.end = placement.tangent = start;
  if (start.size() == 2) placement.point = {Vec2(), Vec2()};
  for (std::size_t finger = 0; finger < start.size(); ++finger) {
    placement.start[finger] = question_.part.boundary().canonical(start[finger]);
    placement.end[finger] = question_.part.boundary().canonical(start[finger] + last.length[finger]);
    const Touched contact = PartAccess::contact(question_.part, placement.start[finger], likely_panel);
    placement.point[finger] = contact.point;
    placement.tangent[finger] = contact.tangent;
  }
}

/// A contact that stands at a corner holds its finger: at the start the start, at the end the end, so that the start
/// follows L alone. What a held finger leaves open tells where the other one is.
void PlacementMaker::describe_corner(const FoundSet& found, Placement& placement) const {
  const std::size_t fingers = question_.fingers();
  placement.error = kRootLength * question_.part.perimeter();
  placement.pivot = pivots_at(question_, found.start, placement.end);
  // The tangent of a pivot: the middle of those that fit, in [-pi, pi].
  if (fingers == 1) placement.tangent = std::remainder((*placement.pivot)[0].start.middle(), kFullTurn);
  placement.sensitivity = {PerFinger<ShortList<double>>::of(fingers),
                           PerFinger<ShortList<PerFinger<double>>>::of(fingers), PerFinger<double>::of(fingers)};
  const CornerContacts contacts(question_, found.start);
  for (std::size_t finger = 0; finger < fingers; ++finger) {
    // A held finger follows lengths alone; the other one is determined by what the held one's pivots leave of the
    // equations. Where neither is held the entries stay empty.
    if (fingers == 1 || contacts.holds(finger)) {
      describe_held(contacts, finger, placement.sensitivity);
    } else if (contacts.holds(1 - finger)) {
      describe_free(question_, found.start, contacts, finger, placement.sensitivity);
    }
  }
}

}  // namespace rollfix::locating
