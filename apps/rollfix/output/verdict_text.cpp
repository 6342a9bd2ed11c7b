#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rollfix/inspect.hpp"
#include "rollfix/output/answer_output.hpp"
#include "rollfix/solve.hpp"

namespace rollfix::app {
namespace {

constexpr double kSurely = 3;         // standard deviations within which two lengths are taken as equal
constexpr double kSameLength = 1e-9;  // of the perimeter: lengths that differ by less are equal

class VerdictText : AnswerWords {
 public:
  explicit VerdictText(const Answer& answer) : AnswerWords(answer) {}

  std::string text() const { return advice() + "\n" + diagnosis_lines(); }

 private:
  std::string advice() const {
    const std::string verdict = answer_.verdict.text();
    if (answer_.weighing && answer_.verdict.name == Verdict::undecided) {
      return verdict +
             ": the rows could be held against no place closely enough, and none is excluded; roll less far, "
             "or say that the errors are larger";
    }
    if (answer_.weighing && (answer_.status == Status::complete || fingers_ == 2)) return verdict + weighed_advice();
    if (answer_.status == Status::incomplete) {
      return fmt::format("undecided: {} found, {} left open; try a larger --budget",
                         fingers_ == 1 ? counted(answer_.placements.size(), "placement", "placements")
                                       : counted(answer_.placements.size(), "pair", "pairs"),
                         fingers_ == 1 ? counted(answer_.unresolved.size(), "interval", "intervals")
                                       : counted(answer_.unresolved.size(), "box", "boxes"));
    }
    return verdict + searched_advice();
  }

  std::string searched_advice() const {
    const auto contradicted =
        static_cast<std::size_t>(std::count_if(answer_.placements.begin(), answer_.placements.end(),
                                               [](const Placement& placement) { return placement.is_contradicted; }));
    if (contradicted > 0) return advice_on_contradicted(contradicted);
    if (answer_.placements.empty() && answer_.dropped.overlap > 0) {
      return fmt::format(
          ": {} would fit, but the fingers would overlap; of fingers at different heights say --may-overlap",
          counted(answer_.impossible.size(), "placement", "placements"));
    }
    if (answer_.placements.empty() && !answer_.impossible.empty()) {
      return fmt::format(": {} would fit, but the finger can't get there; check the finger's size, or see --explain",
                         counted(answer_.impossible.size(), "placement", "placements"));
    }
    if (answer_.placements.empty() && !answer_.diagnoses.empty()) return ": nothing fits";
    if (answer_.placements.empty()) {
      return fmt::format(": nothing fits; check the units, the signs (positive along the outline), and the {}",
                         fingers_ == 1 ? "finger's radius" : "fingers' radii");
    }
    if (answer_.verdict.name == Verdict::unobservable && fingers_ == 2) {
      return all_the_way_round();
    }
    if (answer_.placements.size() > 1) return ": roll on to tell them apart";
    return advice_on_one(answer_.placements.front());
  }

  /// Without noise, where rows that were not searched with, or centres, don't go with some of what was found.
  std::string advice_on_contradicted(std::size_t count) const {
    constexpr const char* kBy = "contradicted by other rows of the log or by the contacts in the world";
    const std::size_t left = answer_.placements.size() - count;
    if (left > 0) {
      return fmt::format("{}; {} more that the readings allow {} {}, and {} last",
                         left == 1 ? advice_on_one(answer_.placements.front()) : "", count, count == 1 ? "is" : "are",
                         kBy, count == 1 ? "comes" : "come");
    }
    return fmt::format(": {} {}",
                       count == 1 ? "the place that the readings allow is" : "all that the readings allow are", kBy);
  }

  /// Whether it is the part's shape, or the roll's, that lets every place fit, and not the tolerance: the part looks
  /// the same all round, or the roll told nothing: none at all, or of two fingers equal ones under a part that did not
  /// turn.
  bool looks_the_same() const {
    const auto is_whole = [](const Placement& placement) {
      return placement.kind == Kind::stretch &&
             std::any_of(placement.whole_loop.begin(), placement.whole_loop.end(), [](bool b) { return b; });
    };
    if (!answer_.weighing) return std::any_of(answer_.placements.begin(), answer_.placements.end(), is_whole);
    if (symmetry(answer_.part) == 0) return true;
    const Noise& noise = answer_.weighing->noise;
    const double most_length = std::max(kSameLength * answer_.part.perimeter(), kSurely * noise.contact);
    return std::all_of(answer_.readings.begin(), answer_.readings.end(), [&](const Reading& reading) {
      const double length = fingers_ == 1 ? reading.length[0] : reading.length[0] - reading.length[1];
      return std::abs(length) <= most_length && std::abs(reading.turn) <= answer_.tolerance.value;
    });
  }
  std::string all_the_way_round() const {
    if (looks_the_same()) {
      return ": pairs all the way round the boundary fit; no such roll, however long, can tell them apart";
    }
    return fmt::format(": within the {} pairs all the way round the boundary fit; roll further, or {}",
                       answer_.weighing ? "noise" : "tolerance",
                       answer_.weighing ? "measure better" : "give more digits");
  }

  std::string advice_on_one(const Placement& only) const {
    if (fingers_ == 2) {
      if (answer_.verdict.name != Verdict::unique) return ": roll on to tell them apart";
      return fmt::format(": finger a started at s = {}, finger b at {}{}", at(only.start[0]), at(only.start[1]),
                         way_of(only));
    }
    if (only.kind == Kind::stretch) {
      return only.whole_loop[0] ? ": this roll looks the same from every place on the boundary"
                                : ": roll on, to where the curvature changes";
    }
    if (only.whole_loop[0]) return ": within the tolerance every place fits; give more digits, or roll further";
    const std::string lo = place(only.extent[0].lo);
    const std::string hi = place(only.extent[0].hi);
    if (lo == hi) return fmt::format(": the finger started at s = {}{}", at(only.start[0]), way_of(only));
    return fmt::format(": the finger started between s = {} and {}{}{}", lo, hi, unit_, way_of(only));
  }

  /// A log of lengths and turns for which no finger was given is a wheel's with a gyroscope.
  bool is_wheel() const { return answer_.fingers.empty() && answer_.weighing->samples > answer_.readings.size(); }

  std::string weighed_advice() const {
    if (answer_.verdict.name == Verdict::inconsistent && !answer_.diagnoses.empty()) return ": nothing fits";
    if (answer_.placements.empty()) return ": nothing that fits is within the finger's reach";
    const Placement& first = answer_.placements.front();
    const Verdict& verdict = answer_.verdict;
    if (is_doubted() && verdict.name != Verdict::unobservable) {
      return fmt::format(": if all is as stated, the {} {}, but what follows is likelier",
                         verdict.name != Verdict::unique ? "likeliest start is"
                         : fingers_ == 1                 ? "finger started at"
                                                         : "roll started with",
                         where(first));
    }
    if (verdict.name == Verdict::unique) {
      return (fingers_ == 1 ? fmt::format(": the {} started at ", is_wheel() ? "wheel" : "finger")
                            : ": the roll started with ") +
             where(first);
    }
    if (verdict.name == Verdict::unobservable) {
      if (fingers_ == 2) return all_the_way_round();
      return looks_the_same() ? ": this roll looks the same from every place on the boundary"
                              : ": within the noise every place fits; roll further, or measure better";
    }
    if (fingers_ == 1 && (answer_.placements.size() == 1 || verdict.stretches > 0)) {
      return fmt::format(": the finger started between s = {} and {} with 95 %; roll on to know it better",
                         place(first.interval[0].lo), at(answer_.part.boundary().on_first_lap(first.interval[0].hi)));
    }
    return fmt::format(": the likeliest start is {}, with probability {:.2f}; roll on to tell them apart", where(first),
                       first.probability);
  }

  /// Whether something else explains the rows better than what was said of them.
  bool is_doubted() const {
    double total = 0;
    for (const Placement& placement : answer_.placements) total += placement.probability;
    constexpr double kDoubtful = 0.25;  // what is said is not more than a third as likely as what else there is
    return !answer_.diagnoses.empty() && total < kDoubtful;
  }

  /// What may be wrong, with the option that mends it and the answer then.
  std::string diagnosis_lines() const {
    std::string text;
    for (const Diagnosis& diagnosis : answer_.diagnoses) {
      const bool is_first = text.empty();
      text += fmt::format("{} {}\n  {}{}\n", is_first ? "likeliest:" : "or:       ", about(diagnosis),
                          cure_of(diagnosis, answer_.fingers, answer_.weighing ? answer_.weighing->noise : Noise{}),
                          then(diagnosis));
    }
    return text;
  }
  std::string then(const Diagnosis& diagnosis) const {
    if (diagnosis.modes.empty()) return "";
    // A cure that is not enough: its best place is none.
    if (diagnosis.verdict.name == Verdict::inconsistent) return "; even then nothing fits";
    const Mode& first = diagnosis.modes.front();
    const std::string start = fingers_ == 1
                                  ? fmt::format("s = {:.6g}, sd {:.2g}", first.start[0], first.sd[0])
                                  : fmt::format("a at s = {:.6g}, b at {:.6g}", first.start[0], first.start[1]);
    return fmt::format("; then {}: {}", diagnosis.verdict.text(), start);
  }
};

}  // namespace

std::string verdict_lines(const Answer& answer) { return VerdictText(answer).text(); }

}  // namespace rollfix::app
