#include "rollfix/output/answer_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "outline/turn.hpp"
#include "rollfix/inspect.hpp"
#include "rollfix/output/table.hpp"
#include "rollfix/touch.hpp"
#include "text/text.hpp"

namespace rollfix::app {
namespace {

constexpr double kExact = 1e-6;  // of the tolerance
constexpr double kAlike = 1e-3;
// Touches that are outliers with this probability are told.
constexpr double kMayBeOutlier = 0.1;
// With no more measurements beyond the unknowns than this, one mistake in ten or more goes unnoticed.
constexpr int kFewChecks = 3;

class TouchText {
 public:
  explicit TouchText(const TouchAnswer& answer)
      : answer_(answer), decimals_(decimals_for(answer.part.perimeter())), unit_(answer.part.unit()) {}

  std::string text(bool verbose) const {
    std::string text = answer_.verdict_text() + "\n" + advice_line() + diagnosis_lines();
    if (!answer_.poses.empty()) text += "\n" + poses_table() + "\n" + pose_remarks();
    if (!answer_.rolls.empty()) text += rolls_table() + "\n";
    if (verbose && !answer_.poses.empty() && !answer_.touches.empty()) text += contacts_table() + "\n";
    return text + unresolved_lines() + asked_lines();
  }

 private:
  std::string place(double value) const { return fixed(value, decimals_); }
  static double sd(const TouchPose& pose, int which) {
    return std::sqrt(std::max(0.0, pose.spread.covariance(which, which)));
  }
  static std::string share(double probability) { return fmt::format("{:.4f}", probability); }

  /// Whether a part with a symmetry lies the same in all poses: turned by a share of a turn about its middle.
  bool all_alike() const {
    const int folds = answer_.part.closed() ? symmetry(answer_.part) : 1;
    if (folds < 2) return false;
    Vec2 middle(0, 0);
    for (int k = 0; k < folds; ++k) middle += answer_.part.point(k * answer_.part.perimeter() / folds) / folds;
    if (answer_.mirrored) middle.x() = -middle.x();
    const TouchPose& first = answer_.poses.front();
    const double share = 2 * std::numbers::pi / folds;
    return std::all_of(answer_.poses.begin(), answer_.poses.end(), [&](const TouchPose& pose) {
      const double off = std::abs(std::remainder(pose.pose.heading - first.pose.heading, share));
      return !pose.continuum && off <= kAlike &&
             (pose.pose.world(middle) - first.pose.world(middle)).norm() <= kAlike * answer_.part.perimeter();
    });
  }

  /// What to do next.
  std::string advice_line() const {
    if (!answer_.rolls.empty()) return advice_of_rolls();
    switch (answer_.verdict.name) {
      case Verdict::unique:
        return "";
      case Verdict::ambiguous:
        if (all_alike()) return "the part looks the same in each of these poses: no touch can identify one\n";
        return answer_.verdict.stretches > 0
                   ? "the touches leave the part free to move: touch a side with another direction\n"
                   : "next: one more touch, on a side with another direction\n";
      case Verdict::unobservable:
        if (answer_.anywhere > 0 && answer_.touches.size() > 1) return open_line();
        if (answer_.touches.size() == 1) {
          return fmt::format("one touch fits all along the boundary: touch the part elsewhere{}\n",
                             answer_.touches.front().normal ? "; rollfix advise says where" : "");
        }
        if (answer_.poses.empty()) {
          return "all touches are at one place, and fit all along the boundary: touch the part elsewhere\n";
        }
        return symmetry(answer_.part) == 0
                   ? "the part looks the same in every heading: only its place is known\n"
                   : "any heading fits: the touches are too close together, or the noise is too large for this part\n";
      case Verdict::undecided:
        return "the budget ran out: more touches, or a larger --budget, leave less to look at\n";
      case Verdict::inconsistent:
        break;
    }
    return "no pose of the part fits all touches\n";
  }

  /// With outliers.
  std::string open_line() const {
    return fmt::format("with probability {:.2g} no two touches count that are apart: touch once more\n",
                       answer_.anywhere);
  }

  std::string advice_of_rolls() const {
    switch (answer_.verdict.name) {
      case Verdict::unique:
        return "";
      case Verdict::ambiguous:
        if (all_alike()) return "the part looks the same in each of these poses: no roll can identify one\n";
        return answer_.verdict.stretches > 0
                   ? "the contacts leave the part free to move: roll over a side with another direction\n"
                   : "next: one more roll or touch elsewhere on the part\n";
      case Verdict::unobservable:
        return "any heading fits: roll over a stretch of the part that is bent otherwise\n";
      case Verdict::undecided:
        return "not decided: longer rolls, or a larger --budget, leave less to look at\n";
      case Verdict::inconsistent:
        break;
    }
    for (std::size_t k = 0; k < answer_.rolls.size(); ++k) {
      if (answer_.rolls[k].alone.name != Verdict::inconsistent) continue;
      return fmt::format("roll {} fits nowhere on the part by itself: locate it alone to see what may be wrong\n",
                         k + 1);
    }
    return "each roll fits the part by itself, and no pose fits all contacts\n";
  }

  /// Of several files with the file's name.
  std::string lines_of(const RollFacts& roll) const {
    if (roll.lines.empty()) return "-";
    const auto file_of = [](const RollFacts& one) { return one.name.substr(0, one.name.rfind(", lines ")); };
    const bool is_one_file = std::all_of(answer_.rolls.begin(), answer_.rolls.end(),
                                         [&](const RollFacts& other) { return file_of(other) == file_of(roll); });
    return fmt::format("{}{} to {}", is_one_file ? "" : file_of(roll) + ", ", roll.lines.front(), roll.lines.back());
  }

  /// What each roll said, and where it is in the first pose.
  std::string rolls_table() const {
    Table table;
    table.add_column("", Table::Align::left);
    table.add_column("lines");
    for (const std::string& title : {title_in("length", unit_), std::string("turn [deg]")}) table.add_column(title);
    table.add_column("by itself", Table::Align::left);
    const bool has_pose = !answer_.poses.empty();
    if (has_pose) {
      for (const char* title : {"start in p0", "end in p0"}) table.add_column(title_in(title, unit_));
    }
    for (std::size_t k = 0; k < answer_.rolls.size(); ++k) {
      const RollFacts& roll = answer_.rolls[k];
      std::vector<std::string> cells{fmt::format("roll {}", k + 1), lines_of(roll), place(roll.reading.length[0]),
                                     degrees(roll.reading.turn), roll.alone.text()};
      if (has_pose) {
        const TouchContact& contact = answer_.poses.front().contacts[k];
        cells.push_back(place(contact.s));
        cells.push_back(contact.end ? place(*contact.end) : "-");
      }
      table.add_row(std::move(cells));
    }
    return table.str();
  }

  std::string diagnosis_lines() const {
    std::string text;
    for (const TouchDiagnosis& one : answer_.diagnoses) {
      const std::string fit = one.fit.freedom > 0 && one.cause != TouchCause::noise
                                  ? fmt::format(" (p = {:.2g}, {})", one.fit.p, counted(one.poses, "pose", "poses"))
                                  : "";
      text += "possible cause: " + words_of(one, answer_) + fit + "\n";
    }
    const bool is_odd = answer_.verdict.name == Verdict::inconsistent || answer_.verdict.fits_badly;
    if (!answer_.rolls.empty()) {
      for (std::size_t k = 0; k < answer_.rolls.size(); ++k) {
        const RollFacts& roll = answer_.rolls[k];
        if (roll.alone.name == Verdict::inconsistent || !roll.alone.fits_badly) continue;
        text += fmt::format("roll {} fits badly by itself: locate it alone to see what may be wrong\n", k + 1);
      }
      return text;
    }
    if (text.empty() && is_odd && answer_.touches.size() > 1) {
      text = "no usual mistake explains it: check the part, its unit, and each touch\n";
    }
    return text;
  }

  std::string poses_table() const {
    Table table;
    const bool has_noise = answer_.noise.has_value();
    table.add_column("", Table::Align::left);
    if (has_noise) table.add_column("probability");
    const int first = answer_.place == PlaceKnown::unknown ? 2 : 0;
    const std::array<std::string, 3> titles = {title_in("x", unit_), title_in("y", unit_), "heading [deg]"};
    for (int i = first; i < 3; ++i) {
      table.add_column(titles[static_cast<std::size_t>(i)]);
      if (has_noise) table.add_column("±");
    }
    table.add_column(answer_.place == PlaceKnown::measured ? "worst residual" : "worst residual [deg]");
    for (std::size_t k = 0; k < std::min(answer_.poses.size(), kMostRows); ++k) {
      const TouchPose& pose = answer_.poses[k];
      std::vector<std::string> cells{fmt::format("p{}", k)};
      if (has_noise) cells.push_back(share(pose.probability));
      const Pose& at = pose.estimate();
      const std::array<std::string, 3> values = {place(at.x), place(at.y),
                                                 pose.any_heading ? "any" : degrees(at.heading)};
      for (int i = first; i < 3; ++i) {
        cells.push_back(values[static_cast<std::size_t>(i)]);
        if (has_noise) cells.push_back(rough(i < 2 ? sd(pose, i) : sd(pose, i) / kDegree));
      }
      // An exact fit leaves rounding.
      const bool by_place = answer_.place == PlaceKnown::measured;
      const double residual = by_place ? pose.residual.length : pose.residual.turn;
      const TouchTolerance& tolerance = answer_.tolerance.front();
      const bool is_exact = residual < kExact * (by_place ? tolerance.length : tolerance.angle);
      cells.push_back(is_exact ? "0" : rough(by_place ? residual : residual / kDegree));
      table.add_row(std::move(cells));
    }
    const std::size_t more = answer_.poses.size() - std::min(answer_.poses.size(), kMostRows);
    return table.str() + (more == 0 ? "" : fmt::format("... and {} more; --json lists them all\n", more));
  }

  std::string span(const Interval& interval) const {
    return fmt::format("{} to {}", place(interval.lo), place(interval.hi));
  }

  /// Of a continuum.
  std::string freedom(const TouchPose& pose) const {
    if (!pose.continuum) return "";
    const std::optional<Slide> slide = slide_of(answer_, pose);
    if (!slide) return "; a continuum, of which the table shows one";
    return fmt::format("; it slides by up to {}{} along {} deg, of which the table shows one pose",
                       place(slide->length), behind(unit_), degrees(slide->direction));
  }

  std::string pose_remarks() const {
    std::string text;
    for (std::size_t k = 0; k < std::min(answer_.poses.size(), kMostNotes); ++k) {
      const TouchPose& pose = answer_.poses[k];
      const std::array<Interval, 3>& range = answer_.noise ? pose.interval : pose.extent;
      const std::string heading = pose.any_heading
                                      ? "any heading"
                                      : fmt::format("heading {} to {} deg", degrees(range[2].lo), degrees(range[2].hi));
      const std::string places = answer_.place == PlaceKnown::unknown
                                     ? ""
                                     : fmt::format("x {}, y {}{}, ", span(range[0]), span(range[1]), behind(unit_));
      text +=
          fmt::format("p{}: {} {}{}{}\n", k, answer_.noise ? "95 % within" : "within", places, heading, freedom(pose));
    }
    if (answer_.place == PlaceKnown::unknown) {
      text += "where the part is is not known: the log has no columns x and y\n";
    } else if (answer_.place == PlaceKnown::reference) {
      text += "x and y are from roll 1 alone; with --noise position=SD all rolls tell where the part is\n";
    }
    if (answer_.poses.front().any_heading) text += centre_line(answer_.poses.front().pose);
    return text + "\n";
  }

  /// Of a circle, which has no heading: its centre, which is known nevertheless.
  std::string centre_line(const Pose& pose) const {
    const std::vector<Spiral>& spirals = answer_.part.turning().spirals();
    const double curvature = spirals.front().start.curvature;
    const bool is_circle = curvature != 0 && std::all_of(spirals.begin(), spirals.end(), [&](const Spiral& spiral) {
                             return std::abs(spiral.start.curvature - curvature) <= 1e-9 * std::abs(curvature) &&
                                    std::abs(spiral.end.curvature - curvature) <= 1e-9 * std::abs(curvature);
                           });
    if (!is_circle) return "";
    const double tangent = answer_.part.tangent(0);
    const Vec2 centre = answer_.part.point(0) + Vec2(-std::sin(tangent), std::cos(tangent)) / curvature;
    const Vec2 world = pose.world({answer_.mirrored ? -centre.x() : centre.x(), centre.y()});
    return fmt::format("the circle's centre is at x {}, y {}{}\n", place(world.x()), place(world.y()), behind(unit_));
  }

  /// Of the first pose.
  std::string contacts_table() const {
    const TouchPose& pose = answer_.poses.front();
    Table table;
    table.add_column("touch");
    for (const char* title : {"x", "y", "s", "off"}) table.add_column(title_in(title, unit_));
    table.add_column("normal off [deg]");
    for (std::size_t k = 0; k < answer_.touches.size(); ++k) {
      const TouchContact& contact = pose.contacts[answer_.rolls.size() + k];
      const MeasuredTouch& touch = answer_.touches[k];
      const bool has_place = touch.has_place();
      const bool is_outlier = std::binary_search(pose.outliers.begin(), pose.outliers.end(), k);
      table.add_row({fmt::format("{}{}", k + 1, is_outlier ? " (outlier)" : ""), has_place ? place(touch.at.x()) : "-",
                     has_place ? place(touch.at.y()) : "-", place(contact.s), has_place ? rough(contact.distance) : "-",
                     contact.turn ? fmt::format("{:.2f}", *contact.turn / kDegree) : "-"});
    }
    return "touches on the part in p0:\n" + table.str();
  }

  std::string contact_name(std::size_t contact) const {
    const std::size_t rolls = answer_.rolls.size();
    return contact < rolls ? fmt::format("roll {}", contact + 1) : fmt::format("touch {}", contact - rolls + 1);
  }

  std::string unresolved_lines() const {
    std::string text;
    for (std::size_t k = 0; k < std::min(answer_.unresolved.size(), kMostNotes); ++k) {
      text += fmt::format("not decided: {} at s from {}{}\n", contact_name(answer_.unresolved_touch),
                          span(answer_.unresolved[k]), behind(unit_));
    }
    if (answer_.unresolved.size() > kMostNotes) {
      text += fmt::format("... and {} more arcs\n", answer_.unresolved.size() - kMostNotes);
    }
    return text;
  }

  /// Few measurements beyond the unknowns may agree with a wrong radius or side: docs/touch.md counts how often.
  std::string few_checks() const {
    if (!answer_.rolls.empty() || answer_.fit->freedom > kFewChecks) return "";
    if (answer_.verdict.name != Verdict::unique) return "";
    return "; few checks: touch once more to be sure of radius, side and units";
  }

  /// Of touches that may be outliers: which of them probably are.
  std::string outlier_line() const {
    if (answer_.outlier.empty() || answer_.verdict.name == Verdict::inconsistent) return "";
    std::string probable;
    double most = 0;
    for (std::size_t k = 0; k < answer_.outlier.size(); ++k) {
      most = std::max(most, answer_.outlier[k]);
      if (answer_.outlier[k] < kMayBeOutlier) continue;
      probable +=
          fmt::format("{}touch {} (probability {})", probable.empty() ? "" : ", ", k + 1, share(answer_.outlier[k]));
    }
    if (probable.empty()) {
      return fmt::format("robust     any touch may be an outlier; none seems to be (probability at most {:.1g})\n",
                         most);
    }
    return "robust     any touch may be an outlier; most probably " + probable + "\n";
  }

  std::string asked_lines() const {
    const Part& part = answer_.part;
    const auto with_normal = std::count_if(answer_.touches.begin(), answer_.touches.end(),
                                           [](const MeasuredTouch& touch) { return touch.normal.has_value(); });
    std::string text =
        fmt::format("part       {}, {}, perimeter {}{}{}\n", plain(part.name()), part.closed() ? "closed" : "open",
                    place(part.perimeter()), behind(unit_), answer_.mirrored ? ", face down" : "");
    const std::string finger = answer_.radius > 0 ? fmt::format("disk,r={:.6g}", answer_.radius) : "a point";
    if (!answer_.rolls.empty()) {
      text += fmt::format("contacts   {}{}{}\n", counted(answer_.rolls.size(), "roll", "rolls"),
                          answer_.touches.empty() ? "" : ", " + counted(answer_.touches.size(), "touch", "touches"),
                          answer_.radius > 0 ? "; finger " + finger : "");
    } else {
      text += fmt::format("touches    {}, {} with normal; finger {}\n", answer_.touches.size(), with_normal, finger);
    }
    if (!answer_.clear.empty()) text += fmt::format("clear      {}\n", counted(answer_.clear.size(), "path", "paths"));
    if (answer_.noise && !answer_.rolls.empty()) {
      text += fmt::format("noise      {}{}\n", noise_words(*answer_.noise, behind(unit_)),
                          answer_.robust ? "; robust" : "");
    } else if (!answer_.rolls.empty()) {
      const TouchTolerance& tolerance = answer_.tolerance.front();
      text += fmt::format("tolerance  {}headings within {:.3g} deg of one another\n",
                          answer_.place == PlaceKnown::measured
                              ? fmt::format("centres {:.3g}{}, ", tolerance.length, behind(unit_))
                              : "",
                          2 * tolerance.angle / kDegree);
    } else if (answer_.noise && answer_.noise->position == 0) {
      text += "noise      of each touch its own\n";
    } else if (answer_.noise) {
      text += fmt::format(
          "noise      position {:.6g}{}{}\n", answer_.noise->position, behind(unit_),
          answer_.noise->angle > 0 ? fmt::format(", angle {:.6g} deg", answer_.noise->angle / kDegree) : "");
    } else {
      text +=
          fmt::format("tolerance  {:.6g}{}{}\n", answer_.tolerance.front().length, behind(unit_),
                      with_normal > 0 ? fmt::format(", {:.6g} deg", answer_.tolerance.front().angle / kDegree) : "");
    }
    text += outlier_line();
    if (answer_.fit && answer_.fit->freedom > 0) {
      text += fmt::format("fit        chi-square {:.3g} where {} is expected, p = {:.2g}{}\n", answer_.fit->chi_square,
                          answer_.fit->freedom, answer_.fit->p, few_checks());
    } else if (answer_.fit) {
      text += answer_.rolls.empty() ? "fit        these touches can't contradict each other: one more checks them\n"
                                    : "fit        these contacts can't contradict each other: one more checks them\n";
    }
    const std::string rejected = counted(answer_.improbable, "pose", "poses");
    if (answer_.improbable > 0 && answer_.poses.empty()) {
      text += fmt::format("rejected   {} in which a touch is off by more than {:.2g} standard deviations\n", rejected,
                          kPossibleSigmas);
    } else if (answer_.improbable > 0) {
      text += fmt::format("rejected   {} that fit far worse, together less than {:.1g} % probable\n", rejected,
                          std::max(1e-4, 110 * (answer_.rest - answer_.anywhere)));
    }
    return text;
  }

  const TouchAnswer& answer_;
  int decimals_;
  std::string unit_;
};

}  // namespace

std::string touches_text(const TouchAnswer& answer, bool verbose) { return TouchText(answer).text(verbose); }

}  // namespace rollfix::app
