#include "proved_roots.hpp"

#include <acb_elliptic.h>
#include <arb.h>
#include <arb_calc.h>

#include <numbers>

namespace bench {
namespace {

constexpr slong kPrecision = 64;  // bits
constexpr slong kMostDepth = 40;  // of halving: down to rounding
constexpr slong kMostEvaluations = 100000;
constexpr slong kMostRoots = 1000;
constexpr double kFrom = -0.0123456789;  // a direction that is no root: the search begins there and goes round

/// A real ball that cleans up behind itself.
class Ball {
 public:
  Ball() { arb_init(value_); }
  explicit Ball(double value) : Ball() { arb_set_d(value_, value); }
  ~Ball() { arb_clear(value_); }
  Ball(const Ball& other) : Ball() { arb_set(value_, other.value_); }
  Ball& operator=(const Ball& other) {
    arb_set(value_, other.value_);
    return *this;
  }
  arb_ptr get() { return value_; }
  arb_srcptr get() const { return value_; }

 private:
  arb_t value_;
};

Ball operator+(const Ball& one, const Ball& two) {
  Ball sum;
  arb_add(sum.get(), one.get(), two.get(), kPrecision);
  return sum;
}
Ball operator-(const Ball& one, const Ball& two) {
  Ball rest;
  arb_sub(rest.get(), one.get(), two.get(), kPrecision);
  return rest;
}
Ball operator*(const Ball& one, const Ball& two) {
  Ball product;
  arb_mul(product.get(), one.get(), two.get(), kPrecision);
  return product;
}
Ball operator/(const Ball& one, const Ball& two) {
  Ball ratio;
  arb_div(ratio.get(), one.get(), two.get(), kPrecision);
  return ratio;
}

/// The question in the direction n of the outward normal: the tangent turns as the normal does, so that a roll that
/// starts at n ends at n + theta, and what has to fit is its length.
struct Question {
  Ball a;
  Ball b;
  Ball length;
  Ball turn;
};

/// From the normal's direction to u, unwrapped: tan u = (b / a) tan n.
Ball parameter(const Question& q, const Ball& normal) {
  Ball sine;
  Ball cosine;
  arb_sin_cos(sine.get(), cosine.get(), normal.get(), kPrecision);
  Ball angle = (q.a - q.b) * sine * cosine / (q.a * cosine * cosine + q.b * sine * sine);
  arb_atan(angle.get(), angle.get(), kPrecision);
  return normal - angle;
}

/// Arc length from u = 0, by a E(u + pi/2 | m), m = 1 - b^2 / a^2.
Ball arc_length(const Question& q, const Ball& normal) {
  Ball quarter;
  arb_const_pi(quarter.get(), kPrecision);
  quarter = quarter * Ball(0.5);
  const Ball m = Ball(1) - q.b * q.b / (q.a * q.a);
  const auto integral = [&](const Ball& phi) {
    acb_t in;
    acb_t modulus;
    acb_t out;
    acb_init(in);
    acb_init(modulus);
    acb_init(out);
    acb_set_arb(in, phi.get());
    acb_set_arb(modulus, m.get());
    acb_elliptic_e_inc(out, in, modulus, 0, kPrecision);
    Ball value;
    acb_get_real(value.get(), out);
    acb_clear(in);
    acb_clear(modulus);
    acb_clear(out);
    return value;
  };
  return q.a * (integral(parameter(q, normal) + quarter) - integral(quarter));
}

/// d arc length / d normal: the radius of curvature a^2 b^2 / (a^2 cos^2 n + b^2 sin^2 n)^(3/2).
Ball radius(const Question& q, const Ball& normal) {
  Ball sine;
  Ball cosine;
  arb_sin_cos(sine.get(), cosine.get(), normal.get(), kPrecision);
  const Ball square = q.a * q.a * cosine * cosine + q.b * q.b * sine * sine;
  Ball root;
  arb_sqrt(root.get(), square.get(), kPrecision);
  return q.a * q.a * q.b * q.b / (square * root);
}

Ball excess(const Question& q, const Ball& normal) {
  return arc_length(q, normal + q.turn) - arc_length(q, normal) - q.length;
}

/// As arb_calc asks for it. Over a wide ball the value is that of the middle, give or take the slope: elliptic
/// integrals of wide balls say nothing.
int evaluate(arb_ptr out, const arb_t in, void* parameter_block, slong order, slong /*precision*/) {
  const Question& q = *static_cast<const Question*>(parameter_block);
  Ball normal;
  arb_set(normal.get(), in);
  Ball middle;
  arb_get_mid_arb(middle.get(), in);
  const Ball slope = radius(q, normal + q.turn) - radius(q, normal);
  const Ball value = excess(q, middle) + slope * (normal - middle);
  arb_set(out, value.get());
  if (order > 1) arb_set(out + 1, slope.get());
  return 0;
}

rollfix::Interval starts_within(const Question& q, const arf_interval_t block) {
  const auto length_at = [&](const arf_t end) {
    Ball normal;
    arb_set_arf(normal.get(), end);
    return arf_get_d(arb_midref(arc_length(q, normal).get()), ARF_RND_NEAR);
  };
  return {length_at(&block->a), length_at(&block->b)};
}

}  // namespace

ProvedRoots locate_by_arb(double a, double b, const rollfix::Reading& reading) {
  Question q{Ball(a), Ball(b), Ball(reading.length[0]), Ball(reading.turn)};
  arf_interval_t range;
  arf_interval_init(range);
  arf_set_d(&range->a, kFrom);
  arf_set_d(&range->b, kFrom + 2 * std::numbers::pi);
  arf_interval_ptr blocks = nullptr;
  int* flags = nullptr;
  const slong count = arb_calc_isolate_roots(&blocks, &flags, evaluate, &q, range, kMostDepth, kMostEvaluations,
                                             kMostRoots, kPrecision);
  ProvedRoots found;
  for (slong k = 0; k < count; ++k) {
    if (flags[k] == 1) {
      found.starts.push_back(starts_within(q, blocks + k));
    } else {
      ++found.undecided;
    }
  }
  _arf_interval_vec_clear(blocks, count);
  flint_free(flags);
  arf_interval_clear(range);
  return found;
}

}  // namespace bench
