#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "documents/documents.hpp"
#include "log/header/log_header.hpp"
#include "outline/turn.hpp"
#include "roll/noise.hpp"
#include "rollfix/files.hpp"
#include "text/text.hpp"

namespace rollfix {
namespace {

struct CauseText {
  Cause cause;
  const char* name;  // in JSON
  const char* what;
  const char* cure;
};

// What is wrong, and what to give instead: options that can be typed as they stand, or a sentence without any. Where
// numbers belong in them they are put together below.
constexpr std::array<CauseText, 24> kCauses = {{
    {Cause::none, "none", "", ""},
    {Cause::unsaid_noise, "unsaid_noise",
     "the rows jitter by more than their digits say, but no noise was stated; slip and a wrong radius may add to it",
     ""},
    {Cause::noise, "noise", "", ""},
    {Cause::correlation, "correlation",
     "the errors of rows are not independent: neighbours are alike, as with a sensor that drifts, wobbles or "
     "repeats its digits, or with a part that moved a little",
     "state over what length of roll neighbouring errors are alike: the noise's correlation, a length"},
    {Cause::prior, "prior", "what --prior, --heading or --pose says contradicts the rows", "leave it out"},
    {Cause::radius, "radius", "", ""},
    {Cause::u_degrees, "u_degrees", "u is in degrees", "--columns u=u:deg"},
    {Cause::psi_degrees, "psi_degrees", "psi is in degrees", "--columns psi=psi:deg"},
    {Cause::angles_degrees, "angles_degrees", "u and psi are in degrees", "--columns u=u:deg,psi=psi:deg"},
    {Cause::turn_degrees, "turn_degrees", "turns are in degrees", "give turns with their unit, as in 73deg"},
    {Cause::u_radians, "u_radians", "u is in radians", "--columns u=u:rad"},
    {Cause::psi_radians, "psi_radians", "psi is in radians", "--columns psi=psi:rad"},
    {Cause::angles_radians, "angles_radians", "u and psi are in radians", "--columns u=u:rad,psi=psi:rad"},
    {Cause::turn_radians, "turn_radians", "turns are in radians", "--columns turn=turn:rad"},
    {Cause::u_clockwise, "u_clockwise", "u is counted clockwise", "counter-clockwise angles: change the sign of u"},
    {Cause::psi_clockwise, "psi_clockwise", "psi is counted clockwise",
     "counter-clockwise angles: change the sign of psi"},
    {Cause::u_psi_swapped, "u_psi_swapped", "u and psi are exchanged", "--columns u=psi,psi=u"},
    {Cause::fingers_swapped, "fingers_swapped", "the two fingers are exchanged: their logs, or their radii", ""},
    {Cause::gyroscope, "gyroscope", "", ""},
    {Cause::both_clockwise, "both_clockwise", "the part lies face down, or all angles are counted clockwise",
     "--mirror"},
    {Cause::length_backwards, "length_backwards", "lengths are counted against the outline's direction",
     "--direction either"},
    {Cause::turn_clockwise, "turn_clockwise", "turns are counted clockwise",
     "counter-clockwise angles: change the sign of the turn"},
    {Cause::stray, "stray", "", "--robust"},
    {Cause::slip, "slip", "lengths are wrong here and there: probably the finger slipped", ""},
}};
constexpr CauseText kAnotherPart = {Cause::part, "part",
                                    "neither other lengths, signs or units nor slip explain the rows: probably it is "
                                    "another part, another finger, or another side of the part",
                                    "check the part and the finger"};

const CauseText& text_of(Cause cause) {
  const auto* const found =
      std::find_if(kCauses.begin(), kCauses.end(), [&](const CauseText& one) { return one.cause == cause; });
  return found == kCauses.end() ? kAnotherPart : *found;
}

/// A mistake in units that a factor of lengths is known by.
struct KnownScale {
  double scale;
  const char* what;
};
constexpr std::array<KnownScale, 14> kKnownScales = {{{0.5, "a diameter was given for the radius"},
                                                      {2, "the radius was halved, as if it were a diameter"},
                                                      {10, "centimetres were taken for millimetres"},
                                                      {0.1, "millimetres were taken for centimetres"},
                                                      {1000, "metres were taken for millimetres"},
                                                      {0.001, "millimetres were taken for metres"},
                                                      {100, "metres were taken for centimetres"},
                                                      {0.01, "centimetres were taken for metres"},
                                                      {25.4, "inches were taken for millimetres"},
                                                      {1 / 25.4, "millimetres were taken for inches"},
                                                      {2.54, "inches were taken for centimetres"},
                                                      {1 / 2.54, "centimetres were taken for inches"},
                                                      {39.37007874, "metres were taken for inches"},
                                                      {0.0254, "inches were taken for metres"}}};
// A scale is taken for a known one where it is within these many standard deviations of it, and within this share.
constexpr double kKnownSigmas = 4;
constexpr double kKnownShare = 0.02;

std::string known_scale(const Diagnosis& diagnosis) {
  for (const KnownScale& known : kKnownScales) {
    const double off = std::abs(diagnosis.length_scale - known.scale);
    if (off <= std::max(kKnownSigmas * diagnosis.length_scale_sd, 1e-3 * known.scale) &&
        off <= kKnownShare * known.scale) {
      return known.what;
    }
  }
  return "";
}

/// As it was typed, whatever its digits.
std::string finger_option(const Finger& finger) {
  if (!finger.is_disk()) return "--finger " + quoted_for_shell(finger.name());
  return fmt::format("--finger disk,r={}", finger.disk()->radius);
}

/// What is to be given, without the noise that it is to be given with.
std::string cure_alone(const Diagnosis& diagnosis, const std::vector<Finger>& fingers, const Noise& noise) {
  if (diagnosis.cause == Cause::unsaid_noise) return noise_option(diagnosis.noise);
  if (diagnosis.cause == Cause::slip || diagnosis.cause == Cause::gyroscope) {
    Noise more = noise;
    if (diagnosis.cause == Cause::slip) more.slip = diagnosis.slip;
    if (diagnosis.cause == Cause::gyroscope) more.gyro = diagnosis.gyro;
    return noise_option(more);
  }
  if (!diagnosis.columns.empty()) return "--columns " + written(diagnosis.columns);
  if (diagnosis.cause == Cause::fingers_swapped) {
    if (fingers.size() != 2) return "give both in the other order";
    return fmt::format("{} {}", finger_option(fingers[1]), finger_option(fingers[0]));
  }
  if (diagnosis.cause == Cause::noise) return noise_option(with_rows_as_noisy(noise, diagnosis.noise_scale));
  if (diagnosis.cause == Cause::radius) {
    const bool of_disks = !fingers.empty() && std::all_of(fingers.begin(), fingers.end(),
                                                          [](const Finger& finger) { return finger.is_disk(); });
    if (!of_disks) return fmt::format("lengths that are {:.5g} times as long", diagnosis.length_scale);
    std::vector<std::string> options;
    const std::size_t count = diagnosis.finger ? 2 : fingers.size();  // one may serve for both
    for (std::size_t k = 0; k < count; ++k) {
      const Finger& finger = *finger_of(fingers, k);
      const bool is_off = diagnosis.finger.value_or(k) == k;
      options.push_back(is_off ? fmt::format("--finger disk,r={:.5g}", diagnosis.length_scale * finger.disk()->radius)
                               : finger_option(finger));
    }
    return fmt::format("{}", fmt::join(options, " "));
  }
  return text_of(diagnosis.cause).cure;
}

bool is_any(const Noise& noise) { return noise.contact > 0 || noise.angle > 0; }

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

/// The first finger that it is about, as it is and as it would be.
std::string radius_words(const HoldDiagnosis& diagnosis, const HoldAnswer& answer) {
  const std::size_t finger = diagnosis.finger.value_or(0);
  const double said = answer.rolls[finger].radius;
  return fmt::format("the radius of {} is {:.4g} ± {:.1g} instead of {:.4g}",
                     diagnosis.finger ? named(finger, answer) : "the fingers", diagnosis.factor * said,
                     diagnosis.factor_sd * said, said);
}

std::string counted_rows(int rows) { return fmt::format("{} {}", rows, rows == 1 ? "row" : "rows"); }

/// Without normals a mirror image does not say how it came about.
std::string mirror_words(const TouchAnswer& answer) {
  const bool any_normal = std::any_of(answer.touches.begin(), answer.touches.end(),
                                      [](const MeasuredTouch& touch) { return touch.normal.has_value(); });
  const char* const also = any_normal ? "" : "; or x and y are swapped, or one of them has the wrong sign";
  return std::string(answer.mirrored ? "the part does not lie face down: leave --mirror out"
                                     : "the part lies face down: add --mirror") +
         also;
}

}  // namespace

/// As it is typed.
std::string noise_option(const Noise& noise) {
  std::vector<std::string> fields;
  for (const NoiseKind& kind : kNoiseKinds) {
    const double sd = noise.*kind.sd;
    if (sd <= 0) continue;
    const bool is_angle = kind.unit == NoiseKind::Unit::angle;
    fields.push_back(is_angle ? fmt::format("{}={:.3g}deg", kind.name, sd * 180 / std::numbers::pi)
                              : fmt::format("{}={:.3g}", kind.name, sd));
  }
  return fmt::format("--noise {}", fmt::join(fields, ","));
}

const char* name_of(Cause cause) { return text_of(cause).name; }

std::string about(const Diagnosis& diagnosis) {
  switch (diagnosis.cause) {
    case Cause::noise:
      return fmt::format("the rows are {:.3g} times as noisy as said", diagnosis.noise_scale);
    case Cause::radius: {
      const std::string known = known_scale(diagnosis);
      constexpr double kExact = 5e-6;  // of the scale: what its digits don't show
      const std::string whose =
          diagnosis.finger ? fmt::format(" of finger {}", *diagnosis.finger == 0 ? 'a' : 'b') : "";
      const bool is_exact = !(diagnosis.length_scale_sd > kExact * diagnosis.length_scale);
      const std::string scale =
          fmt::format("all lengths{} are {:.5g}{} times what was measured", whose, diagnosis.length_scale,
                      is_exact ? "" : fmt::format(" ± {:.2g}", diagnosis.length_scale_sd));
      if (diagnosis.finger) return scale + ": a wrong radius of that finger";
      return scale + (known.empty() ? ": a wrong radius of the finger, or a wrong unit" : ": " + known);
    }
    case Cause::gyroscope:
      return fmt::format("all turns are {:.4f} ± {:.2g} times what was measured: a gyroscope's scale",
                         diagnosis.turn_scale, diagnosis.turn_scale_sd);
    case Cause::stray:
      return fmt::format("{} {}", counted(diagnosis.stray, "row is an", "rows are"),
                         diagnosis.stray == 1 ? "outlier" : "outliers");
    default:
      return text_of(diagnosis.cause).what;
  }
}

std::string cure_of(const Diagnosis& diagnosis, const std::vector<Finger>& fingers, const Noise& said) {
  const std::string cure = cure_alone(diagnosis, fingers, is_any(said) ? said : diagnosis.noise);
  const bool is_all =
      is_any(said) || !is_any(diagnosis.noise) || !cure.starts_with("--") || cure.find("--noise") != std::string::npos;
  return is_all ? cure : fmt::format("{} {}", cure, noise_option(diagnosis.noise));
}

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

std::string words_of(const TouchDiagnosis& diagnosis, const TouchAnswer& answer) {
  switch (diagnosis.cause) {
    case TouchCause::unit:
      return fmt::format("the touches are in {}, the part in {}: multiply x and y by {:.6g}", diagnosis.unit,
                         diagnosis.into, diagnosis.factor);
    case TouchCause::outlier:
      return fmt::format("touch {} is wrong: without it the others fit", diagnosis.touch + 1);
    case TouchCause::radius:
      if (diagnosis.radius == 0) return "x and y are of the contacts, not of the finger's centre: leave --finger out";
      if (answer.radius == 0) {
        return fmt::format("the touches are a finger's centres: add --finger disk,r={:.4g}", diagnosis.radius);
      }
      return fmt::format("the finger's radius is {:.4g}, not {:.6g}", diagnosis.radius, answer.radius);
    case TouchCause::normals_reversed:
      return "normals point into the part; expected out of it: add 180deg to each";
    case TouchCause::normals_clockwise:
      return "normals are counted clockwise; expected counter-clockwise: change their signs";
    case TouchCause::mirrored:
      return mirror_words(answer);
    case TouchCause::swapped:
      return "x and y are swapped; expected x first";
    case TouchCause::other_side:
      return "the outline is touched on its left side; expected on its right: reverse its points";
    case TouchCause::clear:
      return "the part is in the way of a path that is said to be clear: check --clear";
    case TouchCause::pose:
      if (diagnosis.poses == 0) return "the touch contradicts --pose";
      return fmt::format("the touches contradict {}: without it the heading is {} deg",
                         answer.pose && std::isfinite(answer.pose->place_sd) ? "--pose" : "--heading",
                         fixed(diagnosis.pose.heading / kDegree, 3));
    case TouchCause::moved:
      return fmt::format("the part was moved between roll {} and roll {}: before and after it each fits by itself",
                         diagnosis.roll + 1, diagnosis.roll + 2);
    case TouchCause::noise:
      break;
  }
  return fmt::format("the measurements are {:.2g} times as noisy as stated", diagnosis.factor);
}

std::vector<std::string> notes_of(const Answer& answer) {
  std::vector<std::string> notes;
  if (const std::size_t count = answer.corner_rows.count; count > 0) {
    notes.push_back(fmt::format(
        "{} on a corner of the finger, where u does not tell how its normal is turned: {}",
        count == 1 ? "1 row is" : fmt::format("{} rows are", count),
        answer.weighing ? "they are not weighed" : "there the turn is open, between the others it is exact"));
  }
  if (!answer.other_way.empty()) notes.push_back("the other way round no such roll can be: " + answer.other_way);
  if (answer.lengths_reversed) notes.emplace_back("the log's lengths changed their signs to match");
  return notes;
}

}  // namespace rollfix
