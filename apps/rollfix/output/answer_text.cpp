#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "outline/turn.hpp"
#include "rollfix/output/answer_output.hpp"
#include "rollfix/output/answer_sections.hpp"
#include "rollfix/output/answer_words.hpp"

namespace rollfix::app {
namespace {

constexpr double kAgreement = 1e-9;  // contacts closer together than this share of the perimeter are the same

/// The sections one below the other, and what is special about some placements.
class AnswerText : AnswerWords {
 public:
  explicit AnswerText(const Answer& answer) : AnswerWords(answer) {}

  std::string text(const AnswerDetail& detail) const {
    std::string text = verdict_lines(answer_) + "\n";
    if (!answer_.placements.empty()) text += placements_table(answer_, detail.verbose) + "\n";
    const std::string below = remarks() + pose_lines() + unresolved_lines();
    if (!below.empty()) text += below + "\n";
    return text + asked_lines(answer_, detail.verbose) + dropped_lines(answer_, detail.explain);
  }

 private:
  /// "12.000 deg", or "from 12.000 to 34.000 deg"; turned by whole turns as the start's tangent is in the table.
  static std::string directions(const Interval& angles, double whole_turns) {
    const std::string lo = degrees(angles.lo - whole_turns);
    const std::string hi = degrees(angles.hi - whole_turns);
    return lo == hi ? lo + " deg" : fmt::format("from {} to {} deg", lo, hi);
  }

  static std::string about_corner(const Pivot& pivot) {
    const double middle = pivot.start.middle();
    const double whole_turns = middle - std::remainder(middle, kFullTurn);
    return fmt::format("at a corner: the tangent points {} at the start, {} at the end",
                       directions(pivot.start, whole_turns), directions(pivot.end, whole_turns));
  }

  std::string remark_on(const Placement& placement) const {
    const bool goes_round =
        std::any_of(placement.whole_loop.begin(), placement.whole_loop.end(), [](bool b) { return b; });
    if (placement.kind == Kind::stretch) {
      if (goes_round) return fingers_ == 1 ? "every place on the boundary fits" : "fits all the way round the boundary";
      if (fingers_ == 1) return "every start " + span(placement.extent[0]) + " fits";
      const PerFinger<double>& from = placement.family.front();
      const PerFinger<double>& to = placement.family.back();
      return fmt::format("a continuum of pairs, from ({}, {}) to ({}, {}); --json has its line", place(from[0]),
                         place(from[1]), place(to[0]), place(to[1]));
    }
    if (fingers_ == 1 && goes_round) return "within the tolerance every place on the boundary fits";
    if (fingers_ == 1 && placement.kind == Kind::corner && placement.pivot) return about_corner((*placement.pivot)[0]);
    if (placement.roots.size() > 1) {
      return fmt::format("holds {} exact {}, closer together than the tolerance can tell", placement.roots.size(),
                         fingers_ == 1 ? "starts" : "pairs");
    }
    if (placement.roots.empty()) return "fits within the tolerance, nowhere exactly";
    return "";
  }

  std::string remarks() const {
    if (answer_.weighing)
      return "";  // noise leaves hardly anything exact: the probabilities say what is worth a remark
    std::string text;
    std::size_t count = 0;
    for (std::size_t i = 0; i < std::min(answer_.placements.size(), kMostRows); ++i) {
      const std::string remark = remark_on(answer_.placements[i]);
      if (!remark.empty() && ++count <= kMostNotes) text += fmt::format("{}: {}\n", label(i), remark);
    }
    if (count > kMostNotes) text += fmt::format("... and {} more such remarks\n", count - kMostNotes);
    return text;
  }

  std::string pose_lines() const {
    std::string text;
    for (std::size_t i = 0; i < std::min(answer_.placements.size(), kMostNotes); ++i) {
      const Placement& placement = answer_.placements[i];
      if (!placement.pose.empty()) text += fmt::format("{}: {}\n", label(i), about_pose(placement, answer_));
    }
    return text;
  }

  std::string unresolved_lines() const {
    std::string text;
    const std::size_t count = answer_.unresolved.size();
    for (std::size_t i = 0; i < std::min(count, kMostNotes); ++i) {
      const PerFinger<Interval>& open = answer_.unresolved[i];
      text += fingers_ == 1 ? fmt::format("not decided: starts {}\n", span(open[0]))
                            : fmt::format("not decided: starts a {}, b {}\n", span(open[0]), span(open[1]));
    }
    if (count > kMostNotes) {
      text += fmt::format("... and {} more {}\n", count - kMostNotes, fingers_ == 1 ? "intervals" : "boxes");
    }
    return text;
  }
};

/// With noise: where the part was at the first contacts, as all rows have it, and how sure that is.
std::string about_spread(const PoseSpread& spread, const Answer& answer) {
  const int decimals = decimals_for(answer.part.perimeter());
  const auto sd = [&](int k) { return std::sqrt(std::max(0.0, spread.covariance(k, k))); };
  const std::string instant = answer.pose_time.empty() ? "" : fmt::format(", at {:.6g} s,", answer.pose_time.front());
  const std::string heading =
      sd(2) < std::numbers::pi
          ? fmt::format("heading {} ± {} deg", degrees(spread.mean.heading), rough(sd(2) / kDegree))
          : "its heading unknown";
  return fmt::format("at the first contact{} the part was at x = {} ± {}, y = {} ± {}{}, {}", instant,
                     fixed(spread.mean.x, decimals), rough(sd(0)), fixed(spread.mean.y, decimals), rough(sd(1)),
                     behind(answer.part.unit()), heading);
}

}  // namespace

std::string about_pose(const Placement& placement, const Answer& answer) {
  const Part& part = answer.part;
  const int decimals = decimals_for(part.perimeter());
  const Pose& last = placement.pose.back();
  const double off = placement.pose_residual->length;
  const std::string agreement =
      off <= kAgreement * part.perimeter() ? "the contacts agree" : fmt::format("contacts off by {}", rough(off));
  const std::string face = answer.mirrored ? " face down" : "";
  // With noise the contacts are off along the part by as much as the start is: that says nothing of what was felt.
  if (placement.pose_spread) return about_spread(*placement.pose_spread, answer) + face;
  return fmt::format("the part is{} at x = {}, y = {}{}, heading {} deg; {}", face, fixed(last.x, decimals),
                     fixed(last.y, decimals), behind(part.unit()), degrees(last.heading), agreement);
}

std::string answer_text(const Answer& answer, const AnswerDetail& detail) { return AnswerText(answer).text(detail); }

}  // namespace rollfix::app
