#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "outline/turn.hpp"
#include "rollfix/output/answer_output.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

/// In degrees per hour, as data sheets have it.
std::string bias_text(const Fit& fit) {
  constexpr double kDegreesPerHour = 3600 * 180 / std::numbers::pi;
  return fmt::format("{:.4g} ± {:.2g} deg/h: the rate of the gyroscope at rest", fit.turn_bias * kDegreesPerHour,
                     fit.turn_bias_sd * kDegreesPerHour);
}

}  // namespace

std::string scale_text(double scale, double sd, const char* more, const char* less) {
  std::string text = fmt::format("scale {:.4f} ± {:.2g} (1 = as measured)", scale, sd);
  const double off = 100 * (scale - 1);
  if (std::abs(scale - 1) > 2 * sd) text += fmt::format(": they are {:.2g} % {}", std::abs(off), off > 0 ? more : less);
  return text;
}

std::string scale_lines(const Fit& fit, std::size_t fingers) {
  std::string text;
  for (std::size_t finger = 0; finger < fingers; ++finger) {
    const double sd = fit.length_scale_sd[finger];
    if (!(sd > 0)) continue;
    const char* whose = fingers == 1 ? "" : finger == 0 ? "of finger a " : "of finger b ";
    text += fmt::format("lengths    {}{}\n", whose, scale_text(fit.length_scale[finger], sd, "longer", "shorter"));
  }
  if (const double sd = fit.turn_scale_sd; sd > 0) {
    text += fmt::format("turns      {}\n", scale_text(fit.turn_scale, sd, "larger", "smaller"));
  }
  if (fit.turn_bias_sd > 0) text += fmt::format("bias       {}\n", bias_text(fit));
  return text;
}

namespace {

class AskedText : AnswerWords {
 public:
  AskedText(const Answer& answer, bool verbose) : AnswerWords(answer), verbose_(verbose) {}

  std::string text() const {
    const Part& part = answer_.part;
    return fmt::format("part       {}, {}, perimeter {}\n", plain(part.name()), part.closed() ? "closed" : "open",
                       at(part.perimeter())) +
           accuracy_line() + reading_lines() + direction_line() + tolerance_line() +
           (answer_.weighing ? weighing_lines() : "");
  }

 private:
  std::string accuracy_line() const {
    const Accuracy& accuracy = answer_.part.outline().accuracy;
    return accuracy.is_exact() ? "" : fmt::format("accuracy   of the taught part: {}\n", accuracy_text(accuracy));
  }

  std::string reading_lines() const {
    std::string text;
    for (std::size_t i = 0; i < answer_.readings.size(); ++i) {
      const Reading& reading = answer_.readings[i];
      const std::string lengths =
          fingers_ == 1 ? "length " + at(reading.length[0])
                        : fmt::format("lengths {} and {}", place(reading.length[0]), at(reading.length[1]));
      const std::string when = answer_.times.empty() ? "" : fmt::format(" at {:.6g} s", answer_.times[i]);
      const std::string turn = reading.is_exact() ? degrees(reading.turn) + " deg"
                                                  : fmt::format("anywhere from {} to {} deg, on a corner of the finger",
                                                                degrees(reading.turn - reading.pivot),
                                                                degrees(reading.turn + reading.pivot));
      text += fmt::format("reading    {}, turn {}{}\n", lengths, turn, when);
    }
    if (answer_.facing) text += fmt::format("facing     {} deg\n", degrees(*answer_.facing));
    return text;
  }

  /// Where either way round was tried: what each has.
  std::string direction_line() const {
    if (!answer_.either_way) return "";
    double probability = 0;
    std::size_t count = 0;
    for (const Placement& placement : answer_.placements) {
      if (!placement.clockwise) continue;
      probability += placement.probability;
      ++count;
    }
    const auto placements = [](std::size_t n) { return counted(n, "placement", "placements"); };
    if (!answer_.weighing) {
      return fmt::format("direction  either: {} with lengths counted ccw, {} with lengths counted cw\n",
                         placements(answer_.placements.size() - count), placements(count));
    }
    return fmt::format("direction  either: lengths counted cw with probability {:.4f}\n", probability);
  }

  std::string tolerance_line() const {
    constexpr std::array<const char*, 6> kSources = {
        "default",  "from the digits given", "from the noise",
        "as given", "the least there is",    "from the accuracy of the taught part"};
    const Tolerance& tolerance = answer_.tolerance;
    return fmt::format("tolerance  {:.3g} deg = {:.3g} rad, {}\n", tolerance.value / kDegree, tolerance.value,
                       kSources[static_cast<std::size_t>(tolerance.source)]);
  }

  /// "noise      contact 0.1, ..." and what the samples are like.
  std::string weighing_lines() const {
    const Weighing& weighing = *answer_.weighing;
    std::string text =
        fmt::format("noise      {}{}\n", noise_words(weighing.noise, unit_), weighing.robust ? "; robust" : "");
    if (weighing.prior) {
      text += fmt::format("prior      s = {:.6g}, sd {:.4g}{}\n", weighing.prior->s, weighing.prior->sd, unit_);
    }
    if (weighing.pose) text += "prior      " + prior_text(*weighing.pose) + '\n';
    text += what_rows_say();
    text += fmt::format("samples    {}", weighing.samples);
    if (weighing.fit.excess > 1)
      text += fmt::format("; residuals {:.2f} times the noise, the answer is widened by that", weighing.fit.excess);
    text += '\n' + caution_lines(weighing.fit);
    if (answer_.dropped.improbable > 0) {
      text += fmt::format("rejected   {} the readings above, but not the whole log\n",
                          counted(answer_.dropped.improbable, "candidate that fits", "candidates that fit"));
    }
    return text;
  }

  /// Rows that fit far too well, and turns whose errors add up to more than they tell.
  static std::string caution_lines(const Fit& fit) {
    std::string text;
    if (fit.turn_gathered > Fit::kMostGathered) {
      text = fmt::format(
          "caution    the errors of the turns add up to {:.3g} deg on the way, more than turns can say of the part;\n"
          "           in a log of increments `angle` is the error of each row; `drift` and `walk` gather with time\n",
          fit.turn_gathered / kDegree);
    }
    if (!fit.is_too_good()) return text;
    text += fmt::format("caution    the residuals are only {:.2g} times the stated noise: it is too large, ",
                        std::sqrt(fit.chi_square / fit.freedom));
    text += "and the answer is wider than necessary";
    if (fit.alike_over > 0) {
      text += fmt::format(
          ";\n           or neighbouring errors are alike, and the answer is too sure: then --noise correlation={:.2g}",
          fit.alike_over);
    }
    return text + '\n';
  }

  std::string prior_text(const PosePrior& prior) const {
    const std::string heading =
        fmt::format("heading {} deg, sd {} deg", degrees(prior.mean.heading), rough(prior.heading_sd / kDegree));
    if (!std::isfinite(prior.place_sd)) return "the part's " + heading;
    return fmt::format("the part at x = {:.6g}, y = {:.6g}, sd {:.4g}{}, {}", prior.mean.x, prior.mean.y,
                       prior.place_sd, unit_, heading);
  }

  /// What the rows say of the lengths and of a gyroscope, and what was taken as exact.
  std::string what_rows_say() const {
    const Weighing& weighing = *answer_.weighing;
    std::string text = scale_lines(weighing.fit, fingers_);
    std::vector<std::string> exact;
    if (weighing.noise.slip <= 0) exact.emplace_back("no slip");
    if (weighing.noise.radius <= 0 && !answer_.fingers.empty() && answer_.fingers.front().is_disk()) {
      exact.emplace_back("the finger's radius is exact");
    }
    if (!exact.empty()) text += fmt::format("assumed    {}; if not, say it in --noise\n", fmt::join(exact, ", "));
    if (verbose_ && weighing.noise.position <= 0 && !answer_.placements.empty() &&
        answer_.placements.front().pose_spread) {
      text += "centres    x, y: used for the pose only; --noise position=SD uses them as measurements\n";
    }
    return text;
  }

  bool verbose_;
};

}  // namespace

std::string noise_words(const Noise& noise, const std::string& unit) {
  std::vector<std::string> words;
  for (const NoiseKind& kind : kNoiseKinds) {
    const double sd = noise.*kind.sd;
    if (sd == 0) continue;
    const bool is_of_gyroscope = kind.unit == NoiseKind::Unit::rate || kind.unit == NoiseKind::Unit::walk;
    if (is_of_gyroscope) {
      const bool is_rate = kind.unit == NoiseKind::Unit::rate;
      words.push_back(fmt::format("{} {:.4g} {}", kind.name, sd / kDegree * (is_rate ? 3600 : 60),
                                  is_rate ? "deg/h" : "deg/sqrt(h)"));
      continue;
    }
    const std::string& suffix = kind.unit == NoiseKind::Unit::length ? unit : "";
    words.push_back(kind.unit == NoiseKind::Unit::angle ? fmt::format("{} {} deg", kind.name, degrees(sd))
                                                        : fmt::format("{} {:.4g}{}", kind.name, sd, suffix));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string asked_lines(const Answer& answer, bool verbose) { return AskedText(answer, verbose).text(); }

std::string accuracy_text(const Accuracy& accuracy) {
  constexpr double kExact = 1e-8;  // radians, or a share: rounding
  std::vector<std::string> sds;
  if (accuracy.turn > kExact) {
    sds.push_back(fmt::format("tangents sd {:.3g} deg (alike over {:.3g})", accuracy.turn / kDegree, accuracy.alike));
  }
  if (accuracy.walk > 0) {
    sds.push_back(fmt::format("turns sd {:.3g} deg per square root of length", accuracy.walk / kDegree));
  }
  if (accuracy.length > kExact) sds.push_back(fmt::format("lengths sd {:.3g} %", 100 * accuracy.length));
  if (sds.empty()) return "that of exact rows: off by rounding alone";
  return fmt::format("{}", fmt::join(sds, ", "));
}

}  // namespace rollfix::app
