#pragma once

#include <cstddef>
#include <vector>

#include "plan/contact_way.hpp"

namespace rollfix {

/// Where both contacts are; of one finger only a's.
struct PairPlace {
  double at = 0;  // lambda
  ContactPlace a;
  ContactPlace b;
};

/// Turned against the part: of each finger, or its rate by lambda.
struct Turned {
  double a = 0;
  double b = 0;
};

/// How both fingers roll: their turns x, y against the part as functions of lambda in [0, 1], monotone between nodes
/// and with a continuous derivative (Fritsch and Carlson 1980). Beside a wheel y is what balances it, B = 0.
class RollPath {
 public:
  /// `b`: nullptr of one finger. `knots`: from 0 to 1, growing. `squeezed`: beside a wheel; then b at the knots is
  /// balanced, and between neighbours it is balanced once.
  RollPath(const ContactWay& a, const ContactWay* b, std::vector<double> knots, std::vector<Turned> turned,
           bool squeezed = false);

  const ContactWay& way_a() const { return *a_; }
  const ContactWay* way_b() const { return b_; }
  bool squeezed() const { return squeezed_; }
  const std::vector<double>& knots() const { return knots_; }

  /// `at`: values of lambda, in any order.
  std::vector<PairPlace> places(const std::vector<double>& at) const;
  std::vector<Turned> rates(const std::vector<double>& at) const;

 private:
  struct Cubic;
  struct Piece;
  Piece piece_at(double lambda) const;
  std::vector<Turned> turned(const std::vector<double>& at) const;

  const ContactWay* a_;
  const ContactWay* b_;
  std::vector<double> knots_;
  std::vector<Turned> turned_;
  std::vector<Turned> slopes_;
  bool squeezed_;
};

/// A finger's turn y beside which a wheel is in balance, for each turn x of finger a: B(x, y) = 0 between lo and hi,
/// where B has different signs. By regula falsi with Illinois' correction, all at once.
std::vector<double> balanced(const ContactWay& a, const ContactWay& b, const std::vector<double>& x,
                             std::vector<double> lo, std::vector<double> hi);

}  // namespace rollfix
