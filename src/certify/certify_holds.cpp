#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "hold/box_search.hpp"
#include "hold/held_rows.hpp"
#include "hold/hold_fit.hpp"
#include "hold/steps.hpp"
#include "log/mirrored.hpp"
#include "outline/turn.hpp"
#include "places.hpp"
#include "rollfix/certify.hpp"
#include "rollfix/error.hpp"
#include "work/pulse.hpp"

// Notation, as in docs/rig.md:
//   X, phi          the part at an instant; C: a pin in the world, x: on the part
//   t, psi          where the wheel touches, and the tangent there, at a corner a pivot
//   be - phi - psi - t / r   an encoder's zero, as one instant has it
// Follows docs/certificates.md, "Holds".
// Idea: the certificate is the question, and the sets of first contacts with how the part lies there; the verifier
// searches by itself. With noise it is the same question within 4.5 standard deviations: so what the answer leaves out
// as improbable is found as well.
namespace rollfix::certifying {
namespace {

using hold::HeldContact;
using hold::HeldErrors;
using hold::HeldRow;
using hold::HeldRows;
using hold::HeldState;
using hold::HeldWheel;

constexpr double kFits = 1 + 1e-10;  // shares of tolerances, rounded
constexpr double kAtCorner = 1e-12;  // of the perimeter

/// value less whole periods, nearest to 0.
double in_period(double value, double period) {
  return period > 0 ? value - period * std::round(value / period) : value;
}

/// Describes one set of first contacts that fit: where each contact is on the part, the pose at each instant, and how
/// far each measurement is from it, as a share of its tolerance. Used once.
class Lies {
 public:
  Lies(const Part& part, const hold::HoldFit& fit, const hold::WheelPaths& paths, const HeldState& state)
      : part_(part), fit_(fit), rows_(fit.rows()), paths_(paths), state_(state) {}

  /// Nothing if some share exceeds 1: the fit is good to rounding, and the verifier would refuse it.
  std::optional<CertifiedHoldSet> described() {
    CertifiedHoldSet set;
    const Boundary boundary = part_.boundary();
    for (std::size_t k = 0; k < fit_.fingers(); ++k) {
      // The fit's unknowns are the first contacts, in the order of the fingers.
      set.first.push_back(boundary.canonical(state_.unknowns(static_cast<Eigen::Index>(k))));
      set.at.push_back(place_of(part_, set.first.back()));
    }
    first_ = set.first.front();
    set.zeros.assign(paths_.size(), 0);
    spun_.assign(paths_.size(), {});
    for (std::size_t row = 0; row < rows_.rows.size(); ++row) set.lies.push_back(lie_at(row));
    // An encoder's zero needs all instants: it is added last.
    for (std::size_t wheel = 0; wheel < paths_.size(); ++wheel) add_zero(wheel, set);
    if (!fits_) return std::nullopt;
    return set;
  }

 private:
  /// `share` of a tolerance; beyond 1 the set does not fit.
  void require(double share) { fits_ = fits_ && std::abs(share) <= kFits; }

  /// The pose of one instant, the residuals of each finger's contact, and where each wheel touches.
  CertifiedLie lie_at(std::size_t row) {
    CertifiedLie lie;
    lie.pose = fit_.pose_at(state_, row).pose;
    for (std::size_t k = 0; k < fit_.fingers(); ++k) {
      const HeldContact& contact = rows_.rows[row].contacts[k];
      const HeldErrors& errors = rows_.errors[k];
      // |q - X - R(phi) p(s)| as a share of `place`; 0 where no place was measured.
      const double place = errors.has_place ? fit_.residual(state_, row, k).place.norm() / errors.place : 0;
      const hold::BlurredPlace about = hold::ranged(part_, fit_.place_of(state_, row, k), errors.travel);
      // tau - phi may be anything that Theta is within `travel` of the contact, and `angle` more.
      const double turn =
          nearest_angle(contact.tangent - lie.pose.heading - about.angle) / (about.half_turn + errors.angle);
      lie.off.push_back({place, turn});
      require(place);
      require(turn);
    }
    for (std::size_t k = 0; k < paths_.size(); ++k) lie.wheels.push_back(wheel_at(row, k, lie.pose));
    return lie;
  }

  /// Where a wheel touches at an instant: the place of its path that is nearest to the pin, with the shares of pin, of
  /// the line (if squeezed), and of its encoder's zero, which `add_zero` fills in.
  CertifiedLie::Wheel wheel_at(std::size_t row, std::size_t number, const Pose& pose) {
    const HeldWheel& wheel = rows_.wheels[number];
    const hold::HeldPin& pin = rows_.rows[row].pins[number];
    // The pin in the part's frame.
    const Vec2 seen = Pose{0, 0, -pose.heading}.turned(pin.at - Vec2(pose.x, pose.y));
    // The wheel touches where its path comes nearest to the pin.
    const hold::NearPin near = paths_[number]->nearest(seen);
    const Boundary boundary = part_.boundary();
    // On the first lap; of an open outline rounding must not leave it.
    const double s = boundary.closed ? boundary.canonical(near.s) : std::clamp(near.s, 0.0, boundary.perimeter);
    const double psi = tangent_at(s, near.angle);
    CertifiedLie::Wheel touching{place_of(part_, s), nearest_angle(psi), {}};
    // p(t) + r n(psi): where the pin is if the wheel touches at t with the tangent psi.
    const Vec2 path = part_.point(s) + wheel.wheel_radius * Vec2(std::sin(psi), -std::cos(psi));
    // Of the pin.
    touching.off[0] = (seen - path).norm() / wheel.place;
    // The jaw and the wheel squeeze the part: the direction from its first contact to the pin is phi + psi - pi / 2.
    if (wheel.line) {
      const Vec2 way = pin.at - rows_.rows[row].contacts[0].at;
      // Of the line, in its tolerance.
      touching.off[1] =
          nearest_angle(std::atan2(way.y(), way.x()) - pose.heading - psi + 0.5 * std::numbers::pi) / *wheel.line;
    }
    // beta - phi - psi - t / r, with phi counted on over whole turns, for an encoder counts them.
    if (wheel.spin) spun_[number].push_back(pin.spin - counted_heading(row, pose) - psi - s / wheel.wheel_radius);
    require(touching.off[0]);
    require(touching.off[1]);
    return touching;
  }

  /// The boundary's own tangent, or where the wheel may pivot the one that it has.
  double tangent_at(double s, double pivoted) const {
    const double own = part_.turning().angle(s);
    // The search's place of a corner is known to rounding.
    const bool is_corner = std::any_of(part_.corners().begin(), part_.corners().end(), [&](const Corner& corner) {
      return part_.distance(corner.s, s) <= kAtCorner * part_.perimeter();
    });
    return is_corner ? own + nearest_angle(pivoted - own) : own;
  }

  /// The first finger's tangents say how often the part went round.
  double counted_heading(std::size_t row, const Pose& pose) const {
    const double s = first_ + rows_.rows[row].contacts[0].travelled;
    const Boundary boundary = part_.boundary();
    const double angle = part_.turning().angle(boundary.closed ? s : std::clamp(s, 0.0, boundary.perimeter));
    // Roughly the heading, unwrapped: the measured tangent less Theta at the contact. It tells the whole turns of
    // the pose's heading.
    const double about = rows_.rows[row].contacts[0].tangent - angle;
    return about + nearest_angle(pose.heading - about);
  }

  /// The zero in the middle of the values that all instants give, and each instant's share of `spin`.
  void add_zero(std::size_t number, CertifiedHoldSet& set) {
    const std::vector<double>& spun = spun_[number];
    if (spun.empty()) return;
    const double period = paths_[number]->spin_period();
    // Values are compared within a period of the first one: the encoder does not tell laps around the part apart.
    double least = 0, most = 0;
    for (const double one : spun) {
      least = std::min(least, in_period(one - spun.front(), period));
      most = std::max(most, in_period(one - spun.front(), period));
    }
    set.zeros[number] = spun.front() + 0.5 * (least + most);
    for (std::size_t row = 0; row < spun.size(); ++row) {
      double& off = set.lies[row].wheels[number].off[2];
      off = in_period(spun[row] - set.zeros[number], period) / *rows_.wheels[number].spin;
      require(off);
    }
  }

  const Part& part_;
  const hold::HoldFit& fit_;
  const HeldRows& rows_;
  const hold::WheelPaths& paths_;
  const HeldState& state_;
  double first_ = 0;                       // of the first finger
  std::vector<std::vector<double>> spun_;  // of each wheel, at each instant
  bool fits_ = true;
};

/// First contacts that fit, and how the part lies at each instant, with its residuals. Nothing where they do not quite
/// fit once they are written down.
std::optional<CertifiedHoldSet> lies_of(const Part& part, const hold::HoldFit& fit, const hold::WheelPaths& paths,
                                        const HeldState& state) {
  return Lies(part, fit, paths, state).described();
}

/// How much wider extents are written down than they are, in shares of the tolerances: where first contacts are at
/// their very edge no box is on one side of it.
constexpr double kWiderSet = 0.1;

/// Of the chord from a contact to a pin, each off by so much: by how much its direction may be off.
double swing(double off, double length) { return off >= length ? std::numbers::pi : std::asin(off / length); }

/// Tolerances of one finger: 4.5 standard deviations, the most of all rows.
HeldErrors slacks_of(const HeldRows& rows, std::size_t finger) {
  // Each kind of error has its largest row on its own.
  HeldErrors widest;
  widest.has_place = rows.errors[finger].has_place;
  for (const HeldRow& row : rows.rows) {
    const hold::Slack slack = hold::slack_of(rows.errors[finger], row.contacts[finger], true);
    widest.travel = std::max(widest.travel, slack.travel);
    widest.angle = std::max(widest.angle, slack.angle);
    widest.place = std::max(widest.place, slack.place);
  }
  return widest;
}

/// Tolerances of one wheel likewise. An error of its radius moves the pin, and the encoder by radius / r times the
/// turn.
HeldWheel slacks_of(const HeldRows& rows, std::size_t number, double finger_place) {
  HeldWheel wheel = rows.wheels[number];
  wheel.place = kPossibleSigmas * (wheel.place + wheel.radius);
  for (const HeldRow& row : rows.rows) {
    // What the wheel has turned since the first row, with a turn to spare.
    if (wheel.spin) {
      const double turned = std::abs(row.pins[number].spin - rows.rows.front().pins[number].spin) + kFullTurn;
      const HeldWheel& given = rows.wheels[number];
      wheel.spin = std::max(*wheel.spin, kPossibleSigmas * (*given.spin + given.radius / given.wheel_radius * turned));
    }
    // The line's ends are a finger's contact and a pin, each off by its own tolerance.
    if (wheel.line) {
      const double length = (row.pins[number].at - row.contacts[0].at).norm();
      wheel.line = std::max(*wheel.line, std::min(std::numbers::pi, kPossibleSigmas * *rows.wheels[number].line +
                                                                        swing(finger_place + wheel.place, length)));
    }
  }
  // It is contained in the other tolerances now.
  wheel.radius = 0;
  return wheel;
}

/// The same rows with tolerances in place of standard deviations: the most of all rows.
HeldRows within_slack(HeldRows rows) {
  if (!rows.has_noise) return rows;
  // The given errors, before they are replaced.
  const HeldRows noisy = rows;
  rows.has_noise = false;
  for (std::size_t k = 0; k < rows.fingers(); ++k) rows.errors[k] = slacks_of(noisy, k);
  for (std::size_t k = 0; k < rows.wheels.size(); ++k) rows.wheels[k] = slacks_of(noisy, k, rows.errors[0].place);
  return rows;
}

/// Only where it leaves something out.
std::optional<Reach> confined(const Reach* reach) {
  if (reach == nullptr || !reach->decided || reach->is_whole()) return std::nullopt;
  return *reach;
}

/// What the certificate says of a finger with skin: its kind, tolerances, and what it has rolled over.
CertifiedFinger certified_finger(const Finger& finger, const HeldRows& rows, std::size_t number, const Reach* reach) {
  const HeldErrors& errors = rows.errors[number];
  CertifiedFinger result;
  result.kind = finger.is_disk() ? "disk" : finger.is_jaw() ? "jaw" : "outline";
  if (finger.is_disk()) result.radius = finger.disk()->radius;
  result.travel = errors.travel;
  result.angle = errors.angle;
  if (errors.has_place) result.place = errors.place;
  // Between the extreme contacts, less the tolerance of travel at both ends, the finger passed for certain.
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const HeldRow& row : rows.rows) {
    least = std::min(least, row.contacts[number].travelled);
    most = std::max(most, row.contacts[number].travelled);
  }
  result.passed = {least + errors.travel, most - errors.travel};
  result.reach = confined(reach);
  return result;
}

/// A wheel is a disk: its reach is computed here, and is stated where it leaves something out.
CertifiedWheel certified_wheel(const Part& part, const HeldWheel& wheel) {
  const Reach reach = reach_of_disk(part, wheel.wheel_radius);
  CertifiedWheel result{wheel.wheel_radius, wheel.place, wheel.spin, wheel.line, std::nullopt};
  if (!reach.is_whole()) result.reach = reach;
  return result;
}

/// The measurements of one row; places and encoders only where they are evidence.
CertifiedInstant certified_instant(const HeldRow& row, const HeldRows& rows) {
  CertifiedInstant instant{row.time, {}, {}};
  for (std::size_t k = 0; k < row.contacts.size(); ++k) {
    const HeldContact& contact = row.contacts[k];
    instant.contacts.push_back({contact.travelled, contact.tangent, std::nullopt});
    if (rows.errors[k].has_place) instant.contacts.back().at = contact.at;
  }
  for (std::size_t k = 0; k < row.pins.size(); ++k) {
    instant.pins.push_back({row.pins[k].at, std::nullopt});
    if (rows.wheels[k].spin) instant.pins.back().spin = row.pins[k].spin;
  }
  return instant;
}

/// Arcs of first contacts, each longer by a tenth of its tolerance. That of the angle is turned into length by the
/// perimeter's average curvature, 2 pi / P.
std::vector<Interval> widened(const std::vector<Interval>& extent, const HeldRows& rows, const Boundary& boundary) {
  std::vector<Interval> result;
  for (std::size_t k = 0; k < rows.fingers(); ++k) {
    const HeldErrors& errors = rows.errors[k];
    double by = errors.angle / kFullTurn * boundary.perimeter;  // as on a circle
    if (errors.has_place) by = std::min(by, errors.place);
    by = kWiderSet * std::max(by, errors.travel);
    result.push_back(boundary.is_full(extent[k]) ? extent[k] : boundary.arc(extent[k].lo - by, extent[k].hi + by));
  }
  return result;
}

/// With noise a set is listed if a placement of the answer is in it; all others are improbable. Without noise all sets
/// stay listed.
void mark_listed(const HoldAnswer& answer, const Boundary& boundary, std::vector<CertifiedHoldSet>& sets) {
  if (!answer.noise) return;
  for (CertifiedHoldSet& set : sets) set.listed = false;
  for (const HoldPlacement& placement : answer.placements) {
    // Whether some relation holds between the set and the placement for each finger.
    const auto all_of = [&](const CertifiedHoldSet& set, const auto& suits) {
      for (std::size_t k = 0; k < set.extent.size(); ++k) {
        if (!suits(set.extent[k], placement.contacts[k])) return false;
      }
      return true;
    };
    // The set that holds the best fit's first contacts.
    auto own = std::find_if(sets.begin(), sets.end(), [&](const CertifiedHoldSet& set) {
      return all_of(set, [&](const Interval& extent, const HoldContact& contact) {
        return boundary.contains(extent, contact.start);
      });
    });
    if (own == sets.end()) {  // the best fit may be a little beyond what 4.5 standard deviations leave
      own = std::find_if(sets.begin(), sets.end(), [&](const CertifiedHoldSet& set) {
        return all_of(set, [&](const Interval& extent, const HoldContact& contact) {
          return boundary.intersects(extent, contact.extent);
        });
      });
    }
    if (own != sets.end()) own->listed = true;
  }
}

/// A part that lies face down is solved in a mirror, x to -x. This maps the measurements and results back.
void take_out_of_mirror(HoldCertificate& certificate) {
  for (CertifiedInstant& instant : certificate.instants) {
    for (CertifiedInstant::Contact& contact : instant.contacts) {
      // Mirrored directions: angle a becomes pi - a, and turns change their sign.
      contact.tangent = std::numbers::pi - contact.tangent;
      if (contact.at) contact.at->x() = -contact.at->x();
    }
    for (CertifiedInstant::Pin& pin : instant.pins) {
      pin.at.x() = -pin.at.x();
      if (pin.spin) pin.spin = -*pin.spin;
    }
  }
  for (CertifiedHoldSet& set : certificate.sets) {
    for (double& zero : set.zeros) zero = -zero;
    for (CertifiedLie& lie : set.lies) {
      lie.pose = mirrored(lie.pose);
      for (auto& off : lie.off) off[1] = -off[1];
      for (CertifiedLie::Wheel& wheel : lie.wheels) {
        wheel.off[1] = -wheel.off[1];
        wheel.off[2] = -wheel.off[2];
      }
    }
  }
}

/// Searches for all sets of first contacts within the tolerances, and adds them with what fits in each. Sets of which
/// it is not known whether anything fits have an extent alone.
void add_sets(hold::HeldQuestion& question, const hold::WheelPaths& wheels, const HoldAnswer& answer,
              HoldCertificate& certificate) {
  const Part& part = question.part();
  const Boundary boundary = part.boundary();
  const auto arcs = [&](std::vector<Interval> extent) {
    extent.resize(question.rows().fingers());
    return widened(extent, question.rows(), boundary);
  };
  hold::HoldFit fit(part, question.searched(), wheels);
  hold::Witnessed found = hold::witnessed(question, fit, question.search().search());
  for (const hold::WitnessedSet& one : found.sets) {
    // A fit that rounding leaves just beyond the tolerances is not stated.
    CertifiedHoldSet set = lies_of(part, fit, wheels, one.state).value_or(CertifiedHoldSet{});
    set.extent = arcs(one.set.extent);
    certificate.sets.push_back(std::move(set));
  }
  // Without noise an answer tells of them as unresolved; with noise they are improbable as a rule.
  if (!answer.noise) {
    found.undecided.insert(found.undecided.end(), found.doubtful.begin(), found.doubtful.end());
  } else if (!found.doubtful.empty()) {
    for (const hold::FoundSet& one : question.sets(found.doubtful)) {
      certificate.sets.push_back({});
      certificate.sets.back().extent = arcs(one.set.extent);
    }
  }
  mark_listed(answer, boundary, certificate.sets);
  // Boxes that the budget left open, joined to sets.
  if (found.undecided.empty()) return;
  for (const hold::FoundSet& one : question.sets(found.undecided)) {
    certificate.unresolved.push_back(arcs(one.set.extent));
  }
}

}  // namespace

}  // namespace rollfix::certifying

namespace rollfix {

/// Whether the search came to an end and each listed set has first contacts that fit.
bool HoldCertificate::is_complete() const {
  return unresolved.empty() && std::none_of(sets.begin(), sets.end(), [](const CertifiedHoldSet& set) {
           return set.listed && set.first.empty();
         });
}

/// Asks the question of `problem` again within tolerances and writes it down with all that fits. Throws InputError: an
/// invalid or robust problem, an answer to another problem, a curve without a formula.
HoldCertificate certify_holds(const HoldProblem& problem, const HoldAnswer& answer) {
  hold::require_valid(problem);
  if (problem.robust) {
    throw InputError(
        "a certificate of fingers on a free part: expected rows that all count, found `robust`, under which a few need "
        "not fit: leave it out");
  }
  const Doing doing("looking for the proof that no other places fit");
  const hold::WheelPaths wheels = hold::paths_of(problem);
  std::vector<Log> logs = hold::logs_of(problem);
  const HoldProblem seen = problem.mirrored ? hold::in_mirror(problem, logs) : problem;
  // In place of noise, tolerances: so the same question has a yes or no for each first contact.
  const hold::HeldRows rows = certifying::within_slack(hold::held_rows(seen, logs));
  hold::HeldQuestion question(seen, rows, hold::rows_to_search(problem, logs.front()), wheels);
  HoldCertificate certificate;
  static_cast<CertifiedOutline&>(certificate) = certifying::certified_outline(problem.part);
  certificate.mirrored = problem.mirrored;
  for (std::size_t k = 0; k < rows.fingers(); ++k) {
    certificate.fingers.push_back(
        certifying::certified_finger(hold::finger_of_log(seen, k), rows, k, question.reach(k)));
  }
  for (const hold::HeldWheel& wheel : rows.wheels)
    certificate.wheels.push_back(certifying::certified_wheel(problem.part, wheel));
  std::vector<double> times;
  for (const hold::HeldRow& row : question.searched().rows) {
    certificate.instants.push_back(certifying::certified_instant(row, rows));
    times.push_back(row.time);
  }
  // The answer is only used for what it lists, but it must be of the same rows.
  if (answer.instants != times || answer.noise.has_value() != problem.noise.has_value()) {
    throw InputError("a certificate of fingers on a free part: expected the answer to this problem, found another one");
  }
  certifying::add_sets(question, wheels, answer, certificate);
  if (certificate.mirrored) certifying::take_out_of_mirror(certificate);
  return certificate;
}

}  // namespace rollfix
