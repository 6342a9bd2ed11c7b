#include "teach/felt_roll.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

#include "outline/turn.hpp"
#include "text/text.hpp"

namespace rollfix::teaching {
namespace {

/// Rows are noisier than was said when they are off by so many times as much.
constexpr double kNoisier = 1.25;
/// Of tangents, radians, and of lengths, a share: what is known better is exact for all that anyone sees.
constexpr double kExact = 1e-8;

/// Writes the notes of a taught part, for people to read.
class Notes {
 public:
  Notes(const FeltRoll& roll, Taught& taught) : roll_(roll), taught_(taught) {}

  /// All notes, in the order in which the work was done: the rows, their noise, the accuracy, the lap, how it is
  /// closed.
  void tell() {
    const std::string met = taught_.deviation <= kExact
                                ? "through all rows"
                                : fmt::format("rows' turns within {:.2g} deg", taught_.deviation / kDegree);
    say(fmt::format("taught from {} places: {:.6g} long, turn {:.6g} deg, {}, {}", taught_.rows, taught_.lap,
                    taught_.turn / kDegree, counted(taught_.corners, "corner", "corners"), met));
    if (const double noise = roll_.unsaid_noise(); noise > 0) {
      say(
          fmt::format("the rows' turns jitter by {0:.2g} deg, and no noise was given: the part has it all; smooth it "
                      "with `noise` angle={0:.2g}deg",
                      noise / kDegree));
    }
    tell_accuracy();
    if (taught_.overlap > 0) {
      say(fmt::format("the roll is back at its start after {:.6g}; the {:.6g} that it goes on from there {}",
                      taught_.lap, taught_.overlap, roll_.is_noisy() ? "are laid over its beginning" : "close it"));
    }
    tell_closing();
    if (taught_.outline.closed && taught_.turns < 0 && !taught_.outline.hole) {
      say("the course runs clockwise, and lengths stay positive along it");
    }
    if (taught_.outline.hole) say("the finger turned clockwise: the material is outside, a hole");
    if (roll_.noise().radius > 0 && roll_.is_fingers()) {
      say(fmt::format("the finger's radius leaves the size open by {:.3g} %",
                      100 * roll_.noise().radius / roll_.radius()));
    }
  }

 private:
  void say(std::string text) { taught_.notes.push_back(std::move(text)); }

  /// What the part says of its own accuracy, and whether the rows are noisier than was stated.
  void tell_accuracy() {
    const Accuracy& accuracy = taught_.outline.accuracy;
    if (accuracy.turn <= kExact && accuracy.length <= kExact && accuracy.walk == 0) {
      say("it is as exact as the rows: what rounding leaves is next to nothing");
      return;
    }
    std::string text =
        fmt::format("its tangents are known with a standard deviation of {:.2g} deg", accuracy.turn / kDegree);
    if (accuracy.walk > 0) {
      // Over half a lap, the farthest that two places of a closed part are apart.
      text += fmt::format(", turns over half of it with {:.2g} deg",
                          accuracy.walk * std::sqrt(0.5 * taught_.lap) / kDegree);
    }
    if (accuracy.length > 0) text += fmt::format(", its lengths with {:.2g} %", 100 * accuracy.length);
    say(text);
    if (roll_.is_noisy() && taught_.row_sd > kNoisier * roll_.errors().sd) {
      say(fmt::format(
          "the rows' turns are off by {:.2g} deg, which is more than the noise given, {:.2g} deg: counted as found",
          taught_.row_sd / kDegree, roll_.errors().sd / kDegree));
    }
  }

  /// How the ends were joined, with what turn and gap are off and what drift allows of each.
  void tell_closing() {
    const std::string found = fmt::format(
        "the turn is off {} x 360 deg by {:.3g} deg (drift allows {:.3g}), the end is {:.3g} from the start (drift "
        "allows {:.3g})",
        taught_.turns, taught_.turn_gap / kDegree, taught_.turn_allowed / kDegree, taught_.gap, taught_.gap_allowed);
    switch (taught_.closing) {
      case Closing::spread:
        say(fmt::format("closed: {}; spread, which turned tangents by at most {:.3g} deg", found,
                        taught_.correction / kDegree));
        break;
      case Closing::bridged:
        say(fmt::format("closed by a bridge of length {:.6g}: {}", taught_.bridge, found));
        break;
      case Closing::kept_open:
        say(
            fmt::format("kept open, because the drift does not explain it: {}; say how large the drift is with "
                        "`noise`, or bridge the gap with `bridge`",
                        found));
        break;
      case Closing::not_asked:
        say("an open curve, as asked for");
        break;
    }
  }

  const FeltRoll& roll_;
  Taught& taught_;
};

}  // namespace

void add_notes(const FeltRoll& roll, Taught& taught) { Notes(roll, taught).tell(); }

}  // namespace rollfix::teaching
