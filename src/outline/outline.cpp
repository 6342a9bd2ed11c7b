#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "outline/box.hpp"
#include "outline/refusals.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"
#include "text/text.hpp"

// Notation:
//   u, h            a parameter, and the step of a stencil of nine jets about it: Stencil
//   stated          a jet's derivative of an order, held against differences of the order below: `compare`
//   gap, speed      between two curves where they meet; |c'|, whose least is looked for by Brent's method
// Follows include/rollfix/outline.hpp, `check`; differences are of eighth order in h.
namespace rollfix {
namespace {

/// Stated and differenced derivatives agree to this share of the derivative's size nearby ...
constexpr double kAgreement = 1e-8;
/// ... and to what rounding of the order below makes of the difference, in units of epsilon / step.
constexpr double kRounding = 64;
/// A gap between two curves above this share of the outline's size is one.
constexpr double kGap = 1e-12;
/// A speed below this share of the speed next to it vanishes: at a cusp the search below gets to about 1e-8.
constexpr double kStandstill = 1e-6;

/// A vector as messages show it.
std::string coordinates(const Vec2& v) { return fmt::format("({:.10g}, {:.10g})", v.x(), v.y()); }

/// Of order 0 (the position) to 3.
const Vec2& derivative(const Jet& jet, int order) {
  switch (order) {
    case 0:
      return jet.position;
    case 1:
      return jet.first;
    case 2:
      return jet.second;
    default:
      return jet.third;
  }
}

/// Whether all four vectors are finite.
bool is_finite(const Jet& jet) {
  return jet.position.allFinite() && jet.first.allFinite() && jet.second.allFinite() && jet.third.allFinite();
}

/// Jets at u and at four equal steps to either side of it.
struct Stencil {
  double step;  // of the parameter
  std::array<Jet, 9> jets;

  Stencil(const Curve& curve, double u, double h) : step(h) {
    for (std::size_t j = 0; j < jets.size(); ++j) jets[j] = curve.jet(u + (static_cast<double>(j) - 4) * h);
  }

  /// The largest size of that derivative in the stencil.
  double largest(int order) const {
    double result = 0;
    for (const Jet& jet : jets) result = std::max(result, derivative(jet, order).norm());
    return result;
  }

  /// The derivative of that order from differences of the order below it, of eighth order in the step.
  Vec2 difference(int order) const {
    // The weights of the central difference over four steps to either side.
    constexpr std::array<double, 4> kWeights = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
    Vec2 sum = Vec2::Zero();
    // Odd symmetry: each weight belongs to one place ahead and one behind.
    for (std::size_t k = 1; k <= 4; ++k) {
      sum += kWeights[k - 1] * (derivative(jets[4 + k], order - 1) - derivative(jets[4 - k], order - 1));
    }
    return sum / step;
  }
};

/// Steps from a quarter of the way to the domain's nearer end down to a thousandth of that.
/// A step that is too large has the formula's error, one too small has rounding: all of them are tried. None leaves the
/// domain.
std::vector<Stencil> stencils(const Curve& curve, double u) {
  constexpr int kHalvings = 10;
  const Interval domain = curve.domain();
  // The first stencil just touches the nearer end of the domain.
  double step = 0.25 * std::min(u - domain.lo, domain.hi - u);
  std::vector<Stencil> result;
  for (int k = 0; k <= kHalvings; ++k, step /= 2) result.emplace_back(curve, u, step);
  return result;
}

/// A stated derivative beside its difference quotient, at one parameter.
struct Disagreement {
  double excess;     // in units of what is allowed
  double u;          // parameter of the curve
  Vec2 stated;       // by the curve's jet
  Vec2 differenced;  // by differences
};

/// Compares with the difference quotient that changed least when its step was halved.
Disagreement compare(const std::vector<Stencil>& family, double u, int order) {
  // The quotient is converged where halving the step changes it least.
  const Stencil* best = nullptr;
  double least_change = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < family.size(); ++k) {
    const double change = (family[k].difference(order) - family[k - 1].difference(order)).norm();
    if (change < least_change) {
      least_change = change;
      best = &family[k];
    }
  }
  // The middle jet of any stencil is the one at u.
  const Vec2 stated = derivative(family.front().jets[4], order);
  // No two quotients could be compared: one is not finite.
  if (best == nullptr) return {std::numeric_limits<double>::infinity(), u, stated, stated};
  const Vec2 differenced = best->difference(order);
  // Rounding of the values that are subtracted, by the step; `allowed` has both errors.
  const double rounding = kRounding * std::numeric_limits<double>::epsilon() * best->largest(order - 1) / best->step;
  const double allowed = kAgreement * best->largest(order) + rounding;
  const double error = (stated - differenced).norm();
  return {error > 0 ? error / allowed : 0, u, stated, differenced};
}

/// The middles of equal parts of the domain: no ends, so that a stencil has room on both sides.
std::vector<double> sample_parameters(const Curve& curve, int samples) {
  const Interval domain = curve.domain();
  std::vector<double> result;
  for (int k = 0; k < samples; ++k) result.push_back(domain.lo + domain.width() * (k + 0.5) / samples);
  return result;
}

/// What check() looks at; complaints in the order of the curves.
class Checker {
 public:
  Checker(const Outline& outline, int samples) : outline_(outline), samples_(std::max(samples, 2)) {}

  /// Curve by curve, then the joints; an empty list is a sound outline.
  std::vector<std::string> run() {
    if (outline_.curves.empty()) complain("the outline has no curves; give it at least one");
    bool all_usable = true;
    for (std::size_t i = 0; i < outline_.curves.size(); ++i) {
      if (!check_values(i)) {
        all_usable = false;
        continue;
      }
      check_velocity(i);
      for (int order = 1; order <= 3; ++order) check_derivative(i, order);
      check_regularity(i);
    }
    // Ends that are not finite can't be compared.
    if (all_usable) check_joins();
    return std::move(complaints_);
  }

 private:
  void complain(std::string text) { complaints_.push_back(std::move(text)); }
  const Curve& curve(std::size_t i) const { return outline_.curves[i]; }

  /// Nothing else can be asked of a curve that fails here.
  bool check_values(std::size_t i) {
    const Interval domain = curve(i).domain();
    if (!(domain.lo < domain.hi) || !std::isfinite(domain.width())) {
      complain(fmt::format("curve {}: the domain is [{}, {}], expected two finite numbers in rising order", i,
                           domain.lo, domain.hi));
      return false;
    }
    // The ends as well: position and derivatives must hold there, too.
    std::vector<double> parameters = sample_parameters(curve(i), samples_);
    parameters.push_back(domain.lo);
    parameters.push_back(domain.hi);
    for (const double u : parameters) {
      if (is_finite(curve(i).jet(u)) && curve(i).velocity(u).allFinite()) continue;
      complain(fmt::format("curve {} at u = {}: the position or a derivative is not finite", i, u));
      return false;
    }
    return true;
  }

  /// A curve type may state velocity(u) apart from jet(u): both must agree.
  void check_velocity(std::size_t i) {
    for (const double u : sample_parameters(curve(i), samples_)) {
      const Vec2 alone = curve(i).velocity(u);
      const Vec2 in_jet = curve(i).jet(u).first;
      if ((alone - in_jet).norm() <= kAgreement * in_jet.norm()) continue;
      complain(fmt::format("curve {} at u = {}: velocity(u) is {}, but jet(u).first is {}", i, u, coordinates(alone),
                           coordinates(in_jet)));
      return;
    }
  }

  /// Reports the worst place only: where one is wrong, most are.
  void check_derivative(std::size_t i, int order) {
    // Each sample costs eleven stencils of nine jets.
    std::optional<Disagreement> worst;
    for (const double u : sample_parameters(curve(i), samples_)) {
      const Disagreement found = compare(stencils(curve(i), u), u, order);
      if (!worst || found.excess > worst->excess) worst = found;
    }
    if (worst->excess <= 1) return;
    constexpr std::array<const char*, 4> kNames = {"position", "first derivative", "second derivative",
                                                   "third derivative"};
    const auto k = static_cast<std::size_t>(order);
    complain(fmt::format("curve {} at u = {}: the {} is {}, but differences of the {} give {}", i, worst->u, kNames[k],
                         coordinates(worst->stated), kNames[k - 1], coordinates(worst->differenced)));
  }

  /// Looks for the least speed around the slowest sample.
  void check_regularity(std::size_t i) {
    const Interval domain = curve(i).domain();
    std::vector<double> parameters = sample_parameters(curve(i), samples_);
    parameters.insert(parameters.begin(), domain.lo);
    parameters.push_back(domain.hi);
    const auto squared_speed = [&](double u) { return curve(i).velocity(u).squaredNorm(); };
    // Each sample that is no faster than both of its neighbours brackets a least speed.
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      // The samples beside it, or at an end of the domain the sample itself.
      const double lo = parameters[k == 0 ? 0 : k - 1];
      const double hi = parameters[std::min(k + 1, parameters.size() - 1)];
      const double here = squared_speed(parameters[k]);
      const double beside = std::max(squared_speed(lo), squared_speed(hi));
      if (here > squared_speed(lo) || here > squared_speed(hi)) continue;
      constexpr int kBits = std::numeric_limits<double>::digits / 2;
      auto [u, least] = boost::math::tools::brent_find_minima(squared_speed, lo, hi, kBits);
      // At an end of the domain the sample itself may be slower than all that Brent's method visits.
      if (here <= least) {
        u = parameters[k];
        least = here;
      }
      // Held against the speed beside it, so that a curve that is slow all over is no cusp.
      if (least > kStandstill * kStandstill * beside) continue;
      complain(
          fmt::format("curve {} at u = {}, {}: the first derivative is {}, expected it not to vanish; draw the "
                      "place with another parameter, or end the curve there if it is a cusp",
                      i, u, coordinates(curve(i).position(u)), coordinates(curve(i).velocity(u))));
      return;
    }
  }

  /// The diagonal of a box around samples: what gaps are held against.
  double size() const {
    Box box;
    for (const Curve& each : outline_.curves) {
      for (const double u : sample_parameters(each, samples_)) box.extend(each.position(u));
    }
    return box.diagonal().norm();
  }

  /// Each curve must start where the one before ends; of a closed outline the first one, too.
  void check_joins() {
    const std::size_t count = outline_.curves.size();
    const double most = kGap * (count > 0 ? size() : 0);
    for (std::size_t i = 0; i < count; ++i) {
      if (i + 1 == count && !outline_.closed) break;
      const std::size_t next = (i + 1) % count;
      const Vec2 end = curve(i).back();
      const Vec2 start = curve(next).front();
      const double gap = (start - end).norm();
      if (gap <= most) continue;
      complain(fmt::format("a gap of {:.3g} between the end of curve {} at {} and the start of curve {} at {}", gap, i,
                           coordinates(end), next, coordinates(start)));
    }
  }

  const Outline& outline_;
  int samples_;
  std::vector<std::string> complaints_;
};

}  // namespace

std::vector<std::string> check(const Outline& outline, int samples) { return Checker(outline, samples).run(); }

/// Each curve backwards, in the opposite order; `reversed` changes. Everything else is copied.
Outline reversed(const Outline& outline) {
  Outline result;
  result.name = outline.name;
  result.closed = outline.closed;
  result.reversed = !outline.reversed;
  result.hole = outline.hole;
  result.gallery = outline.gallery;
  result.unit = outline.unit;
  result.gap = outline.gap;
  result.accuracy = outline.accuracy;
  result.curves.reserve(outline.curves.size());
  // A closed outline's first point is also the end of its last curve, and so stays the first point.
  for (auto curve = outline.curves.rbegin(); curve != outline.curves.rend(); ++curve) {
    result.curves.push_back(reversed(*curve));
  }
  return result;
}

/// Not the gallery's any more: its specification would give other lengths. With a factor of 1 only the unit's name
/// changes.
Outline scaled(const Outline& outline, double factor, const std::string& unit) {
  Outline result = outline;
  result.unit = unit;
  if (factor == 1) return result;
  result.gallery.clear();
  result.gap *= factor;
  result.accuracy.alike *= factor;
  result.accuracy.walk /= std::sqrt(factor);
  for (Curve& curve : result.curves) curve = scaled(curve, factor);
  return result;
}

namespace {

constexpr const char* kKnown = "points in .csv, .dat or .txt, or gallery:NAME as in gallery:ellipse,a=2,b=1";

/// "ellipse,a=2" without "gallery:", or a slip of the pen in it.
std::string gallery_hint(const std::string& argument) {
  std::vector<std::string> names;
  for (const GalleryShape& shape : gallery_shapes()) names.push_back(shape.name);
  const std::string nearest = nearest_name(argument.substr(0, argument.find(',')), names);
  return nearest.empty() ? "" : fmt::format("; did you mean gallery:{}?", nearest);
}

}  // namespace

/// Words for an ending that nothing reads: what was found, what is read, and a likely cure.
std::string unknown_ending(const std::string& path, const std::string& known) {
  const std::string ending = ending_of(path);
  if (ending == ".gz") return fmt::format("{}: is compressed, expected plain text: gunzip -k {}", path, path);
  const std::string found = ending.empty() ? "has no ending" : fmt::format("has the unknown ending '{}'", ending);
  return fmt::format("{}: {}, expected {}{}", path, found, known, gallery_hint(path));
}

/// By the argument's form alone: "gallery:...", then the file's ending.
Outline load_outline(const std::string& argument, const OutlineOptions& options, std::vector<std::string>* notes) {
  if (argument.rfind("gallery:", 0) == 0) {
    Outline outline = gallery(argument);
    outline.name = argument;
    outline.unit = options.unit;
    return outline;
  }
  const std::string ending = ending_of(argument);
  if (argument == "-" || ending == ".csv" || ending == ".dat" || ending == ".txt") {
    // What the file says of its unit and its order goes on to the outline.
    OutlineOptions known = options;
    const std::vector<Vec2> points = read_points(argument, options, notes, &known.unit, &known.airfoil);
    return outline_through(points, argument, known, notes);
  }
  // Known endings that another library of the project reads: the message says which.
  if (ending == ".json" || ending == ".dxf" || ending == ".svg") {
    throw InputError(
        fmt::format("{}: {} files are read by the library rollfix::files, as load_part(\"{}\", {{}}).part of "
                    "<rollfix/files.hpp>; here expected {}",
                    argument, ending, argument, kKnown));
  }
  throw InputError(unknown_ending(argument, kKnown));
}

}  // namespace rollfix
