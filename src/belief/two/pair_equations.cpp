#include "belief/two/pair_filter.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "belief/posterior.hpp"

// Notation, as in docs/two_fingers.md, "The errors":
//   s, t            first contacts, by the tilted turnings `PairStart::w` of finger a [0] and finger b [1]
//   La, Lb, C       a row's lengths and the facing that it measures: `node.length`, `node.turn`
//   x               errors that the roll shares (n_a0, n_b0, eps_a, eps_b, first turn)
//   f               Theta(s + (La + n_a0) / (1 + eps_a)) - Theta(t + (Lb + n_b0) / (1 + eps_b)) - C
//   H, df/dw        `by_errors`, `by_start`
//   q               the centres of the fingers in the part's frame
//   Y               what a felt normal tells of Theta, with mean and variance over the contact's error: Felt
//   c_k, S          pivots: what node k is off by per unit of the one unknown angle, and their sum: `pivots_of`
// Follows docs/two_fingers.md, "The errors", and of centres docs/belief.md, "Centres as evidence".
// Idea: each node is one equation f = 0, or three with centres, linear in x and w about a point. Its variance is that
// of the row on its own. A pivot at a corner, which neighbouring nodes share, enters as a larger error of each.
namespace rollfix::belief {

namespace {

// Centres nearer together than this share of the perimeter have no direction from one to the other.
constexpr double kLeastDistance = 1e-6;
// Of a turn's variance at least this share is not in the distance and the direction of the centres.
constexpr double kLeastOwn = 1e-6;

/// One finger's contact in a row, and how that changes with where it is.
struct ContactThen {
  double s = 0;               // arc length, unwrapped
  double angle = 0;           // of the tangent, as the normal tells it
  double slope = 0;           // of that by the place where it was felt
  double angle_by_start = 0;  // by w
  double s_by_start = 0;      // likewise: ds/dw at the first contact
  double s_by_offset = 0;     // by the shared error of the length
  double s_by_scale = 0;
  double pivot = 0;        // variance of how far the finger has pivoted at a corner ...
  double pivot_alike = 0;  // ... and as much as counts, see pivots_of
};

// With the fingers at q = p(s) - R(Theta + pi/2) arm in the part's frame, |q_b - q_a| is the distance of their centres,
// and the direction of q_b - q_a less the middle of both normals is what it is in the world.
void add_centres(const PairModel& model, const std::array<ContactThen, 2>& at, const PairNode& node,
                 PairEquations<3>& rows) {
  const PairErrors& errors = *model.errors;
  const PairCentres& felt = *node.centres;
  std::array<Vec2, 2> q;
  std::array<Vec2, 2> q_by_s;
  std::array<Vec2, 2> q_by_own;  // where the contact was felt elsewhere than it is
  std::array<Vec2, 2> q_by_start;
  std::array<Vec2, 2> across;  // the arm, a quarter turn on
  for (const std::size_t finger : {0U, 1U}) {
    const ContactThen& contact = at[finger];
    const Vec2 tangent(std::cos(contact.angle), std::sin(contact.angle));
    // The inward normal. An arm has its first coordinate along it, its second against the tangent.
    const Vec2 normal(-tangent.y(), tangent.x());
    const auto in_part = [&](const Vec2& arm) { return Vec2(arm.x() * normal - arm.y() * tangent); };
    const Vec2 arm = in_part(felt.arm[finger].at);
    across[finger] = {-arm.y(), arm.x()};
    q[finger] = model.path->at(contact.s) - arm;
    q_by_s[finger] = tangent - contact.slope * across[finger];
    q_by_own[finger] = q_by_s[finger] + in_part(felt.arm[finger].per_length);
    q_by_start[finger] = contact.s_by_start * tangent - contact.angle_by_start * across[finger];
  }
  // From a to b. Centres that nearly coincide have no direction: `distance` is bounded from below.
  const Vec2 way = q[1] - q[0];
  const double distance = std::max(way.norm(), kLeastDistance * errors.perimeter());
  const Vec2 along = way / distance;
  const Vec2 turning(-along.y() / distance, along.x() / distance);
  // f_1: the distance. f_2: the direction less the middle of both normals, each Theta + pi/2, up to half turns.
  rows.f[1] = way.norm() - felt.distance;
  const double direction = std::atan2(way.y(), way.x()) - kHalfTurn / 2 - 0.5 * (at[0].angle + at[1].angle);
  const double off = direction - felt.direction;
  rows.f[2] = off - kHalfTurn * std::floor(off / kHalfTurn + 0.5);
  // Errors of both centres along the chord, and across it over its length; of the normals' mean half of one's.
  const double position = 2 * errors.centre_variance() / std::max(1.0, node.rows);
  rows.variance(1, 1) += position;
  rows.variance(2, 2) += position / (distance * distance) + 0.5 * errors.angle_variance() / std::max(1e-6, node.rows);
  Eigen::Matrix<double, 3, 2> by_own;
  Eigen::Matrix<double, 3, 2> by_pivot;  // of a finger at a corner, whose centre goes around it
  for (const std::size_t finger : {0U, 1U}) {
    const auto i = static_cast<Eigen::Index>(finger);
    const double sign = finger == 0 ? -1 : 1;
    const ContactThen& contact = at[finger];
    const double felt_slope = contact.slope + errors.normal_turn(finger);
    // By the row's own error n of this contact: of f_0, f_1 and f_2. The felt normal turns by Y' + 1/r.
    by_own.col(i) << -sign * felt_slope, sign * along.dot(q_by_own[finger]),
        sign * turning.dot(q_by_own[finger]) - 0.5 * felt_slope;
    by_pivot.col(i) << -sign, -sign * along.dot(across[finger]), -sign * turning.dot(across[finger]) - 0.5;
    rows.by_start(1, i) = sign * along.dot(q_by_start[finger]);
    rows.by_start(2, i) = sign * turning.dot(q_by_start[finger]) - 0.5 * contact.angle_by_start;
    // By where the contact is: of f_1 and f_2. Errors that the roll shares act through it.
    const Eigen::Vector2d by_s(sign * along.dot(q_by_s[finger]),
                               sign * turning.dot(q_by_s[finger]) - 0.5 * contact.slope);
    rows.by_errors.col(i).tail<2>() = by_s * contact.s_by_offset;
    rows.by_errors.col(2 + i).tail<2>() = by_s * contact.s_by_scale;
    // The first contacts' own error is the one that the roll shares, the other way round.
    if (node.is_facing) rows.by_errors.col(i).tail<2>() -= by_own.col(i).tail<2>() - by_s;
  }
  if (node.is_facing) return;
  // The row's own error of both places is in all three.
  const double own = errors.contact_variance() / std::max(1e-6, node.rows);
  rows.variance.bottomRightCorner<2, 2>() += own * by_own.bottomRows<2>() * by_own.bottomRows<2>().transpose();
  for (const Eigen::Index row : {1, 2}) {
    const double both = own * by_own.row(0).dot(by_own.row(row));
    rows.variance(0, row) = rows.variance(row, 0) = both;
  }
  // What a normal tells of a place is a table's, whose variance the turn has: it is no less than what goes together.
  const double together = own * by_own.row(0).squaredNorm() + at[0].pivot_alike + at[1].pivot_alike;
  rows.variance(0, 0) = std::max(rows.variance(0, 0), (1 + kLeastOwn) * together);
  // So is how far fingers have pivoted, which the turn has already.
  for (const std::size_t finger : {0U, 1U}) {
    const ContactThen& contact = at[finger];
    if (!(contact.pivot > 0)) continue;
    const auto i = static_cast<Eigen::Index>(finger);
    Eigen::Matrix3d pivots = by_pivot.col(i) * by_pivot.col(i).transpose();
    pivots(0, 0) = 0;
    // A wide arc is no straight line: what is second order in the pivot counts as one more error.
    const double bend = contact.pivot * across[finger].squaredNorm();
    pivots(1, 1) += bend;
    pivots(2, 2) += bend / (distance * distance);
    rows.variance += contact.pivot_alike * pivots;
    rows.pivots += contact.pivot_alike * pivots;
  }
}

/// Variance of how far a finger has pivoted that may be at a corner. Where one is as near as the finger may have
/// slipped, it may have pivoted already, or not yet.
double pivot_at(const PairModel& model, std::size_t finger, double s) {
  const double felt = model.felt[finger]->at(s).pivot;
  return model.slipping[finger] != nullptr ? std::max(felt, model.slipping[finger]->at(s).pivot) : felt;
}

/// What a felt normal tells where slip has left the place open by this variance: the line of least squares through
/// three points, and as a variance what it misses, as TiltedArc::about of one finger. On a flat side the tangent says
/// nothing of a rounding that the contact may have slipped to.
Felt felt_over(const FeltTurning& table, double s, double open) {
  Felt felt = table.at(s);
  const double reach = kSigmaPoint * std::sqrt(std::max(0.0, open));
  if (!(reach > 0)) return felt;
  const Felt below = table.at(s - reach);
  const Felt above = table.at(s + reach);
  const SigmaLine line = SigmaLine::through(below.angle, felt.angle, above.angle, reach);
  const double own =
      (below.variance - below.pivot + 4 * (felt.variance - felt.pivot) + above.variance - above.pivot) / 6;
  felt.angle = line.mean;
  felt.slope = line.slope;
  felt.variance = own + line.variance + felt.pivot;
  return felt;
}

}  // namespace

/// Theta = w - c s and dTheta/dw = 1 - c m at both first contacts; in a corner 1.
StartPlaces places_of(const PairModel& model, const PairStart& start) {
  StartPlaces places;
  for (const std::size_t finger : {0U, 1U}) {
    const double tilt = model.boundary[finger]->tilt();
    places.place[finger] = start.arc[finger]->at(start.w[finger]);
    places.angle[finger] = start.w[finger] - tilt * places.place[finger].s;
    places.by_start[finger] = 1 - tilt * places.place[finger].slope;
  }
  return places;
}

/// f = Theta(s) - Theta(t) - C. The first contacts are s and t themselves: n_a0 and n_b0 enter by the felt normals
/// and, with centres, by the arms.
template <int N>
PairEquations<N> facing_equations(const PairModel& model, const StartPlaces& at, const PairNode& node,
                                  const PairShared& x) {
  const PairErrors& errors = *model.errors;
  PairEquations<N> rows;
  rows.by_errors(0, 0) = -errors.normal_turn(0);
  rows.by_errors(0, 1) = errors.normal_turn(1);
  rows.f[0] = nearest_to_zero(at.angle[0] - at.angle[1] - node.turn + rows.by_errors.row(0).dot(x));
  rows.by_start.row(0) << at.by_start[0], -at.by_start[1];
  rows.variance(0, 0) = errors.facing_variance();
  if constexpr (N == 3) {
    std::array<ContactThen, 2> contacts;
    for (const std::size_t finger : {0U, 1U}) {
      const double slope = model.felt[finger]->at(at.place[finger].s).slope;
      // The first contact was felt where it is but for its own error: the place stays, the normal and the arm tell of
      // it.
      contacts[finger] = {
          at.place[finger].s, at.angle[finger], slope, at.by_start[finger], at.place[finger].slope, 0, 0, 0, 0};
    }
    add_centres(model, contacts, node, rows);
    for (const Eigen::Index k : {1, 2}) rows.f[k] += rows.by_errors.row(k).dot(x);
  }
  return rows;
}

/// f_k of docs/two_fingers.md with Theta replaced by what the felt normals tell, E Y. With the facing f is 0 up to
/// whole turns; without it f is the change since the first contacts: eqs. (8) and (9).
template <int N>
PairEquations<N> row_equations(const PairModel& model, const StartPlaces& at, const PairNode& node, const PairShared& x,
                               const PairSharedCovariance* open, const Alike& alike) {
  const PairErrors& errors = *model.errors;
  PairEquations<N> rows;
  std::array<ContactThen, 2> contacts;
  double& f = rows.f[0];
  double variance = errors.turn_variance() + node.alike * errors.part_variance();
  double pivots_alike = 0;
  f = -node.turn;
  for (const std::size_t finger : {0U, 1U}) {
    const auto i = static_cast<Eigen::Index>(finger);
    const double sign = finger == 0 ? 1 : -1;
    // The true length, by the shared errors, and where that leads.
    const double per_scale = 1 / (1 + x[2 + i]);
    const double length = (node.length[finger] + x[i]) * per_scale;
    const double s = at.place[finger].s + length;
    // Of the place, by offset and scale: (1, -L) P (1, -L)^T, over (1 + eps)^2.
    const double open_place = open == nullptr ? 0
                                              : square(per_scale) * ((*open)(i, i) - 2 * length * (*open)(i, 2 + i) +
                                                                     square(length) * (*open)(2 + i, 2 + i));
    const Felt felt = felt_over(*model.felt[finger], s, open_place);
    contacts[finger] = {s,
                        felt.angle,
                        felt.slope,
                        felt.slope * at.place[finger].slope,
                        at.place[finger].slope,
                        per_scale,
                        -per_scale * length,
                        0,
                        0};
    f += sign * felt.angle;  // f_k of docs/two_fingers.md; its differences are eqs. (8), (9)
    // d/dn_0 = Y' / (1 + eps), d/deps = -Y' L / (1 + eps), d/dw = Y' ds/dw, L being the true length.
    rows.by_errors(0, i) = sign * felt.slope * per_scale;
    rows.by_errors(0, 2 + i) = -rows.by_errors(0, i) * length;
    rows.by_start(0, i) = sign * felt.slope * at.place[finger].slope;
    // In a run of nodes at one corner a finger that slips counts as pivoting wherever it may have slipped to the
    // corner.
    const double pivot = alike[finger] > 1 ? pivot_at(model, finger, s) : felt.pivot;
    contacts[finger].pivot = pivot;
    contacts[finger].pivot_alike = alike[finger] * pivot;
    // What is a row's own is averaged over the node's rows; the pivot is not, and counts for all nodes of the run.
    variance += felt.variance - felt.pivot;
    pivots_alike += alike[finger] * pivot;
    // Past an open outline's end: no boundary is there, which costs as much as it is off.
    if (!model.places.closed) {
      const double end = s < 0.5 * errors.perimeter() ? -1 : 1;
      const double past = end < 0 ? -s : s - errors.perimeter();
      if (past > 0) {
        rows.past[i] = past / errors.contact_sd();
        rows.past_by_start[i] = end * at.place[finger].slope / errors.contact_sd();
      }
    }
  }
  if (errors.absolute()) {
    f = nearest_to_zero(f);
  } else {
    // The change since the first contacts, whose own errors are in it as well.
    rows.by_errors(0, 0) -= errors.normal_turn(0);
    rows.by_errors(0, 1) += errors.normal_turn(1);
    rows.by_errors(0, 4) = 1;
    f += -at.angle[0] + at.angle[1] + x[4] - errors.normal_turn(0) * x[0] + errors.normal_turn(1) * x[1];
    rows.by_start(0, 0) -= at.by_start[0];
    rows.by_start(0, 1) += at.by_start[1];
  }
  rows.variance(0, 0) = variance / node.rows + pivots_alike;
  rows.pivots(0, 0) = pivots_alike;
  if constexpr (N == 3) add_centres(model, contacts, node, rows);
  return rows;
}

std::vector<Alike> pivots_of(const PairModel& model, const StartPlaces& at, const std::vector<PairNode>& nodes,
                             const PairShared& x) {
  // Nodes away from corners share nothing: 1.
  std::vector<Alike> alike(nodes.size(), Alike{1, 1});
  std::vector<double> off(nodes.size());
  for (const std::size_t finger : {0U, 1U}) {
    const FeltTurning& felt = model.slipping[finger] != nullptr ? *model.slipping[finger] : *model.felt[finger];
    if (!felt.has_corners()) continue;
    const auto i = static_cast<Eigen::Index>(finger);
    std::size_t begin = 0;
    double sum = 0;
    std::optional<double> corner;
    // A run of nodes at one corner is over: each gets S / c_k, c_k being `off`, S their `sum`.
    const auto end_run = [&](std::size_t end) {
      for (std::size_t k = begin; corner && k < end; ++k) {
        if (off[k] > 0) alike[k][finger] = sum / off[k];
      }
      begin = end;
      sum = 0;
    };
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const double length = (nodes[k].length[finger] + x[i]) / (1 + x[2 + i]);
      const double s = at.place[finger].s + length;
      const std::optional<double> here = felt.corner_at(s);
      // The same corner on the same lap as in the node before.
      const bool goes_on = here && corner && std::abs(*here - *corner) < 0.5 * model.errors->contact_sd();
      if (!goes_on) end_run(k);
      corner = here;
      if (here) sum += off[k] = std::sqrt(pivot_at(model, finger, s));
    }
    end_run(nodes.size());
  }
  return alike;
}

template PairEquations<1> facing_equations(const PairModel&, const StartPlaces&, const PairNode&, const PairShared&);
template PairEquations<3> facing_equations(const PairModel&, const StartPlaces&, const PairNode&, const PairShared&);
template PairEquations<1> row_equations(const PairModel&, const StartPlaces&, const PairNode&, const PairShared&,
                                        const PairSharedCovariance*, const Alike&);
template PairEquations<3> row_equations(const PairModel&, const StartPlaces&, const PairNode&, const PairShared&,
                                        const PairSharedCovariance*, const Alike&);

}  // namespace rollfix::belief
