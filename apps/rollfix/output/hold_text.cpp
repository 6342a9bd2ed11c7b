#include "rollfix/output/answer_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "outline/turn.hpp"
#include "rollfix/files.hpp"
#include "rollfix/inspect.hpp"
#include "rollfix/output/table.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

constexpr double kExactHold = 1e-6;  // of the tolerance: rounding

char letter(std::size_t finger) { return static_cast<char>('a' + finger); }

class HoldText {
 public:
  explicit HoldText(const HoldAnswer& answer)
      : answer_(answer), decimals_(decimals_for(answer.part.perimeter())), unit_(answer.part.unit()) {}

  std::string text() const {
    std::string text = answer_.verdict_text() + first_line() + "\n" + advice() + diagnosis_lines();
    if (!answer_.placements.empty()) text += "\n" + starts_table() + "\n" + pose_lines();
    return text + "\n" + fingers_table() + "\n" + unresolved_lines() + asked_lines();
  }

 private:
  std::string place(double value) const { return fixed(value, decimals_); }

  /// "finger a", "wheel b".
  std::string name(std::size_t k) const {
    return fmt::format("{} {}", answer_.rolls[k].is_wheel ? "wheel" : "finger", letter(k));
  }

  std::size_t wheels() const {
    return static_cast<std::size_t>(
        std::count_if(answer_.rolls.begin(), answer_.rolls.end(), [](const HoldRoll& roll) { return roll.is_wheel; }));
  }

  /// ": finger a started at s = 1, finger b at 2, finger c at 3".
  std::string first_line() const {
    if (answer_.verdict.name != Verdict::unique) return "";
    std::string text;
    const std::vector<HoldContact>& contacts = answer_.placements.front().contacts;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      text += fmt::format("{}{} {}{:.6g}{}", k == 0 ? ": " : ", ", name(k), k == 0 ? "started at s = " : "at ",
                          contacts[k].start, answer_.noise ? fmt::format(", sd {:.2g}", contacts[k].sd) : "");
    }
    return text + behind(unit_);
  }

  std::string advice() const {
    switch (answer_.verdict.name) {
      case Verdict::unique:
        return "";
      case Verdict::ambiguous:
        return answer_.verdict.stretches > 0
                   ? "the fingers leave some first contacts free to slide: roll over a bend or a corner\n"
                   : "next: roll on to tell them apart\n";
      case Verdict::unobservable:
        return symmetry(answer_.part) == 0 ? "the part looks the same in every heading\n"
                                           : "all the way round fits: roll over stretches that are bent otherwise\n";
      case Verdict::undecided:
        return "not decided: longer rolls, or a larger --budget, leave less to look at\n";
      case Verdict::inconsistent:
        break;
    }
    if (!answer_.diagnoses.empty()) return "no places on the part fit all fingers\n";
    if (answer_.overlap > 0) {
      return "no places on the part fit all fingers unless they enter each other: check the radii, or if the fingers "
             "are at different heights add --may-overlap\n";
    }
    return std::string("no places on the part fit all fingers: ") +
           (answer_.noise ? "" : "without --noise all digits are taken as exact; if they are not, add it; ") +
           "check the units and signs of u and psi, whether they are wrapped (--wrapped), that --log and --finger are "
           "in the same order, and " +
           (wheels() > 0
                ? "that x and y of all logs are in one frame, of a wheel its pin, of a jaw its frame's origin, where "
                  "u is 0\n"
                : "locate two of the logs at a time\n");
  }

  /// What is wrong, what to do, and what fits then.
  std::string diagnosis_lines() const {
    if (!answer_.was_diagnosed) return "";
    std::string text;
    for (const HoldDiagnosis& one : answer_.diagnoses) {
      std::string then = one.verdict.text();
      if (one.verdict.name == Verdict::unique) {
        for (std::size_t k = 0; k < one.placements.front().contacts.size(); ++k) {
          then += fmt::format("{}{} at {:.6g}", k == 0 ? ", finger " : ", ", letter(k),
                              one.placements.front().contacts[k].start);
        }
      }
      const bool is_for_all = one.fit.is_bad();
      text += fmt::format("possible cause: {}; cure: {}; then {}{}\n", words_of(one, answer_), cure_of(one, answer_),
                          then, is_for_all ? ", still not as good as the noise says" : "");
    }
    if (text.empty() && answer_.overlap == 0) {
      text = "no usual mistake explains it: check the part, its side, and each finger\n";
    }
    return text;
  }

  std::string starts_table() const {
    Table table;
    table.add_column("", Table::Align::left);
    if (answer_.noise) table.add_column("probability");
    for (std::size_t k = 0; k < answer_.rolls.size(); ++k) {
      table.add_column(title_in(fmt::format("start {}", letter(k)), unit_));
      if (answer_.noise) table.add_column(fmt::format("sd {}", letter(k)));
    }
    if (!answer_.noise) table.add_column("worst residual");
    for (std::size_t i = 0; i < std::min(answer_.placements.size(), kMostRows); ++i) {
      const HoldPlacement& one = answer_.placements[i];
      std::vector<std::string> cells{std::to_string(i)};
      if (answer_.noise) cells.push_back(fmt::format("{:.4f}", one.probability));
      for (const HoldContact& contact : one.contacts) {
        cells.push_back(place(contact.start));
        if (answer_.noise) cells.push_back(rough(contact.sd));
      }
      if (!answer_.noise) cells.push_back(residual(one));
      table.add_row(std::move(cells));
    }
    const std::size_t more = answer_.placements.size() - std::min(answer_.placements.size(), kMostRows);
    return table.str() + (more == 0 ? "" : fmt::format("... and {} more; --json lists them all\n", more));
  }

  /// Where places are measured a length, else an angle.
  std::string residual(const HoldPlacement& one) const {
    if (one.worst < kExactHold) return "0";
    if (answer_.place != PlaceKnown::measured) return rough(one.residual.turn / kDegree) + " deg";
    return rough(one.residual.length) + behind(unit_);
  }

  std::string about(const Pose& pose, const PoseSpread& spread) const {
    const auto with_sd = [&](const std::string& value, int k, double unit) {
      if (!answer_.noise || (k < 2 && answer_.place == PlaceKnown::reference)) return value;
      return fmt::format("{} ± {}", value, rough(std::sqrt(std::max(0.0, spread.covariance(k, k))) / unit));
    };
    std::string heading = "heading " + with_sd(degrees(pose.heading), 2, kDegree) + " deg";
    if (answer_.place == PlaceKnown::unknown) return heading;
    return fmt::format("x = {}, y = {}{}, {}", with_sd(place(pose.x), 0, 1), with_sd(place(pose.y), 1, 1),
                       behind(unit_), heading);
  }

  std::string pose_lines() const {
    std::string text;
    for (std::size_t i = 0; i < std::min(answer_.placements.size(), kMostNotes); ++i) {
      const HoldPlacement& one = answer_.placements[i];
      text += fmt::format("{}: at the first contacts the part was at {}; at the last at {}{}\n", i,
                          about(one.first, one.first_spread), about(one.last, one.last_spread),
                          one.continuum ? "; a continuum, of which the table shows one" : "");
    }
    if (answer_.place == PlaceKnown::unknown) {
      text += "where the part is is not known: the logs have no columns x and y, which tell it\n";
    } else if (answer_.place == PlaceKnown::reference) {
      text += "x and y only tell where the part is; add --noise position=SD to use them as measurements\n";
    }
    return text;
  }

  /// What each finger did, and where it is in the first placement.
  std::string fingers_table() const {
    Table table;
    table.add_column("", Table::Align::left);
    table.add_column("log", Table::Align::left);
    table.add_column(title_in("length", unit_));
    const bool has_any = !answer_.placements.empty();
    if (has_any) {
      for (const char* title : {"start in 0", "from", "to", "end in 0"}) {
        const std::string name = std::string(title) == "from" ? (answer_.noise ? "95 % from" : "all from") : title;
        table.add_column(title_in(name, unit_));
      }
    }
    for (std::size_t k = 0; k < answer_.rolls.size(); ++k) {
      const HoldRoll& roll = answer_.rolls[k];
      const std::string lines =
          roll.lines.empty() ? "" : fmt::format(", lines {} to {}", roll.lines.front(), roll.lines.back());
      std::vector<std::string> cells{name(k), plain(roll.name) + lines, roll.is_wheel ? "" : place(roll.length)};
      if (has_any) {
        const HoldContact& contact = answer_.placements.front().contacts[k];
        const Interval range = answer_.noise ? contact.interval : contact.extent;
        const Boundary boundary = answer_.part.boundary();
        const bool is_all = boundary.is_full(range);
        cells.push_back(place(contact.start));
        cells.push_back(place(range.lo));
        cells.push_back(place(is_all ? range.hi : boundary.on_first_lap(range.hi)));
        cells.push_back(place(contact.end));
      }
      table.add_row(std::move(cells));
    }
    return table.str();
  }

  std::string unresolved_lines() const {
    std::string text;
    for (std::size_t i = 0; i < std::min(answer_.unresolved.size(), kMostNotes); ++i) {
      text += "not decided:";
      for (std::size_t k = 0; k < answer_.unresolved[i].size(); ++k) {
        const Interval& arc = answer_.unresolved[i][k];
        text += fmt::format("{} {} at s from {} to {}", k == 0 ? "" : ",", name(k), place(arc.lo), place(arc.hi));
      }
      text += behind(unit_) + "\n";
    }
    if (answer_.unresolved.size() > kMostNotes) {
      text += fmt::format("... and {} more\n", answer_.unresolved.size() - kMostNotes);
    }
    return text;
  }

  std::string asked_lines() const {
    const Part& part = answer_.part;
    std::string text =
        fmt::format("part       {}, {}, perimeter {}{}{}\n", plain(part.name()), part.closed() ? "closed" : "open",
                    place(part.perimeter()), behind(unit_), answer_.mirrored ? ", face down" : "");
    text += fmt::format("fingers    {}{}, on a part that is free to move\n", answer_.rolls.size() - wheels(), beside());
    text += fmt::format("samples    {}{}\n", answer_.rows, answer_.noise ? "" : used_rows());
    if (answer_.noise) {
      text += fmt::format("noise      {}\n", noise_words(*answer_.noise, behind(unit_)));
    } else {
      const std::string centres = answer_.place == PlaceKnown::measured
                                      ? fmt::format("places {:.3g}{}, ", answer_.tolerance.length, behind(unit_))
                                      : "";
      text += fmt::format("tolerance  {}tangents {:.3g} deg\n", centres, answer_.tolerance.angle / kDegree);
    }
    if (answer_.fit && answer_.fit->freedom > 0) {
      text += fmt::format("fit        chi-square {:.4g} where {} is expected, p = {:.2g}\n", answer_.fit->chi_square,
                          answer_.fit->freedom, answer_.fit->p);
    }
    if (answer_.robust) {
      text += fmt::format("robust     {} of {} measurements do not count{}{}\n", answer_.strays,
                          answer_.rows * answer_.rolls.size(),
                          answer_.jumps.empty() ? "" : "; left out: ", fmt::join(answer_.jumps, "; "));
    }
    if (answer_.prior || answer_.pose) {
      text += fmt::format(
          "beforehand {}{}p = {:.2g}\n",
          answer_.prior ? fmt::format("finger a at {} ± {}, ", place(answer_.prior->s), rough(answer_.prior->sd)) : "",
          answer_.pose ? fmt::format("heading {} ± {} deg, ", degrees(answer_.pose->mean.heading),
                                     rough(answer_.pose->heading_sd / kDegree))
                       : "",
          answer_.prior_p);
    }
    if (answer_.overlap > 0) {
      text += fmt::format("dropped    {} in which fingers enter each other\n",
                          counted(answer_.overlap, "set of places", "sets of places"));
    }
    if (answer_.improbable > 0 && !answer_.placements.empty()) {
      text += fmt::format("rejected   {} that fit far worse, together less than {:.1g} % probable\n",
                          counted(answer_.improbable, "set of places", "sets of places"),
                          std::max(1e-4, 110 * answer_.rest));
    }
    return text;
  }

  /// " and a wheel without skin, with an encoder".
  std::string beside() const {
    if (wheels() == 0) return "";
    const auto encoders = static_cast<std::size_t>(std::count_if(
        answer_.rolls.begin(), answer_.rolls.end(), [](const HoldRoll& roll) { return roll.has_encoder; }));
    return fmt::format(" with skin and {} without{}{}", counted(wheels(), "wheel", "wheels"),
                       encoders == 0   ? ""
                       : encoders == 1 ? ", with an encoder"
                                       : ", with encoders",
                       answer_.squeezed
                           ? fmt::format(", squeezed: its normal points through the finger's contact, ± {:.3g} deg",
                                         *answer_.squeezed / kDegree)
                           : "");
  }

  std::string used_rows() const {
    return answer_.instants.size() == answer_.rows ? ""
                                                   : fmt::format(", of which {} are used", answer_.instants.size());
  }

  const HoldAnswer& answer_;
  int decimals_;
  std::string unit_;
};

}  // namespace

std::string hold_text(const HoldAnswer& answer) { return HoldText(answer).text(); }

}  // namespace rollfix::app
