#include "numerals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include "outline/turn.hpp"

namespace rollfix::draw {
namespace {

constexpr int kMostDecimals = 5;    // of a number written without an exponent
constexpr double kMostPlain = 1e6;  // likewise

std::string with_minus(std::string text) {
  for (std::size_t at = 0; (at = text.find('-', at)) != std::string::npos; at += 3) text.replace(at, 1, "\u2212");
  return text;
}

Ticks ticks_at(const Interval& range, double step) {
  Ticks ticks;
  const double slack = 1e-9 * range.width();
  const double first = std::ceil((range.lo - slack) / step);
  for (double k = first; k * step <= range.hi + slack; ++k)
    ticks.at.push_back(k * step + 0.0);  // never a negative zero
  ticks.decimals = std::clamp(-static_cast<int>(std::floor(std::log10(step) + 1e-9)), 0, 17);
  return ticks;
}

}  // namespace

std::string pretty(double value, int digits) {
  const std::string text = fmt::format("{:.{}g}", value, digits);
  return with_minus(text == "-0" ? "0" : text);
}

std::string pretty_degrees(double radians, int digits) { return pretty(radians / kDegree, digits) + "\u00b0"; }

double round_below(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= value * (1 + 1e-12)) return digit * power;
  }
  return power;
}

Ticks round_ticks(const Interval& range, int count) {
  const double rough = range.width() / count;
  double step = round_below(rough);
  if (step < 0.8 * rough) step = round_below(2.5001 * step);
  return ticks_at(range, step);
}

Ticks degree_ticks(const Interval& range, int count) {
  const double rough = range.width() / count;
  for (const double step : {5.0, 10.0, 15.0, 30.0, 45.0, 90.0, 180.0, 360.0}) {
    if (rough > 4 && step >= 0.8 * rough) return ticks_at(range, step);
  }
  if (rough <= 4) return round_ticks(range, count);
  // Many turns: a round number of them.
  double turns = round_below(rough / 360);
  if (360 * turns < 0.8 * rough) turns = round_below(2.5001 * turns);
  return ticks_at(range, 360 * turns);
}

std::string tick_text(double value, int decimals) {
  if (decimals > kMostDecimals || std::abs(value) >= kMostPlain) return pretty(value, 6);
  const std::string text = fmt::format("{:.{}f}", value, decimals);
  const bool zero = text.find_first_of("123456789") == std::string::npos;
  return with_minus(zero && text[0] == '-' ? text.substr(1) : text);
}

}  // namespace rollfix::draw
