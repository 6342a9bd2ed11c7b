#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rollfix/documents.hpp"
#include "text/text.hpp"

namespace rollfix {
namespace {

char letter_of(std::size_t finger) { return static_cast<char>('a' + finger); }

/// "finger a", "wheel b".
std::string named(std::size_t finger, const HoldAnswer& answer) {
  return fmt::format("{} {}", answer.rolls[finger].is_wheel ? "wheel" : "finger", letter_of(finger));
}

/// "of all logs", "of b.csv, finger b".
std::string whose(const HoldDiagnosis& diagnosis, const HoldAnswer& answer) {
  if (!diagnosis.finger) return "of all logs";
  return fmt::format("of {}, {},", plain(answer.rolls[*diagnosis.finger].name), named(*diagnosis.finger, answer));
}

/// As it was typed, with other numbers.
std::string noise_option(const Noise& noise) {
  std::string fields;
  for (const NoiseKind& kind : kNoiseKinds) {
    const double sd = noise.*kind.sd;
    if (sd <= 0) continue;
    const bool is_angle = kind.unit == NoiseKind::Unit::angle;
    fields += fmt::format("{}{}={:.3g}{}", fields.empty() ? "" : ",", kind.name,
                          is_angle ? sd * 180 / std::numbers::pi : sd, is_angle ? "deg" : "");
  }
  return "--noise " + fields;
}

/// The first finger that it is about, as it is and as it would be.
std::string radius_words(const HoldDiagnosis& diagnosis, const HoldAnswer& answer) {
  const std::size_t finger = diagnosis.finger.value_or(0);
  const double said = answer.rolls[finger].radius;
  return fmt::format("the radius of {} is {:.4g} ± {:.1g} instead of {:.4g}",
                     diagnosis.finger ? named(finger, answer) : "the fingers", diagnosis.factor * said,
                     diagnosis.factor_sd * said, said);
}

std::string counted_rows(int rows) { return fmt::format("{} {}", rows, rows == 1 ? "row" : "rows"); }

}  // namespace

std::string words_of(const HoldDiagnosis& diagnosis, const HoldAnswer& answer) {
  const std::string of = whose(diagnosis, answer);
  switch (diagnosis.cause) {
    case HoldCause::radius:
      return radius_words(diagnosis, answer);
    case HoldCause::unit:
      return fmt::format("x and y {} are in {}, the part in {}", of, diagnosis.unit, diagnosis.into);
    case HoldCause::late:
      return fmt::format("the rows {} are {} {} than those of the others", of, counted_rows(std::abs(diagnosis.rows)),
                         diagnosis.rows > 0 ? "later" : "earlier");
    case HoldCause::mirrored:
      return answer.mirrored ? "the part does not lie face down, or all angles are counted clockwise"
                             : "the part lies face down, or all angles are counted clockwise";
    case HoldCause::u_clockwise:
      return fmt::format("u {} is counted clockwise", of);
    case HoldCause::psi_clockwise:
      return fmt::format("psi {} is counted clockwise", of);
    case HoldCause::both_clockwise:
      return fmt::format("u and psi {} are counted clockwise", of);
    case HoldCause::u_degrees:
      return fmt::format("u {} is in degrees", of);
    case HoldCause::psi_degrees:
      return fmt::format("psi {} is in degrees", of);
    case HoldCause::angles_degrees:
      return fmt::format("u and psi {} are in degrees", of);
    case HoldCause::u_psi_swapped:
      return fmt::format("u and psi {} are exchanged", of);
    case HoldCause::x_y_swapped:
      return fmt::format("x and y {} are exchanged", of);
    case HoldCause::fingers_swapped:
      return fmt::format("fingers {} and {} are exchanged: their logs, or their shapes", letter_of(*diagnosis.finger),
                         letter_of(*diagnosis.other));
    case HoldCause::prior:
      return "what --prior, --heading or --pose says contradicts the rows";
    case HoldCause::stray:
      return fmt::format("{} of {} measurements {} outliers", diagnosis.strays, answer.rows * answer.rolls.size(),
                         diagnosis.strays == 1 ? "is an" : "are");
    case HoldCause::squeezed:
      return "the wheel's normal does not point through the finger's contact as --squeezed says";
    case HoldCause::slip:
      return "lengths are wrong here and there: probably a finger slipped";
    case HoldCause::noise:
      break;
  }
  return answer.noise ? fmt::format("the measurements are {:.2g} times as noisy as stated", diagnosis.factor)
                      : "the rows jitter by more than their digits say, but no noise was stated";
}

std::string cure_of(const HoldDiagnosis& diagnosis, const HoldAnswer& answer) {
  switch (diagnosis.cause) {
    case HoldCause::radius:
      return fmt::format("--finger {},r={:.4g}{}",
                         answer.rolls[diagnosis.finger.value_or(0)].is_wheel ? "wheel" : "disk",
                         diagnosis.factor * answer.rolls[diagnosis.finger.value_or(0)].radius,
                         diagnosis.finger ? fmt::format(" for {}", named(*diagnosis.finger, answer)) : "");
    case HoldCause::unit:
      return fmt::format("multiply x and y by {:.6g}", diagnosis.factor);
    case HoldCause::late:
      return fmt::format("move its rows: row {} belongs to row {} of the others", 1 + std::max(diagnosis.rows, 0),
                         1 + std::max(-diagnosis.rows, 0));
    case HoldCause::mirrored:
      return answer.mirrored ? "leave --mirror out" : "--mirror";
    case HoldCause::u_clockwise:
      return "counter-clockwise angles: change the sign of u";
    case HoldCause::psi_clockwise:
      return "counter-clockwise angles: change the sign of psi";
    case HoldCause::both_clockwise:
      return "counter-clockwise angles: change the signs of u and psi";
    case HoldCause::u_degrees:
    case HoldCause::psi_degrees:
    case HoldCause::angles_degrees: {
      const char* const columns = diagnosis.cause == HoldCause::u_degrees     ? "u=u:deg"
                                  : diagnosis.cause == HoldCause::psi_degrees ? "psi=psi:deg"
                                                                              : "u=u:deg,psi=psi:deg";
      return diagnosis.finger ? "a unit behind the column's name, as in psi [deg]"
                              : fmt::format("--columns {}", columns);
    }
    case HoldCause::u_psi_swapped:
      return diagnosis.finger ? "exchange the names of its columns" : "--columns u=psi,psi=u";
    case HoldCause::x_y_swapped:
      return diagnosis.finger ? "exchange the names of its columns" : "--columns x=y,y=x";
    case HoldCause::fingers_swapped:
      return "give both in the other order";
    case HoldCause::prior:
      return "leave it out";
    case HoldCause::squeezed:
      return "leave --squeezed out, or state a larger error, as in --squeezed 5deg";
    case HoldCause::stray:
      return "--robust";
    case HoldCause::slip:
    case HoldCause::noise:
      break;
  }
  return noise_option(diagnosis.noise);
}

}  // namespace rollfix
