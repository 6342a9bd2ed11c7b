#include "mistakes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace rollfix {

const char* name_of(TouchCause cause) {
  switch (cause) {
    case TouchCause::unit:
      return "unit";
    case TouchCause::outlier:
      return "outlier";
    case TouchCause::radius:
      return "radius";
    case TouchCause::normals_reversed:
      return "normals reversed";
    case TouchCause::normals_clockwise:
      return "normals clockwise";
    case TouchCause::mirrored:
      return "mirrored";
    case TouchCause::moved:
      return "moved";
    case TouchCause::noise:
      break;
  }
  return "noise";
}

namespace touch {
namespace {

// Of each mistake that is tried.
constexpr std::size_t kMistakeBudget = kTouchBudget / 10;
// Explanations that are told.
constexpr std::size_t kMostTold = 4;
// Touches in another unit are spread over this share of the perimeter at least.
constexpr double kLeastSpread = 0.05;
// An explanation fits where chi-square is no less likely than this.
constexpr double kExplains = 0.01;

struct Mistake {
  TouchDiagnosis what;
  TouchProblem without;
};

class Mistakes {
 public:
  explicit Mistakes(const TouchProblem& problem) : problem_(problem) {
    problem_.budget = std::min(problem.budget.value_or(kMistakeBudget), kMistakeBudget);
    any_normal_ = std::any_of(problem.touches.begin(), problem.touches.end(),
                              [](const MeasuredTouch& touch) { return touch.normal.has_value(); });
  }

  std::vector<Mistake> all() {
    add_normals();
    add_radius();
    add_units();
    TouchProblem turned_over = problem_;
    turned_over.mirrored = !problem_.mirrored;
    add({TouchCause::mirrored}, turned_over);
    add_outliers();
    return std::move(mistakes_);
  }

 private:
  void add(TouchDiagnosis what, const TouchProblem& without) { mistakes_.push_back({std::move(what), without}); }

  void add_normals() {
    if (!any_normal_) return;
    const auto with = [&](TouchCause cause, auto changed) {
      TouchProblem without = problem_;
      for (MeasuredTouch& touch : without.touches) {
        if (touch.normal) touch.normal = changed(*touch.normal);
      }
      add({cause}, without);
    };
    with(TouchCause::normals_reversed, [](double normal) { return normal + std::numbers::pi; });
    with(TouchCause::normals_clockwise, [](double normal) { return -normal; });
  }

  /// The diameter for the radius, the radius for the diameter, contacts for centres.
  void add_radius() {
    if (!problem_.finger) return;
    const double radius = problem_.finger->disk()->radius;
    for (const double other : {0.5 * radius, 2 * radius, 0.0}) {
      TouchProblem without = problem_;
      without.finger.reset();
      if (other > 0) without.finger = disk(other);
      TouchDiagnosis what{TouchCause::radius};
      what.radius = other;
      add(what, without);
    }
  }

  void add_units() {
    struct Scale {
      double factor;
      const char* from;
      const char* to;
    };
    constexpr std::array<Scale, 6> kScales = {{{25.4, "in", "mm"},
                                               {1 / 25.4, "mm", "in"},
                                               {10, "cm", "mm"},
                                               {0.1, "mm", "cm"},
                                               {1000, "m", "mm"},
                                               {0.001, "mm", "m"}}};
    double spread = 0;
    for (const MeasuredTouch& touch : problem_.touches) {
      spread = std::max(spread, (touch.at - problem_.touches.front().at).norm());
    }
    for (const Scale& scale : kScales) {
      // Touches that lie on one spot would fit about anywhere, and no two are further apart than the part is long.
      if (scale.factor * spread < kLeastSpread * problem_.part.perimeter()) continue;
      TouchProblem without = problem_;
      for (MeasuredTouch& touch : without.touches) touch.at *= scale.factor;
      TouchDiagnosis what{TouchCause::unit};
      what.factor = scale.factor;
      what.unit = scale.from;
      what.into = scale.to;
      add(what, without);
    }
  }

  /// Where the others can still contradict each other.
  void add_outliers() {
    if (problem_.touches.size() < 3) return;
    for (std::size_t k = 0; k < problem_.touches.size(); ++k) {
      TouchProblem without = problem_;
      without.touches.erase(without.touches.begin() + static_cast<std::ptrdiff_t>(k));
      TouchDiagnosis what{TouchCause::outlier};
      what.touch = k;
      add(what, without);
    }
  }

  TouchProblem problem_;
  bool any_normal_ = false;
  std::vector<Mistake> mistakes_;
};

/// Whether the touches of an explanation could have contradicted it. Without noise: more equations than unknowns.
bool is_telling(const TouchProblem& problem) {
  int freedom = -3;
  for (const MeasuredTouch& touch : problem.touches) freedom += touch.normal ? 2 : 1;
  return freedom > 0;
}

void add_noise_factor(const TouchAnswer& answer, std::vector<TouchDiagnosis>& told) {
  if (!answer.fit || answer.fit->freedom == 0) return;
  TouchDiagnosis what;
  what.factor = std::sqrt(answer.fit->chi_square / answer.fit->freedom);
  what.fit = *answer.fit;
  what.poses = answer.poses.size();
  what.pose = answer.poses.front().pose;
  told.push_back(what);
}

}  // namespace

std::vector<TouchDiagnosis> mistakes(const TouchProblem& problem, const TouchAnswer& answer) {
  std::vector<TouchDiagnosis> told;
  for (const Mistake& mistake : Mistakes(problem).all()) {
    if (!is_telling(mistake.without)) continue;
    const TouchAnswer found = solve_plain(mistake.without);
    if (found.status != Status::complete || found.poses.empty()) continue;
    if (found.fit && found.fit->p < kExplains) continue;
    TouchDiagnosis what = mistake.what;
    if (found.fit) what.fit = *found.fit;
    what.poses = found.poses.size();
    what.pose = found.poses.front().pose;
    told.push_back(what);
  }
  std::stable_sort(told.begin(), told.end(),
                   [](const TouchDiagnosis& a, const TouchDiagnosis& b) { return a.fit.p > b.fit.p; });
  if (told.size() > kMostTold) told.resize(kMostTold);
  if (told.empty()) add_noise_factor(answer, told);
  return told;
}

}  // namespace touch
}  // namespace rollfix
