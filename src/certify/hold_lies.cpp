#include "hold_lies.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hold/contact_look.hpp"
#include "outline/turn.hpp"
#include "places.hpp"

// Notation, as in docs/rig.md:
//   X, phi          the part at an instant; C: a pin in the world, x: on the part
//   t, psi          where the wheel touches, and the tangent there, at a corner a pivot
//   be - phi - psi - t / r   an encoder's zero, as one instant has it
namespace rollfix {
namespace {

using hold::HeldContact;
using hold::HeldErrors;
using hold::HeldRows;
using hold::HeldState;
using hold::HeldWheel;

constexpr double kFits = 1 + 1e-10;  // shares of tolerances, rounded
constexpr double kAtCorner = 1e-12;  // of the perimeter

/// value less whole periods, nearest to 0.
double in_period(double value, double period) {
  return period > 0 ? value - period * std::round(value / period) : value;
}

class Lies {
 public:
  Lies(const Part& part, const hold::HoldFit& fit, const hold::WheelPaths& paths, const HeldState& state)
      : part_(part), fit_(fit), rows_(fit.rows()), paths_(paths), state_(state) {}

  std::optional<CertifiedHoldSet> described() {
    CertifiedHoldSet set;
    const Boundary boundary = part_.boundary();
    for (std::size_t k = 0; k < fit_.fingers(); ++k) {
      set.first.push_back(boundary.canonical(state_.unknowns(static_cast<Eigen::Index>(k))));
      set.at.push_back(place_of(part_, set.first.back()));
    }
    first_ = set.first.front();
    set.zeros.assign(paths_.size(), 0);
    spun_.assign(paths_.size(), {});
    for (std::size_t row = 0; row < rows_.rows.size(); ++row) set.lies.push_back(lie_at(row));
    for (std::size_t wheel = 0; wheel < paths_.size(); ++wheel) add_zero(wheel, set);
    if (!fits_) return std::nullopt;
    return set;
  }

 private:
  void require(double share) { fits_ = fits_ && std::abs(share) <= kFits; }

  CertifiedLie lie_at(std::size_t row) {
    CertifiedLie lie;
    lie.pose = fit_.pose_at(state_, row).pose;
    for (std::size_t k = 0; k < fit_.fingers(); ++k) {
      const HeldContact& contact = rows_.rows[row].contacts[k];
      const HeldErrors& errors = rows_.errors[k];
      const double place = errors.has_place ? fit_.residual(state_, row, k).place.norm() / errors.place : 0;
      const hold::BlurredPlace about = hold::ranged(part_, fit_.place_of(state_, row, k), errors.travel);
      const double turn =
          nearest_angle(contact.tangent - lie.pose.heading - about.angle) / (about.half_turn + errors.angle);
      lie.off.push_back({place, turn});
      require(place);
      require(turn);
    }
    for (std::size_t k = 0; k < paths_.size(); ++k) lie.wheels.push_back(wheel_at(row, k, lie.pose));
    return lie;
  }

  CertifiedLie::Wheel wheel_at(std::size_t row, std::size_t number, const Pose& pose) {
    const HeldWheel& wheel = rows_.wheels[number];
    const hold::HeldPin& pin = rows_.rows[row].pins[number];
    const Vec2 seen = Pose{0, 0, -pose.heading}.turned(pin.at - Vec2(pose.x, pose.y));
    const hold::NearPin near = paths_[number]->nearest(seen);
    const Boundary boundary = part_.boundary();
    const double s = boundary.closed ? boundary.canonical(near.s) : std::clamp(near.s, 0.0, boundary.perimeter);
    const double psi = tangent_at(s, near.angle);
    CertifiedLie::Wheel touching{place_of(part_, s), nearest_angle(psi), {}};
    const Vec2 path = part_.point(s) + wheel.wheel_radius * Vec2(std::sin(psi), -std::cos(psi));
    touching.off[0] = (seen - path).norm() / wheel.place;
    if (wheel.line) {
      const Vec2 way = pin.at - rows_.rows[row].contacts[0].at;
      touching.off[1] =
          nearest_angle(std::atan2(way.y(), way.x()) - pose.heading - psi + 0.5 * std::numbers::pi) / *wheel.line;
    }
    if (wheel.spin) spun_[number].push_back(pin.spin - counted_heading(row, pose) - psi - s / wheel.wheel_radius);
    require(touching.off[0]);
    require(touching.off[1]);
    return touching;
  }

  /// The boundary's own tangent, or where the wheel may pivot the one that it has.
  double tangent_at(double s, double pivoted) const {
    const double own = part_.turning().angle(s);
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
    const double about = rows_.rows[row].contacts[0].tangent - angle;
    return about + nearest_angle(pose.heading - about);
  }

  /// In the middle of what all instants say.
  void add_zero(std::size_t number, CertifiedHoldSet& set) {
    const std::vector<double>& spun = spun_[number];
    if (spun.empty()) return;
    const double period = paths_[number]->spin_period();
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

}  // namespace

std::optional<CertifiedHoldSet> lies_of(const Part& part, const hold::HoldFit& fit, const hold::WheelPaths& paths,
                                        const HeldState& state) {
  return Lies(part, fit, paths, state).described();
}

}  // namespace rollfix
