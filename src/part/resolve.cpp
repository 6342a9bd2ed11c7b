#include "part_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "outline/turn.hpp"
#include "rollfix/error.hpp"
#include "work/pulse.hpp"

// Notation:
//   u               the curve's parameter, alpha(u) the curve; on a panel u = middle + `half_` times x'
//   |alpha'|        speed by powers of x': `speed_`; its integral, arc length: `length_`
//   x               arc length on the panel, from -1 to 1: what the result's series are in
//   x'(x)           parameter at equal arc length, at the Chebyshev points of x: `inner_`; as u: `nodes_`
//   kappa           (alpha' cross alpha'') / |alpha'|^3: `curvatures` at these points; its integral: `panel.turn`
//   tail            size of the last three Chebyshev coefficients: what interpolation has not resolved
// Follows docs/search.md, "Once per part".
// Idea: halve until speed and curvature are polynomials to rounding. Two checks that share nothing with that decide:
// the speed between the nodes (`agree`), and the angle between the tangents at both ends against the integral of kappa.
namespace rollfix {
namespace {

using chebyshev::Grid;
using chebyshev::Terms;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// A series is resolved when its last terms are rounding errors: relative to its size, ...
constexpr double kSeriesNoise = 20 * kEpsilon;
// ... or too small to matter: as a length (share of the outline's size) or as an angle (radians).
constexpr double kLengthNoise = 1e-17;
constexpr double kTurnNoise = 1e-15;
// A parameter is rounded, and so are the angles and powers that a curve makes of it.
constexpr double kParameterNoise = 4 * kEpsilon;
// Independent checks of a panel: speed between the nodes, and total turn against the tangents at the ends.
constexpr double kSpeedAgreement = 1e-13;
constexpr double kTurnAgreement = 5e-13;
// A panel whose turning differs from that of an arc (a line) by less is an arc (a line).
constexpr double kStructureTurn = 1e-13;
// A panel shorter than this share of its curve's domain that still isn't resolved holds a cusp.
constexpr double kShortestPanel = 1e-11;

// A curve of a drawing takes some tens of attempts, a spiral of a hundred turns some thousand. One that takes more has
// a parameter so uneven that its rounding alone keeps panels from being resolved: it would go on for hours.
constexpr std::size_t kOwnAttempts = 64;
constexpr std::size_t kMostAttempts = 200'000;  // of all curves of an outline, beyond their own

// A speed that varies by no more than this on a panel is known well enough on either half of it.
constexpr double kEvenSpeed = 4;

// Newton's method converges quadratically: after a step like this the next one would be a rounding error.
constexpr double kNewtonStep = 1e-8;
constexpr int kNewtonRounds = 10;
// After a step below this the slope is known well enough for the next one: what it is off by, times that, is rounding.
constexpr double kSameSlope = 1e-6;

constexpr int kCoarseDegree = 8;  // enough for a span between dense points
constexpr int kFineDegree = 16;

/// The speed vanishes at u, or no panel near it is resolved however short: there is no tangent.
[[noreturn]] void throw_cusp(const Curve& curve, double u) {
  const Vec2 place = curve.position(u);
  throw InputError(
      fmt::format("expected a tangent at every point, found none (a cusp) at ({:.6g}, {:.6g}), parameter {:.6g}: "
                  "remove the cusp or end the curve there, so that it becomes a corner",
                  place.x(), place.y(), u));
}

/// The budget of attempts is spent at u: the curve is regular, but its parameter runs too unevenly.
[[noreturn]] void throw_uneven(const Curve& curve, double u) {
  const Vec2 place = curve.position(u);
  throw InputError(
      fmt::format("expected an outline that {} pieces resolve, found a curve that takes more, at ({:.6g}, {:.6g}), "
                  "parameter {:.6g}: its parameter is too uneven, as with weights far apart: draw it anew",
                  kMostAttempts, place.x(), place.y(), u));
}

/// One attempt at a panel: is the curve resolved on this range by polynomials of this degree? `size` is the outline's
/// length; only with it can an absolute error be judged.
template <int Degree>
class Attempt {
 public:
  using Values = Terms<Degree>;  // at the grid's points

  /// `speed`: by powers of x in [-1, 1] of the parameter, where it is known.
  Attempt(const Curve& curve, double size, const Interval& range, const Values* speed = nullptr)
      : curve_(curve), size_(size), range_(range), half_(0.5 * range.width()), grid_(Grid<Degree>::instance()) {
    parameter_noise_ = kParameterNoise * curve.parameter_size(range);
    is_even_ = speed != nullptr;
    if (is_even_) speed_ = *speed;
  }

  /// Fills the panel and says whether its polynomials are as good as the curve's own rounding errors allow.
  bool fill(ResolvedPanel& panel) {
    // (1) |alpha'| by powers of x', unless the attempt on the range around this one knew it; (2) its integral is the
    // arc length; (3) the nodes at equal arc length; (4) kappa there, and its integral, the turn.
    if (!is_even_ && !measure_speed()) return false;
    length_ = chebyshev::antiderivative(speed_, half_);
    // The integral starts at x' = -1, so its value at x' = 1, the sum of all powers, is the panel's length.
    panel.length = length_.sum();
    return invert_length(panel) && measure_turn(panel);
  }
  /// Where they are not: how often the range is to be halved before it is worth another attempt.
  int halvings() const { return halvings_; }
  /// And whether the speed is resolved all the same: then it is known on either half as well.
  bool has_speed() const { return is_even_ && speed_agrees_; }
  std::array<Values, 2> speeds_of_halves() const { return grid_.halves(speed_); }

 private:
  using Inner = typename Grid<Degree>::Inner;

  /// The largest of the last three coefficients: what interpolation has not resolved.
  static double tail(const Values& series) { return series.template segment<3>(Degree - 2).abs().maxCoeff(); }

  /// Samples |alpha'| at the Chebyshev points of the parameter and fits its series. False: not resolved; `halvings_`
  /// then says how often to halve. Throws on a speed of 0 or one that is not finite.
  bool measure_speed() {
    beat();
    Values squares;
    for (int j = 0; j <= Degree; ++j) {
      squares[j] = curve_.velocity(range_.middle() + half_ * grid_.point(j)).squaredNorm();
    }
    // The table has an even number of entries: the last one is padding and must only be harmless.
    squares[Degree + 1] = squares[Degree];
    const Values speeds = squares.sqrt();
    if (!(speeds > 0 && speeds < kInfinity).all()) throw_cusp(curve_, range_.middle());
    const double least = speeds.minCoeff();
    const double most = speeds.maxCoeff();
    if (least == most) {  // a line's length is exact
      speed_ = Values::Zero();
      speed_[0] = most;
      return is_even_ = true;
    }
    const Values series = grid_.coefficients(speeds);
    // The last three coefficients stand for what a polynomial of this degree leaves out.
    const double rest = tail(series);
    // The parameter's own rounding moves each node: what the speed changes by on the way is noise as well.
    const double noise = kSeriesNoise * most + parameter_noise_ * (most - least) / half_;
    // How often the rest is above what is allowed, by the milder of two measures: relative to the speed's rounding, and
    // as a length on this panel beside the whole outline.
    const double excess = std::min(rest / noise, rest * range_.width() / (kLengthNoise * size_));
    if (excess > 1) {
      // One halving makes the rest smaller by a factor of 2^kMostGain at most, so fewer halvings would fail again.
      halvings_ += static_cast<int>(std::log2(excess) / kMostGain);
      return false;
    }
    speed_ = grid_.powers(series);
    // The same series then serves both halves, without another sampling.
    is_even_ = rest <= noise && most <= kEvenSpeed * least;
    return true;
  }

  /// The parameters x at which the length about the middle is so much, by the series that reverts that of the length,
  /// up to its fourth power.
  Inner first_guess(const Inner& lengths) const {
    // length = a1 (x' + b2 x'^2 + b3 x'^3 + b4 x'^4); reversed: x' = y - b2 y^2 + (2 b2^2 - b3) y^3 + ...
    const double b2 = length_[2] / length_[1];
    const double b3 = length_[3] / length_[1];
    const double b4 = length_[4] / length_[1];
    const Inner y = lengths / length_[1];
    const Inner x = y * (1 + y * (-b2 + y * (2 * b2 * b2 - b3 + y * (5 * b2 * b3 - b4 - 5 * b2 * b2 * b2))));
    return x.cwiseMax(-1).cwiseMin(1);
  }

  /// The nodes: u at the Chebyshev points of arc length, by Newton's method on the length's polynomial for all of them
  /// at once; the two ends are known. Fills `inner_`, `nodes_` and the panel's u(x). False: a node left the panel, so
  /// Newton's method did not converge there.
  bool invert_length(ResolvedPanel& panel) {
    // The lengths, from the panel's start, at which the Chebyshev points of x lie.
    const Inner targets = (grid_.inner() + 1) * (0.5 * panel.length);
    inner_ = first_guess(targets - length_[0]);
    Inner slopes;
    double last_step = 1;
    for (int round = 0; round < kNewtonRounds && last_step > kNewtonStep; ++round) {
      // The derivative of length by x' is speed times half the range. A last step with the slope before is as good.
      if (last_step > kSameSlope) slopes = chebyshev::values(speed_, inner_) * half_;
      const Inner steps = (targets - chebyshev::values(length_, inner_)) / slopes;
      inner_ += steps;
      last_step = steps.abs().maxCoeff();
    }
    // The ends are set, so that neighbouring panels share their end to the last bit.
    nodes_[0] = range_.lo;
    nodes_.template segment<Degree - 1>(1) = (inner_ * half_ + range_.middle()).template head<Degree - 1>();
    nodes_.template tail<2>().setConstant(range_.hi);
    panel.parameter = grid_.powers(grid_.coefficients(nodes_)).template head<Degree + 1>();
    return (inner_.abs() <= 1).all();
  }

  /// Samples kappa at the nodes, fits its series in x and integrates it to the turn. False: speed or curvature is not
  /// resolved, or the turn does not agree with the tangents at both ends within kTurnAgreement (radians).
  bool measure_turn(ResolvedPanel& panel) {
    // Position and derivatives at the nodes; speed and kappa are made of them.
    std::array<Jet, Degree + 1> jets;
    Values squares;
    Values crosses;
    for (int j = 0; j <= Degree; ++j) {
      const Jet& jet = jets[static_cast<std::size_t>(j)] = curve_.jet(nodes_[j]);
      squares[j] = jet.first.squaredNorm();
      crosses[j] = cross(jet.first, jet.second);
    }
    squares[Degree + 1] = squares[Degree];
    crosses[Degree + 1] = crosses[Degree];
    const Values speeds = squares.sqrt();
    // First check: these speeds are at other places than those that the series was fitted to.
    speed_agrees_ = agree(speeds, jets);
    if (!speed_agrees_) return false;
    const Values curvatures = crosses / (squares * speeds);  // (alpha' cross alpha'') / |alpha'|^3
    Values series = grid_.coefficients(curvatures);
    const auto noise = [&] { return curvature_noise(jets, curvatures); };
    const double rest = tail(series);
    // Resolved by any of three measures: relative to the largest kappa, as an angle over the panel, or as noise of the
    // curve's own formula. The last is the dearest, so it comes last.
    if (rest > kSeriesNoise * curvatures.abs().maxCoeff() && rest * panel.length > kTurnNoise && rest > noise()) {
      return false;
    }
    const int count = recognize_arc(series, panel.length);
    const Values powers = grid_.powers(series);
    panel.curvature = powers.head(count);
    // Theta is the integral of kappa ds, and ds = length / 2 dx.
    panel.turn = chebyshev::antiderivative(powers, 0.5 * panel.length).head(count + 1);
    panel.tangent_at_start = jets.front().first;
    panel.tangent_at_end = jets.back().first;
    // Second check: the directions at both ends know the turn up to whole laps, without any quadrature.
    const double between = angle_between(panel.tangent_at_start, panel.tangent_at_end);
    const double off = std::abs(nearest_angle(between - panel.turn.sum()));
    return off <= kTurnAgreement || off <= kTurnAgreement + noise() * panel.length;
  }

  /// Is the speed between the points that it was measured at what its series says?
  bool agree(const Values& speeds, const std::array<Jet, Degree + 1>& jets) const {
    const Inner off = (speeds.template segment<Degree>(1) - chebyshev::values(speed_, inner_)).abs();
    // The ends are at nodes of both grids and would tell nothing new.
    for (int j = 1; j < Degree; ++j) {
      const double limit = kSpeedAgreement * speeds[j];
      if (off[j - 1] > limit && off[j - 1] > limit + parameter_noise_ * jets[static_cast<std::size_t>(j)].second.norm())
        return false;
    }
    return true;
  }

  /// How far rounding may move kappa (1 / length) on this panel: by its own terms, |alpha''| / |alpha'|^2 being the
  /// size of one that may cancel, and by the parameter, which moves each node along d kappa / du.
  double curvature_noise(const std::array<Jet, Degree + 1>& jets, const Values& curvatures) const {
    double noise = 0;
    for (int j = 0; j <= Degree; ++j) {
      const Jet& jet = jets[static_cast<std::size_t>(j)];
      noise = std::max(noise, kSeriesNoise * (std::abs(curvatures[j]) + jet.second.norm() / jet.first.squaredNorm()) +
                                  parameter_noise_ * std::abs(curvature_rate(jet)));
    }
    return noise;
  }

  /// How many coefficients of the curvature count; the others are made 0. A panel whose turn is that of an arc to 1e-13
  /// rad gets one coefficient, the arc's curvature; one that is straight to 1e-13 rad gets the coefficient 0. So a
  /// spiral on it is an arc or a line exactly, with `trend` 0.
  static int recognize_arc(Values& series, double length) {
    const double most = series.abs().maxCoeff();
    // Coefficients at the end that are below rounding of the largest.
    int count = Degree + 1;
    while (count > 1 && std::abs(series[count - 1]) <= kEpsilon * most) --count;
    // |T_k| <= 1: the sum of the other coefficients bounds how far kappa gets from its mean.
    if (series.template tail<Degree + 1>().abs().sum() * length <= kStructureTurn) count = 1;
    series.tail(Degree + 2 - count).setZero();
    if (count == 1 && std::abs(series[0]) * length <= kStructureTurn) series[0] = 0;
    return count;
  }

  const Curve& curve_;
  double size_;     // the outline's length or so
  Interval range_;  // of the parameter u
  double half_;     // of the range's width
  const Grid<Degree>& grid_;
  static constexpr double kMostGain = Degree + 4;  // halving makes coefficient k smaller by about 2^k
  int halvings_ = 1;                               // after a failure: of the range before the next attempt
  bool is_even_ = false;        // the speed's noise is small beside the speed, wherever on the range that is
  bool speed_agrees_ = false;   // the first check was passed
  double parameter_noise_ = 0;  // rounding of u, in its own unit
  Values speed_;                // |alpha'| by powers of x in [-1, 1] of the parameter
  Values length_;               // arc length from the panel's start, likewise
  Inner inner_;                 // where in that x the nodes of equal arc length lie, but for the ends
  Values nodes_;                // the same as parameters u, with the ends
};

/// Cuts one curve into panels: halves its domain until an attempt succeeds, and hands the panels over in order.
class Resolver {
 public:
  Resolver(const Curve& curve, double size, std::size_t& spent, const std::function<void(const ResolvedPanel&)>& sink)
      : curve_(curve), size_(size), spent_(spent), sink_(sink) {}

  void run() {
    const Interval domain = curve_.domain();
    // Between dense points a span is one panel of the low degree, at half the memory. All else is halved at the high
    // one.
    Attempt<kCoarseDegree> attempt(curve_, size_, domain);
    if (attempt.fill(panel_)) {
      sink_(panel_);
    } else {
      cut(domain, 0);
    }
  }

 private:
  using Fine = Attempt<kFineDegree>;

  /// Halves the range so often before it tries. `speed`: the speed's series on this range, where the attempt on the
  /// range around it found it. Ends after some 37 halvings: then the range is below kShortestPanel, a cusp.
  void cut(const Interval& range, int halvings, const Fine::Values* speed = nullptr) {
    std::array<Fine::Values, 2> speeds;
    bool has_speeds = false;
    if (halvings == 0) {
      // The first attempts of each curve are free, so that an outline of many curves is not stopped by its number of
      // curves.
      if (++attempts_ > kOwnAttempts && ++spent_ > kMostAttempts) throw_uneven(curve_, range.middle());
      Fine attempt(curve_, size_, range, speed);
      if (attempt.fill(panel_)) return sink_(panel_);
      halvings = attempt.halvings();
      has_speeds = attempt.has_speed();
      if (has_speeds) speeds = attempt.speeds_of_halves();
    }
    // Also after halvings without an attempt: a range this short is not halved further.
    if (range.width() <= kShortestPanel * curve_.domain().width()) throw_cusp(curve_, range.middle());
    cut({range.lo, range.middle()}, halvings - 1, has_speeds ? &speeds[0] : nullptr);
    cut({range.middle(), range.hi}, halvings - 1, has_speeds ? &speeds[1] : nullptr);
  }

  const Curve& curve_;
  double size_;
  std::size_t attempts_ = 0;  // at panels of this curve
  std::size_t& spent_;
  const std::function<void(const ResolvedPanel&)>& sink_;
  ResolvedPanel panel_;  // that is being filled
};

}  // namespace

void resolve(const Curve& curve, double size, std::size_t& spent,
             const std::function<void(const ResolvedPanel&)>& sink) {
  Resolver(curve, size, spent, sink).run();
}

}  // namespace rollfix
