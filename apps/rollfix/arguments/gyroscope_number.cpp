#include "rollfix/arguments/gyroscope_number.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "rollfix/arguments/typed_number.hpp"
#include "rollfix/error.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

/// What an angle is divided by: as it is written, and how many seconds, or square roots of seconds, that is.
struct Per {
  std::string_view written;
  double seconds;
};
constexpr std::array<Per, 3> kRates = {{{"s", 1}, {"min", 60}, {"h", 3600}}};
const std::array<Per, 6> kWalks = {{{"sqrt(s)", 1},
                                    {"sqrt(min)", std::sqrt(60.0)},
                                    {"sqrt(h)", 60},
                                    {"s/sqrt(hz)", 1},
                                    {"min/sqrt(hz)", 60},
                                    {"h/sqrt(hz)", 3600}}};

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](char c) { return 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return result;
}

template <class Table>
double read_per(std::string_view text, const std::string& what, const Table& table, const char* examples) {
  const std::string_view shown = trimmed(text);
  const std::size_t slash = shown.find('/');
  if (slash == std::string_view::npos && shown.find("deg") == std::string_view::npos) return read_number(shown, what);
  const std::string per = slash == std::string_view::npos ? "" : lower(trimmed(shown.substr(slash + 1)));
  const auto unit = std::find_if(table.begin(), table.end(), [&](const Per& one) { return one.written == per; });
  if (unit == table.end()) throw InputError(fmt::format("{}: '{}' is none of {}", what, shown, examples));
  std::string_view angle = trimmed(shown.substr(0, slash));
  if (angle.size() > 3 && angle.substr(angle.size() - 3) == "rad") angle.remove_suffix(3);
  return read_angle(angle, what) / unit->seconds;
}

}  // namespace

double read_rate(std::string_view text, const std::string& what) {
  return read_per(text, what, kRates, "10deg/h, 5deg/min, 0.01deg/s, or radians per second");
}

double read_walk(std::string_view text, const std::string& what) {
  return read_per(text, what, kWalks,
                  "0.3deg/sqrt(h), 0.005deg/sqrt(s), 0.005deg/s/sqrt(Hz), or radians per square root of a second");
}

}  // namespace rollfix::app
