#include "belief/error_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "belief/posterior.hpp"

// Notation, as in docs/belief.md, "What the noise is", "What is known, and what is not" and "How far the finger
// travelled":
//   n, a            a row's own errors of the contact's place and of the angle: `contact_variance`, `angle_variance`
//   n0, a0          the same of the first row, which all rows share: offsets in `start_`(0, 0), (0, 1), (1, 1)
//   eps, gamma      scale of lengths and of a gyroscope's turns: variances `start_`(2, 2), (3, 3)
//   b               a gyroscope's bias: variance `start_`(4, 4)
//   kappa           here the finger's curvature, 1 / r: `finger_curvature`
//   R, P0, G        `row()`, `start()`, and what gathers from row to row: `gathered()`
//   mark            a measured length with its variance, of the rows that were joined for it: Travel::Mark
//   sd              of the difference of two lengths: with `per_row_` for each row between them where errors add up
//   apart           two lengths that differ by `kFarthest` sd or more: `certain`
// Two fingers share n0 of each, eps of each and, without the facing, the first turn: `PairErrors`, docs/two_fingers.md,
// "The errors". Follows docs/belief.md, the paragraphs named above.
// Idea: one table of standard deviations (`Noise`) becomes the three covariances that every filter needs. Constants
// that were measured by simulation instead of derived are marked "calibrated". Steps between noisy lengths add up to
// far more than was travelled. So each length is compared with the last one that is apart from it for certain, and the
// way between them is spread evenly over the rows in between, once.
namespace rollfix::belief {
namespace {

// Of what lies between two lengths that are apart for certain, no more than this many times is given out: without it a
// rest would go on with what came before it, and with less room chance would take away more than it adds.
constexpr double kMostGivenOut = 1.1;

}  // namespace

double Travel::since_last(const Mark& mark) const {
  // From the last mark backwards to the last one that is apart for certain.
  const double rows = mark.row - marks_.back().row;
  // The mark that was looked at before `other`. It is not apart for certain: the way just long enough for that ends
  // between the two.
  Mark nearer = mark;
  for (std::size_t k = marks_.size(); k-- > 0;) {
    const Mark& other = marks_[k];
    const double apart = std::abs(mark.length - other.length);
    const double certain =
        kFarthest * std::sqrt(mark.variance + other.variance + per_row_ * std::abs(mark.row - other.row));
    if (apart >= certain) {
      if (k + 1 == marks_.size()) return apart;
      // Between the two the length was just that far off.
      const double near_apart = std::abs(mark.length - nearer.length);
      const double share = std::clamp((certain - near_apart) / (apart - near_apart), 0.0, 1.0);
      const double row = nearer.row + share * (other.row - nearer.row);
      const double so_far = so_far_[k + 1] + share * (so_far_[k] - so_far_[k + 1]);
      // What of that way was given out since there is taken off; the rows since the last mark have an even share at
      // most.
      const double left = kMostGivenOut * certain - (so_far_.back() - so_far);
      return std::clamp(left, 0.0, certain * rows / (mark.row - row));
    }
    nearer = other;
  }
  // No mark is apart for certain: what the roll has gone in all, spread evenly over its rows.
  return std::abs(mark.length - marks_.front().length) * rows / (mark.row - marks_.front().row);
}

/// REQUIRES marks in the order of their rows.
double Travel::add(const Mark& mark) {
  const double travelled = since_last(mark);
  so_far_.push_back(so_far_.back() + travelled);
  marks_.push_back(mark);
  return travelled;
}

void Travel::restart() {
  marks_.resize(1);
  so_far_.resize(1);
}

namespace {

// No sensor is better than this: a share of the perimeter, and radians. It keeps variances above what rounding does.
constexpr double kLeastContactShare = 1e-7;
constexpr double kLeastAngle = 1e-7;
// Where nothing is said of the contact, it is no better than this: a row at a corner would tell the start to 1e-7, and
// a grid that fine about each corner of each row takes a gigabyte. Increments add up: they stay exact.
constexpr double kUnstatedContactShare = 1e-5;

double least_contact_share(const Noise& noise, LogKind kind) {
  return noise.contact > 0 || kind == LogKind::increments ? kLeastContactShare : kUnstatedContactShare;
}
// What a row of increments is off on its own: the part of an increment that is under way when it is read.
constexpr double kShareUnderWay = 0.25;

// A finger slips all along by the share that is given, and by this many times as much over a short stretch, such as
// where it starts to turn or where the part is oily; but not by more than all of it.
constexpr double kSlipHereAndThere = 5;
constexpr double kMostSlipHereAndThere = 1;
// Slip is one and the same over this share of the perimeter.
constexpr double kSlipPatch = 0.01;

// Where slip here and there has a variance v the filters' intervals are too narrow by about 1 + 3 v: by nothing that
// can be seen at slip of 0.02, by a fifth at 0.05 (docs/calibration.md). Calibrated: measured by simulation, not
// derived (docs/belief.md, "Slip that is not small").
constexpr double kTooNarrow = 3;

// Slip here and there bends the way on which rows lie that are joined, and their mean is off the straight line that the
// filters take, most over one stretch of it: by this share of what slips over a stretch, and by slip times this angle.
// Calibrated likewise.
constexpr double kBentLength = 0.6;
constexpr double kBentTurn = 0.06;  // radians

// A row that says the same again is worth this much of one: it keeps variances finite.
constexpr double kLeastWorth = 1e-6;

}  // namespace

/// Sensors without error count as off by the least that rounding allows: variances stay above 0.
SensorErrors::SensorErrors(const BeliefOptions& options, LogKind log_kind, double the_perimeter)
    : kind(log_kind),
      bare(options.bare),
      noise(options.noise),
      scale_sd(options.scale_sd),
      contact_variance(
          square(std::max(options.noise.contact, least_contact_share(options.noise, log_kind) * the_perimeter))),
      angle_variance(square(std::max(options.noise.angle, kLeastAngle))),
      row_share(log_kind == LogKind::increments ? kShareUnderWay : 1),
      perimeter(the_perimeter),
      slip_here_and_there(std::min(kSlipHereAndThere * options.noise.slip, kMostSlipHereAndThere)) {}

/// Slip, radius by 1/r, an open scale and the part's own size are independent: their variances add up. No unit.
double SensorErrors::scale_variance(double finger_curvature, bool is_open) const {
  const double open = is_open ? square(scale_sd) : 0;
  return square(noise.slip) + square(noise.radius * finger_curvature) + open + square(noise.part.length);
}

double SensorErrors::for_large_slip() const { return 1 + kTooNarrow * square(slip_here_and_there); }

/// Largest where a node is as long as a patch: a shorter one bends less, in a longer one several bends average out.
RowCovariance SensorErrors::bent(double travelled) const {
  if (gathers_rows() || !(travelled > 0)) return {};
  const double patches = travelled / patch();
  const double most = std::min(patches, 1 / patches) * square(slip_here_and_there);
  return {most * square(kBentLength * patch()), 0, most * square(kBentTurn)};
}

double SensorErrors::patch() const { return kSlipPatch * perimeter; }

/// What slips at one place is independent of what slips a patch further on: |length| / patch patches, each with the
/// variance (slip patch)^2. Length^2.
double SensorErrors::slipped(double length) const { return square(slip_here_and_there) * std::abs(length) * patch(); }

/// The integral of a correlation exp(-|x| / length) is twice that length: over it rows are worth one. At rest they are
/// worth kLeastWorth of their number, and never more than there are.
double SensorErrors::worth(double travelled, double rows) const {
  if (noise.correlation <= 0 || gathers_rows()) return rows;
  return std::clamp(0.5 * travelled / noise.correlation, kLeastWorth * rows, rows);
}

/// A log's first contact is off like any other. With `bare`, and where increments are summed, it is exact. Of
/// increments each row adds its error.
Travel SensorErrors::travel(std::pmr::memory_resource* memory) const {
  const bool is_exact = bare || gathers_rows();
  return {{-1, 0, is_exact ? 0 : contact_variance}, gathers_rows() ? contact_variance : 0, memory};
}

/// A gyroscope's drift and walk, and what a taught part's outline turns wrongly on the way. Radians^2.
double SensorErrors::drifted(double length, const Interval& seconds) const {
  const double gyroscope = bare ? 0 : drift_variance(noise, kind, std::abs(length) / perimeter, seconds);
  return gyroscope + square(noise.part.walk) * std::abs(length);
}

/// Without the bias, which a filter estimates. With neither `drift` nor `walk` all of it wanders.
double SensorErrors::wandered(double length, const Interval& seconds) const {
  if (bare || (noise.drift == 0 && noise.walk == 0)) return drifted(length, seconds);
  return square(noise.walk) * seconds.width() + square(noise.part.walk) * std::abs(length);
}

/// Rows are spread evenly over the boundary that was rolled over; as many as fall on `noise.part.alike` are off alike.
double SensorErrors::rows_alike(double rows, double range) const {
  const double boundary = std::min(range, perimeter);  // what is rolled over again is off as it was
  const bool is_farther = noise.part.alike < boundary;
  return is_farther ? std::max(1.0, rows * noise.part.alike / boundary) : std::max(1.0, rows);
}

/// P0 of x = (offset of length, offset of turn, scale, a gyroscope's scale, its bias, the first centre's x and y,
/// offset of turn at the first contact).
ErrorModel::ErrorModel(const BeliefOptions& options, LogKind kind, double finger_curvature, double perimeter)
    : sensor_(options, kind, perimeter) {
  if (kind == LogKind::contact) {
    // u0 and psi0 are measured once and taken off every row: offsets n0 of length and -(kappa n0 + a0) of turn.
    start_(0, 0) = sensor_.contact_variance;
    start_(0, 1) = start_(1, 0) = -finger_curvature * sensor_.contact_variance;
    start_(1, 1) = square(finger_curvature) * sensor_.contact_variance + sensor_.angle_variance;
    // Length and turn were zeroed at a first contact that was measured like any other. Of increments both offsets start
    // at 0.
  } else if (sensor_.is_gyroscope()) {
    start_(0, 0) = sensor_.contact_variance;
    start_(1, 1) = sensor_.angle_variance;
  }
  start_(1, 1) += sensor_.part_variance();  // the tangent of the start, which every turn is measured from
  start_(2, 2) = sensor_.scale_variance(finger_curvature);
  start_(3, 3) = square(sensor_.noise.gyro);
  start_(4, 4) = sensor_.bare ? 0 : square(sensor_.noise.drift);
  start_(5, 5) = start_(6, 6) = centre_variance();
  start_.row(7).head<2>() = start_.row(1).head<2>();
  start_.col(7).head<2>() = start_.col(1).head<2>();
  start_(7, 7) = start_(1, 1);
}

/// 0 to 1; 0 where lengths are exact.
double ErrorModel::radius_share(double finger_curvature) const {
  const double all = sensor_.scale_variance(finger_curvature);
  return all > 0 ? square(sensor_.noise.radius * finger_curvature) / all : 0;
}

/// R of (length, turn). With u and psi an error of the contact is in both, with opposite signs and by kappa.
RowCovariance ErrorModel::row(double finger_curvature, double alike) const {
  const double contact = sensor_.row_share * sensor_.contact_variance;
  const double angle = sensor_.row_share * sensor_.angle_variance + alike * sensor_.part_variance();
  if (sensor_.kind != LogKind::contact) return {contact, 0, angle};
  return {contact, -finger_curvature * contact, square(finger_curvature) * contact + angle};
}

/// What is added to the offsets' variances from node to node.
Gathered ErrorModel::gathered(double travelled, double rows, const Interval& seconds) const {
  Gathered sum;
  sum.length = sensor_.slipped(travelled);
  if (sensor_.gathers_rows()) {
    sum.length += rows * sensor_.contact_variance;
    sum.turn += rows * sensor_.angle_variance;
  }
  sum.turn += sensor_.wandered(travelled, seconds);
  return sum;
}

PairErrors::PairErrors(const BeliefOptions& options, LogKind kind, const std::array<double, 2>& finger_curvature,
                       bool facing, double perimeter)
    : sensor_(options, kind, perimeter),
      absolute_(facing && kind == LogKind::contact),
      contact_variance_(sensor_.row_share * sensor_.contact_variance),
      turn_variance_(sensor_.row_share * 2 * sensor_.angle_variance) {  // both fingers'
  // The first contact is measured once and taken off every row.
  const bool has_offsets = !sensor_.gathers_rows() && !sensor_.bare;
  for (const std::size_t finger : {0U, 1U}) {
    const auto i = static_cast<Eigen::Index>(finger);
    if (kind == LogKind::contact) normal_turn_[finger] = finger_curvature[finger];
    if (has_offsets) start_(i, i) = contact_variance_;
    start_(2 + i, 2 + i) =
        sensor_.scale_variance(finger_curvature[finger], options.scale_of.value_or(finger) == finger);
  }
  // A scale that is open for both fingers is one and the same: it is their covariance.
  if (!options.scale_of) start_(2, 3) = start_(3, 2) = square(sensor_.scale_sd);  // one factor for both
  // Without the facing all turns are changes since the first row, whose own error they share.
  if (!absolute_) start_(4, 4) = (has_offsets ? turn_variance_ : 0) + part_variance();
}

double PairErrors::contact_sd() const { return std::sqrt(contact_variance_); }

/// Slip here and there, increments, a walk: the offsets differ from row to row.
bool PairErrors::drifts() const { return sensor_.slip_here_and_there > 0 || sensor_.gathers(); }

/// The offsets of both lengths and of the turn gather; scales do not.
PairShared PairErrors::gathered(double rows, const std::array<double, 2>& travelled) const {
  PairShared sum = PairShared::Zero();
  sum[0] = sensor_.slipped(travelled[0]);
  sum[1] = sensor_.slipped(travelled[1]);
  if (sensor_.gathers_rows()) {
    sum[0] += rows * sensor_.contact_variance;
    sum[1] += rows * sensor_.contact_variance;
    sum[4] += rows * 2 * sensor_.angle_variance;
  }
  sum[4] += sensor_.drifted(std::abs(travelled[0]) + std::abs(travelled[1]), {});
  return sum;
}

}  // namespace rollfix::belief
