#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "chebyshev.hpp"
#include "rollfix/curve.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/part.hpp"
#include "rollfix/turning_function.hpp"
#include "turning_range.hpp"

namespace rollfix {

/// A stretch of one curve, short enough that arc length and curvature are polynomials on it.
/// All series are by powers of x in [-1, 1], which is arc length: s = length * (1 + x) / 2 from the panel's start.
struct ResolvedPanel {
  double length = 0;            // arc length, in the outline's unit, above 0
  chebyshev::Series curvature;  // kappa(x)
  chebyshev::Series turn;       // the tangent's turn since the panel's start, radians
  chebyshev::Series parameter;  // the curve's own parameter u(x)
  Vec2 tangent_at_start;        // not normalized
  Vec2 tangent_at_end;
};

/// Cuts a curve into panels, in order. `size` is the outline's length or so: errors far below it don't count.
/// `spent`: attempts so far, of all curves of the outline. Throws InputError where the curve has no tangent (a cusp),
/// or too many attempts were made, with the place.
void resolve(const Curve& curve, double size, std::size_t& spent,
             const std::function<void(const ResolvedPanel&)>& sink);

/// From arc length back to the curves: on each panel of the turning function the curve's parameter as a
/// polynomial in the panel's x.
struct Parametrization {
  /// Where the panel lies: which curve of the outline, and which of the coefficients give u(x), by rising powers.
  struct Piece {
    std::uint32_t curve = 0;
    std::uint32_t offset = 0;
    std::uint32_t count = 0;
  };
  std::vector<Piece> pieces;  // one per panel
  std::vector<double> coefficients;

  /// u at x in [-1, 1] of this panel, in the parameter of the panel's own curve. Rounding may put it beyond the curve's
  /// domain by the last digits.
  double parameter(std::size_t panel, double x) const;
};

/// Builds the turning function of an outline, curve by curve: in the constructor, after which the three public members
/// are complete and are moved out by Part. Throws InputError: no curve, no size, and, with the place, a gap between
/// curves, a cusp, or a curve that too many panels would be needed for.
class TurningFunctionBuilder {
 public:
  explicit TurningFunctionBuilder(const Outline& outline);

  TurningFunction turning;          // panels, coefficients, spirals, P, period_turn
  Parametrization parametrization;  // one piece for each panel
  std::vector<Corner> corners;      // by rising s; of a closed outline the one at the seam has s = 0

 private:
  /// Checks that curve number `index` starts where the one before ends, and appends its panels.
  void add_curve(std::uint32_t index);
  /// Appends one panel, its spirals and its piece of the parametrization.
  void add_panel(const ResolvedPanel& resolved, std::uint32_t curve);
  void add_spirals(const chebyshev::Series& curvature);  // of the newest panel, by its powers
  /// Appends a stretch of the newest panel on which neither kappa nor kappa' changes sign.
  void add_spiral(double lo, double hi, std::uint32_t panel);
  /// Sets the angle that goes on at s to that of this tangent; a jump above rounding becomes a corner.
  void join(const Vec2& direction, double s);
  /// After the last panel: P, and of a closed outline the corner at the seam and the whole turn.
  void close();
  /// An outline of so many curves that memory counts: small powers are dropped.
  bool is_dense() const;
  /// Appends Theta and kappa of a panel to the coefficients, by powers of x.
  void store(const chebyshev::Series& turn, const chebyshev::Series& curvature, Panel& panel);

  const Outline& outline_;
  double size_ = 0;                      // the outline's length or so
  std::size_t attempts_ = 0;             // at panels, of all curves: see resolve
  double length_ = 0;                    // so far, with ...
  double length_rest_ = 0;               // ... what rounding left out of it
  double angle_ = 0;                     // of the tangent where the last panel ended
  double first_angle_ = 0;               // Theta just after s = 0, in (-pi, pi]
  Vec2 first_direction_ = Vec2::Zero();  // the tangent there, not normalized
  bool new_curve_ = true;                // the next spiral starts at a joint
};

/// All that a part holds, once it is computed.
struct Part::Data {
  Outline outline;                  // as stored: material on its left if closed
  TurningFunction turning;          // Theta(s), with its spirals
  Parametrization parametrization;  // from s back to the curves' parameters
  std::vector<Corner> corners;      // by rising s
  std::vector<double> inflections;  // s in [0, P), rising
  std::vector<double> vertices;     // the same
  TurningTree tree;                 // over the turning function; is not saved
};

/// Where the curvature changes sign. On a straight stretch between bends of opposite sign: its middle.
std::vector<double> find_inflections(const TurningFunction& turning);

/// Where the curvature, itself continuous, turns from rising to falling or back.
std::vector<double> find_vertices(const TurningFunction& turning, const std::vector<Corner>& corners);

/// Two places on the boundary that share a point of the plane.
struct Crossing {
  double first = 0;  // arc lengths
  double second = 0;
  Vec2 point;              // of the crossing, or near it
  bool is_certain = true;  // false: stretches lie side by side, too close to tell them apart with a bounded effort
};

/// A place where the part's boundary crosses or touches itself, if there is one. Exhaustive: stretches are passed
/// over only when they turn too little to meet themselves, or when boxes around them are apart.
std::optional<Crossing> find_crossing(const Part& part);

/// What a finger touches at a place.
struct Touched {
  Vec2 point;
  double tangent = 0;  // its direction just after the place, at the end of an open boundary before it
};

/// For saving a part and making it again, and for what takes one look at what it holds.
struct PartAccess {
  using Data = Part::Data;

  static const Data& data(const Part& part) { return *part.data_; }
  /// Point and tangent at base, 0 <= base <= P: both from one panel, which may be this.
  static Touched contact(const Part& part, double base, std::size_t likely_panel);
  /// The point at base, which lies on this panel; beyond the panel's curve by rounding: the curve's end.
  static Vec2 point(const Part& part, std::size_t panel_index, double base);
  /// A part of data that were complete before, such as those of a saved one; the tree is made anew.
  static Part part(Data data) {
    data.tree = TurningTree(data.turning);
    return Part(std::make_shared<const Data>(std::move(data)));
  }
};

/// Throws InputError for a length below what arc lengths on the part are accurate to. `what` was expected, such as "a
/// disk with a radius"; `cure` ends the message.
void require_not_lost(const Part& part, double length, const std::string& what, const std::string& cure);

}  // namespace rollfix
