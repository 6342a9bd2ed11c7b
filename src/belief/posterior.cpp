#include "belief/posterior.hpp"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "outline/turn.hpp"

// What the posteriors of one finger and of two have in common: the trend of what rows are off, and the part's pose.
// Notation:
//   e_i             innovations of one equation, in standard deviations, i = 0, ..., n - 1: `each`
//   c_k             sqrt(2 / n) sum of e_i cos(pi k (i + 1/2) / n), for k = 0 by sqrt(1 / n): `component`
//   m               `kComponents`, of few innovations a quarter as many: `most`
//   slow            c_0^2 + ... + c_(m-1)^2, over what all innovations are larger by: a chi-square of m degrees
//   s, T            a contact's place on the part and the tangent's angle there: MassPiece, with its share of a mode
//   q, beta         where a contact was felt in the world, and u + psi: MeasuredContact
//   (X, phi)        the part's pose: beta = phi + T + pi / 2, and q = X + R(phi) p(s); of two fingers the middle of
//                   both
//   chord           from one contact to the other: its direction tells phi as well
//   slid            how far a contact was felt along the finger from where it is
//   J               derivatives of the pose by what the sensors may be off: `PoseSlopes`
// Follows docs/belief.md, "When the rows fit badly": J. Neyman, "Smooth test for goodness of fit" (1937), with the
// orthonormal cosine transform (DCT-II); and docs/rolling.md, "Where the part is".
// Idea: white innovations have slow components as large as any other. A gyroscope's drift, an eccentric finger or a
// part that turns a little are in the slow ones alone. Of poses: mean and covariance of those of all pieces, and beside
// them J C J^T of the sensors' own errors C.
namespace rollfix::belief {

namespace {

// So many components, the mean among them: what drifts, and what goes to and fro up to five times during the roll. More
// would hide the slowest.
constexpr double kComponents = 10;
// ... of fewer innovations fewer, so that the others tell how large innovations are.
constexpr double kInnovationsEach = 4;
constexpr double kFewestComponents = 2;

/// The orthonormal cosine transform (DCT-II), one number of it.
double component(const std::pmr::vector<double>& values, std::size_t k) {
  const auto count = static_cast<double>(values.size());
  const double step = std::numbers::pi * static_cast<double>(k) / count;
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += values[i] * std::cos(step * (static_cast<double>(i) + 0.5));
  return std::sqrt((k == 0 ? 1 : 2) / count) * sum;
}

}  // namespace

/// 1 less its distribution function: Q(n / 2, chi^2 / 2), the regularised upper incomplete gamma function.
double p_of_chi_square(double chi_square, double freedom) {
  return boost::math::gamma_q(0.5 * freedom, 0.5 * chi_square);
}

/// Neyman's test over all equations together; their slow components add up to one chi-square. `freedom`: see the
/// header.
Trend trend_of(const Innovations& innovations, double freedom) {
  const auto equations = static_cast<double>(
      std::count_if(innovations.begin(), innovations.end(), [](const auto& each) { return !each.empty(); }));
  double slow = 0;
  double components = 0;
  double differences = 0;
  double neighbours = 0;
  for (const std::pmr::vector<double>& each : innovations) {
    if (each.empty()) continue;
    const auto count = static_cast<double>(each.size());
    // For `jitter`: half the mean squared difference of neighbours is the variance of independent ones.
    for (std::size_t i = 1; i < each.size(); ++i) differences += square(each[i] - each[i - 1]);
    neighbours += count - 1;
    // Equations share the freedom evenly.
    const double independent = std::min(count, freedom / equations);
    const double most = std::floor(std::min(kComponents, independent / kInnovationsEach));
    // Too few innovations: this equation says nothing of a trend.
    if (most < kFewestComponents) continue;
    double of_slow = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(most); ++k) of_slow += square(component(each, k));
    double squares = 0;
    for (const double innovation : each) squares += square(innovation);
    // Where all innovations are larger than stated, the chi-square says so: the trend is what the slow ones are beyond
    // that. Innovations smaller than stated count as they are: the answer is then wider than necessary, not too sure.
    const double larger = std::max(1.0, (squares - of_slow) / (count - most));
    slow += of_slow / larger;
    components += most;
  }
  Trend trend;
  trend.count = equations > 0 ? neighbours / equations : 0;
  if (neighbours > 0) trend.jitter = 0.5 * differences / neighbours;
  if (components == 0) return trend;
  trend.sigmas = normal_deviate(slow, components);
  trend.widened = std::max(1.0, std::sqrt(slow / components));
  return trend;
}

namespace {

// Steps that derivatives are taken by: a share of the perimeter, and radians.
constexpr double kSlidStep = 1e-6;
constexpr double kAngleStep = 1e-6;

/// The pose with which u + psi = heading + tangent + pi/2 at each finger's contact, and with which the contacts are at
/// the same places in both frames: of two fingers the middle of what they say.
/// `chord`: of two fingers, how much the direction from one contact to the other counts for the heading, the normals
/// counting for the rest.
Pose pose_with(const Part& part, const MassPiece& piece, const PerFinger<MeasuredContact>& felt, double chord) {
  const auto heading_by = [&](std::size_t finger) {
    return felt[finger].normal - 0.5 * std::numbers::pi - piece.tangent[finger];
  };
  Pose pose{0, 0, heading_by(0)};
  // Angles are averaged by their difference: half of it, the shorter way.
  if (felt.size() == 2) pose.heading += 0.5 * nearest_angle(heading_by(1) - heading_by(0));
  if (chord > 0) {
    const Vec2 on_part = part.point(piece.s[1]) - part.point(piece.s[0]);
    pose.heading += chord * nearest_angle(angle_between(on_part, felt[1].where - felt[0].where) - pose.heading);
  }
  // X = q - R(phi) p(s), the mean over the fingers.
  const double share = 1 / static_cast<double>(felt.size());
  for (std::size_t finger = 0; finger < felt.size(); ++finger) {
    const Vec2 origin = felt[finger].where - pose.turned(part.point(piece.s[finger]));
    pose.x += share * origin.x();
    pose.y += share * origin.y();
  }
  return pose;
}

/// A contact that is felt this far along the finger from where it is, counter-clockwise, with the finger's orientation
/// off by this angle.
MeasuredContact moved(const MeasuredContact& contact, double along, double angle) {
  MeasuredContact off = contact;
  const double turn = along * contact.finger_curvature + angle;
  off.normal += turn;
  const Vec2 tangent(-std::sin(contact.normal), std::cos(contact.normal));
  // A finger that is turned by `angle` about its centre carries its contact along by r times that; of a jaw this is
  // left out.
  const double radius = contact.finger_curvature > 0 ? 1 / contact.finger_curvature : 0;
  off.where += (along + radius * angle) * tangent;
  return off;
}

/// Where the contacts were, as far as all the samples tell.
PerFinger<MeasuredContact> told(const PerFinger<MeasuredContact>& felt, const MassPiece& piece) {
  PerFinger<MeasuredContact> contacts = felt;
  if (felt.size() == 1) return contacts;
  for (std::size_t finger = 0; finger < felt.size(); ++finger) {
    contacts[finger] = moved(felt[finger], piece.slid[finger], 0);
  }
  return contacts;
}

/// (x, y, heading) of a pose less a reference's, the heading the shorter way.
Eigen::Vector3d off(const Pose& pose, const Pose& reference) {
  return {pose.x - reference.x, pose.y - reference.y, nearest_angle(pose.heading - reference.heading)};
}

/// What the sensors' own errors add at one finger's first contact. The contact's moves it along the tangent and turns
/// the normal, the orientation's turns it about the contact.
Eigen::Matrix3d sensors_of_one(const MeasuredContact& felt, const Pose& mean, const Noise& noise) {
  const Vec2 arm = felt.where - Vec2(mean.x, mean.y);  // from the contact to the origin, turned back
  // The pose by a turn about the contact: the origin moves across the arm.
  const Eigen::Vector3d by_turn(arm.y(), -arm.x(), 1);
  const Eigen::Vector3d along(-std::sin(felt.normal), std::cos(felt.normal), 0);  // counter-clockwise
  const Eigen::Vector3d by_contact = along + felt.finger_curvature * by_turn;
  Eigen::Vector3d by_angle = by_turn;
  if (felt.finger_curvature > 0) by_angle += along / felt.finger_curvature;
  return noise.contact * noise.contact * by_contact * by_contact.transpose() +
         noise.angle * noise.angle * by_angle * by_angle.transpose();
}

/// The spread over poses that each have their own: the mean covariance, and the covariance of the means.
PoseSpread spread_over(const std::vector<MassPiece>& pieces) {
  const Pose reference = pieces.front().pose->mean;
  double total = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const MassPiece& piece : pieces) {
    const Eigen::Vector3d by = off(piece.pose->mean, reference);
    total += piece.share;
    sum += piece.share * by;
    squares += piece.share * (by * by.transpose() + piece.pose->covariance);
  }
  const Eigen::Vector3d mean = sum / total;
  return {{reference.x + mean.x(), reference.y + mean.y(), nearest_angle(reference.heading + mean.z())},
          squares / total - mean * mean.transpose()};
}

/// How the pose changes with what each of two fingers slid at first, and with the error of its orientation.
struct PoseSlopes {
  Eigen::Matrix<double, 3, 2> by_slid = Eigen::Matrix<double, 3, 2>::Zero();
  Eigen::Matrix<double, 3, 2> by_angle = Eigen::Matrix<double, 3, 2>::Zero();
  Eigen::Matrix<double, 3, 4> by_position = Eigen::Matrix<double, 3, 4>::Zero();  // of the centres
};

/// As the centres are known, the direction from one contact to the other tells the heading, and so do the normals: each
/// counts as much as it is sure.
double chord_share(const PerFinger<MeasuredContact>& felt, const Noise& noise) {
  if (felt.size() == 1 || !(noise.position > 0)) return 0;
  const double by_normals = 0.5 * noise.angle * noise.angle;
  double across = 2 * noise.position * noise.position;
  for (const MeasuredContact& contact : felt) {
    const double radius = contact.finger_curvature > 0 ? 1 / contact.finger_curvature : 0;
    across += square(radius * noise.angle);
  }
  // Errors across the chord turn it by 1 / its length. Weights are as 1 / variance.
  const double by_chord = across / std::max((felt[1].where - felt[0].where).squaredNorm(), 1e-300);
  return by_normals / std::max(by_normals + by_chord, 1e-300);
}

/// By differences: one number at a time is off by a small step.
PoseSlopes slopes_of_two(const Part& part, const MassPiece& at, const PerFinger<MeasuredContact>& felt, double chord) {
  const double step = kSlidStep * part.perimeter();
  const Pose reference = pose_with(part, at, told(felt, at), chord);
  PoseSlopes slopes;
  for (std::size_t finger = 0; finger < felt.size(); ++finger) {
    const auto column = static_cast<Eigen::Index>(finger);
    PerFinger<MeasuredContact> contacts = told(felt, at);
    contacts[finger] = moved(felt[finger], at.slid[finger] + step, 0);
    slopes.by_slid.col(column) = off(pose_with(part, at, contacts, chord), reference) / step;
    contacts[finger] = moved(felt[finger], at.slid[finger], kAngleStep);
    slopes.by_angle.col(column) = off(pose_with(part, at, contacts, chord), reference) / kAngleStep;
    for (const Eigen::Index axis : {0, 1}) {
      contacts = told(felt, at);
      contacts[finger].where[axis] += step;
      slopes.by_position.col(2 * column + axis) = off(pose_with(part, at, contacts, chord), reference) / step;
    }
  }
  return slopes;
}

}  // namespace

PoseSpread pose_spread_of(const Part& part, const std::vector<MassPiece>& pieces,
                          const PerFinger<MeasuredContact>& felt, const Noise& noise) {
  if (pieces.empty()) return {};
  // The rows themselves tell the pose: of one finger, in a log with centres.
  if (pieces.front().pose) return spread_over(pieces);
  const bool is_one = felt.size() == 1;
  const double chord = chord_share(felt, noise);
  const Pose reference = pose_with(part, pieces.front(), told(felt, pieces.front()), chord);
  const PoseSlopes slopes = is_one ? PoseSlopes{} : slopes_of_two(part, pieces.front(), felt, chord);
  double total = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  // Mean and covariance about the first piece's pose. Each piece adds what the first contacts' slide leaves open.
  for (const MassPiece& piece : pieces) {
    const Eigen::Vector3d by = off(pose_with(part, piece, told(felt, piece), chord), reference);
    total += piece.share;
    sum += piece.share * by;
    squares +=
        piece.share * (by * by.transpose() + slopes.by_slid * piece.slid_covariance * slopes.by_slid.transpose());
  }
  const Eigen::Vector3d mean = total > 0 ? Eigen::Vector3d(sum / total) : Eigen::Vector3d::Zero();
  PoseSpread spread;
  spread.mean = {reference.x + mean.x(), reference.y + mean.y(), nearest_angle(reference.heading) + mean.z()};
  if (total > 0) spread.covariance = squares / total - mean * mean.transpose();
  if (is_one) {
    spread.covariance += sensors_of_one(felt[0], spread.mean, noise);
  } else {
    spread.covariance += square(noise.angle) * slopes.by_angle * slopes.by_angle.transpose() +
                         square(noise.position) * slopes.by_position * slopes.by_position.transpose();
  }
  return spread;
}

}  // namespace rollfix::belief
