#include <fmt/format.h>

#include <algorithm>

#include "rollfix/output/answer_output.hpp"
#include "rollfix/output/answer_sections.hpp"
#include "rollfix/output/answer_words.hpp"

namespace rollfix::app {
namespace {

class DroppedText : AnswerWords {
 public:
  explicit DroppedText(const Answer& answer) : AnswerWords(answer) {}

  std::string text(bool explain) const {
    const std::string hint = explain ? "" : " (--explain lists them)";
    std::string text;
    if (answer_.dropped.reach > 0) {
      text += fmt::format("dropped    {} that {} finger can't reach{}\n", answer_.dropped.reach,
                          fingers_ == 1 ? "the" : "a", hint);
    }
    if (answer_.dropped.overlap > 0) {
      text += fmt::format(
          "dropped    {} whose fingers would overlap{}; of fingers at different heights say --may-overlap\n",
          answer_.dropped.overlap, hint);
    }
    if (!explain) return text;
    for (std::size_t k = 0; k < std::min(answer_.impossible.size(), kMostRows); ++k) {
      text += "  " + about_impossible(answer_.impossible[k]) + '\n';
    }
    return text + more_line(answer_.impossible.size());
  }

 private:
  std::string about_impossible(const Impossible& item) const {
    const PerFinger<double>& start = item.placement.start;
    const std::string starts =
        fingers_ == 1 ? "start " + place(start[0]) : fmt::format("starts {} and {}", place(start[0]), place(start[1]));
    const std::string head = fmt::format("{} ({}): ", starts, name_of(item.placement.kind));
    if (item.reason == Impossible::Reason::overlap) {
      const std::string when = item.instant == 0 ? "at the first contacts" : fmt::format("at instant {}", item.instant);
      return head + fmt::format("the fingers would overlap by {} {}", rough(item.depth), when);
    }
    const std::string who = fingers_ == 1 ? "" : item.finger == 0 ? "finger a: " : "finger b: ";
    return head + who + about(item.obstruction, answer_.part);
  }
};

std::string place_text(const Part& part, double s, const Vec2& point) {
  const int decimals = decimals_for(part.perimeter());
  return fmt::format("s = {}, ({}, {})", fixed(s, decimals), fixed(point.x(), decimals), fixed(point.y(), decimals));
}

}  // namespace

std::string dropped_lines(const Answer& answer, bool explain) { return DroppedText(answer).text(explain); }

std::string about(const Obstruction& obstruction, const Part& part) {
  if (obstruction.concave_corner) {
    return "the finger would roll over the concave corner at " + place_text(part, obstruction.s, obstruction.hit.point);
  }
  const int decimals = decimals_for(part.perimeter());
  return fmt::format("touching at s = {} the finger would hit the part at {}, {} deep", fixed(obstruction.s, decimals),
                     place_text(part, obstruction.hit.s, obstruction.hit.point), rough(obstruction.hit.depth));
}

}  // namespace rollfix::app
