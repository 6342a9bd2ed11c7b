#include "steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "rollfix/outline.hpp"

// Of a problem that nothing fits, or whose fit is improbable: each usual mistake is undone, `Mistake::without`, and
// solved again. Notation:
//   chi^2, p    sum of squares of the best pose, and the probability of one no smaller; a mistake explains the touches
//               where p >= kExplains
//   k           a factor of the noise, doubled up to kMostNoise: the least with which the touches fit is told
//   moved       rolls 1..m fit together and so do m + 1..n, but not all n
// Follows docs/touch.md, "If the touches contradict the noise".
namespace rollfix {

namespace {

constexpr std::array<std::pair<TouchCause, const char*>, 12> kTouchCauseNames = {
    {{TouchCause::unit, "unit"},
     {TouchCause::outlier, "outlier"},
     {TouchCause::radius, "radius"},
     {TouchCause::normals_reversed, "normals reversed"},
     {TouchCause::normals_clockwise, "normals clockwise"},
     {TouchCause::mirrored, "mirrored"},
     {TouchCause::moved, "moved"},
     {TouchCause::swapped, "x and y swapped"},
     {TouchCause::other_side, "other side"},
     {TouchCause::pose, "pose"},
     {TouchCause::clear, "clear"},
     {TouchCause::noise, "noise"}}};
static_assert(kTouchCauseNames.size() == static_cast<std::size_t>(TouchCause::noise) + 1, "each cause has a name");

}  // namespace

const char* name_of(TouchCause cause) {
  for (const auto& [one, name] : kTouchCauseNames) {
    if (one == cause) return name;
  }
  return "";
}

namespace touch {
namespace {

// Each mistake is tried with no more touches: every one of them is left out once.
constexpr std::size_t kMostTried = 32;

// Of each mistake that is tried.
constexpr std::size_t kMistakeBudget = kTouchBudget / 10;
// Noise that is larger by less explains nothing.
constexpr double kLeastMoreNoise = 1.05;
// Of touches with more noise, which leaves more poses to weigh.
constexpr std::size_t kNoiseBudget = kTouchBudget / 40;
// A fitted radius is off by about so many standard deviations of a place.
constexpr double kAboutTheRadius = 3;
// Explanations that are told.
constexpr std::size_t kMostTold = 4;
// Touches in another unit are spread over this share of the perimeter at least.
constexpr double kLeastSpread = 0.05;
// Noise is looked at up to this many times the stated one, doubled each time: beyond, touches tell nothing.
constexpr double kMostNoise = 32;

/// A cause, with what it would be, and the problem in which it is undone.
struct Mistake {
  TouchDiagnosis what;
  TouchProblem without;
};

/// Lists all mistakes that a problem of touches can have, without solving any.
class Mistakes {
 public:
  explicit Mistakes(const TouchProblem& problem) : problem_(problem), may_have_outliers_(problem.robust) {
    problem_.robust = false;  // of each mistake all touches count
    problem_.budget = std::min(problem.budget.value_or(kMistakeBudget), kMistakeBudget);
    any_normal_ = std::any_of(problem.touches.begin(), problem.touches.end(),
                              [](const MeasuredTouch& touch) { return touch.normal.has_value(); });
  }

  std::vector<Mistake> all() {
    add_prior();
    add_clear();
    add_normals();
    add_radius();
    add_units();
    add_sides();
    add_outliers();
    return std::move(mistakes_);
  }

 private:
  void add(TouchDiagnosis what, const TouchProblem& without) { mistakes_.push_back({std::move(what), without}); }

  /// What is known of the pose beforehand is wrong.
  void add_prior() {
    if (!problem_.pose) return;
    TouchProblem without = problem_;
    without.pose.reset();
    add({TouchCause::pose}, without);
  }

  /// Some path was not clear: none of them counts.
  void add_clear() {
    if (problem_.clear.empty()) return;
    TouchProblem without = problem_;
    without.clear.clear();
    add({TouchCause::clear}, without);
  }

  /// The part's mirror image, or the other side of an outline that has two.
  void add_sides() {
    TouchProblem turned_over = problem_;
    turned_over.mirrored = !problem_.mirrored;
    add({TouchCause::mirrored}, turned_over);
    TouchProblem swapped = problem_;
    for (MeasuredTouch& touch : swapped.touches) std::swap(touch.at.x(), touch.at.y());
    for (Clear& path : swapped.clear) path = {{path.from.y(), path.from.x()}, {path.to.y(), path.to.x()}};
    // Swapped coordinates are a mirror image, turned: only normals, which are not swapped, tell the two apart.
    if (any_normal_) add({TouchCause::swapped}, swapped);  // else it can't be told from the mirror image
    if (problem_.part.closed()) return;
    // An open outline is touched on its right side: reversed, the other one is right.
    TouchProblem behind = problem_;
    behind.part = Part(reversed(problem_.part.outline()));
    add({TouchCause::other_side}, behind);
  }

  /// Turned by pi, or with the other sign.
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

  /// The diameter for the radius, the radius for the diameter, contacts for centres. With noise any other is tried.
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

  /// The touches' coordinates times each factor; radius and noise stay, as they are in the part's unit.
  void add_units() {
    // The largest distance from the first touch.
    double spread = 0;
    for (const MeasuredTouch& touch : problem_.touches) {
      spread = std::max(spread, (touch.at - problem_.touches.front().at).norm());
    }
    for (const MistakenUnit& scale : kMistakenUnits) {
      // Touches that lie on one spot would fit about anywhere, and no two are further apart than the part is long.
      if (scale.factor * spread < kLeastSpread * problem_.part.perimeter()) continue;
      TouchProblem without = problem_;
      for (MeasuredTouch& touch : without.touches) touch.at *= scale.factor;
      for (Clear& path : without.clear) path = {scale.factor * path.from, scale.factor * path.to};
      TouchDiagnosis what{TouchCause::unit};
      what.factor = scale.factor;
      what.unit = scale.from;
      what.into = scale.to;
      add(what, without);
    }
  }

  /// Where the others can still contradict each other.
  void add_outliers() {
    if (problem_.touches.size() < 3 || may_have_outliers_) return;
    for (std::size_t k = 0; k < problem_.touches.size(); ++k) {
      TouchProblem without = problem_;
      without.touches.erase(without.touches.begin() + static_cast<std::ptrdiff_t>(k));
      TouchDiagnosis what{TouchCause::outlier};
      what.touch = k;
      add(what, without);
    }
  }

  TouchProblem problem_;
  bool may_have_outliers_;  // then one touch that is wrong is none
  bool any_normal_ = false;
  std::vector<Mistake> mistakes_;
};

/// Whether the touches of an explanation could have contradicted it. Without noise: more equations than unknowns.
/// nu = residuals - unknowns: a touch adds 1, with a normal 2, the pose takes 3.
bool is_telling(const TouchProblem& problem) {
  int freedom = -3;
  for (const MeasuredTouch& touch : problem.touches) freedom += touch.normal ? 2 : 1;
  return freedom > 0;
}

/// The same touches with this many times the noise. What is known of the pose beforehand stays.
/// Angles no noisier than what a problem may state.
TouchProblem noisier(const TouchProblem& problem, double factor) {
  TouchProblem result = problem;
  for (double* sd : {&result.noise->position, &result.noise->angle}) *sd *= factor;
  result.noise->angle = std::min(result.noise->angle, BeliefOptions::kMostAngle);
  for (MeasuredTouch& touch : result.touches) {
    if (touch.position_sd) *touch.position_sd *= factor;
    if (touch.normal_sd) touch.normal_sd = std::min(factor * *touch.normal_sd, BeliefOptions::kMostAngle);
  }
  return result;
}

/// How much larger the noise has to be.
/// The last explanation, if any: by the least factor 2^k with which p >= kExplains, refined by chi^2 / nu to what would
/// make the fit as good as expected.
void add_noise_factor(const TouchProblem& problem, std::vector<TouchDiagnosis>& told) {
  if (!problem.noise || !is_telling(problem)) return;
  for (double factor = 2; factor <= kMostNoise; factor *= 2) {
    const TouchProblem without = noisier(problem, factor);
    const TouchAnswer found = solve_plain(without);
    if (found.status != Status::complete || !found.fit || found.fit->freedom == 0) continue;
    // Still too little noise.
    if (found.fit->p < kExplains) continue;
    TouchDiagnosis what{TouchCause::noise};
    // chi^2 / nu of noise that is `factor` times as large is 1 with sqrt(chi^2 / nu) times that.
    what.factor = factor * std::sqrt(found.fit->chi_square / found.fit->freedom);
    if (what.factor < kLeastMoreNoise) return;  // one touch is further off than the search looks
    // The fit is that with the doubled factor, not with the refined one.
    what.fit = *found.fit;
    what.poses = found.poses.size();
    what.pose = found.poses.front().pose;
    told.push_back(what);
    return;
  }
}

/// Of so many touches every so many-th: a mistake that all have shows in them as well.
/// Outliers get their own numbers back.
std::vector<TouchDiagnosis> mistakes_of_some(const TouchProblem& problem) {
  TouchProblem some = problem;
  some.touches.clear();
  // Of the touches that are kept, in the problem.
  std::vector<std::size_t> numbers;
  for (std::size_t k = 0; k < kMostTried; ++k) {
    numbers.push_back(k * problem.touches.size() / kMostTried);
    some.touches.push_back(problem.touches[numbers.back()]);
  }
  std::vector<TouchDiagnosis> told = mistakes(some);
  for (TouchDiagnosis& what : told) {
    if (what.cause == TouchCause::outlier) what.touch = numbers[what.touch];
  }
  return told;
}

}  // namespace

/// Each candidate is solved; it is told if the search ended, a pose is left, and chi^2 is not improbable. At most
/// kMostTold are told, the noise's factor last.
std::vector<TouchDiagnosis> mistakes(const TouchProblem& problem) {
  if (problem.touches.size() > kMostTried) return mistakes_of_some(problem);
  TouchProblem cheaper = problem;
  cheaper.budget = std::min(problem.budget.value_or(kNoiseBudget), kNoiseBudget);
  // All touches count, as in the mistakes.
  cheaper.robust = false;
  std::vector<TouchDiagnosis> told;
  for (const Mistake& mistake : Mistakes(problem).all()) {
    // Paths and priors contradict touches that alone have no check.
    const bool is_of_more = mistake.what.cause == TouchCause::clear || mistake.what.cause == TouchCause::pose;
    if (!is_of_more && !is_telling(mistake.without)) continue;  // what is left contradicts nothing
    const TouchAnswer found = solve_plain(mistake.without);
    if (mistake.what.cause == TouchCause::pose && problem.touches.size() == 1) {  // which fits anywhere without it
      told.push_back(mistake.what);
      continue;
    }
    if (found.status != Status::complete || found.poses.empty()) continue;
    if (found.fit && found.fit->p < kExplains) continue;
    TouchDiagnosis what = mistake.what;
    if (found.fit) what.fit = *found.fit;
    what.poses = found.poses.size();
    what.pose = found.poses.front().pose;
    told.push_back(what);
  }
  if (problem.noise) {
    for (TouchDiagnosis& what : other_radii(cheaper)) {
      const auto is_about_it = [&](const TouchDiagnosis& one) {  // half or double the radius, more likely meant
        return one.cause == TouchCause::radius &&
               std::abs(one.radius - what.radius) <= kAboutTheRadius * problem.noise->position;
      };
      if (std::none_of(told.begin(), told.end(), is_about_it)) told.push_back(std::move(what));
    }
  }
  std::stable_sort(told.begin(), told.end(),
                   [](const TouchDiagnosis& a, const TouchDiagnosis& b) { return a.fit.p > b.fit.p; });
  // Leaves room for the noise.
  if (told.size() >= kMostTold) told.resize(kMostTold - 1);
  add_noise_factor(cheaper, told);
  return told;
}

}  // namespace touch

}  // namespace rollfix

namespace rollfix::touch {
namespace {

// Each of so many touches is left out once.
constexpr std::size_t kMostTouches = 12;

/// Some of the rolls alone, without touches and free paths: when these were made is not known.
TouchProblem some_rolls(const TouchProblem& problem, std::size_t begin, std::size_t end) {
  TouchProblem result = problem;
  result.touches.clear();
  result.clear.clear();
  result.diagnose = false;
  result.rolls.assign(problem.rolls.begin() + static_cast<std::ptrdiff_t>(begin),
                      problem.rolls.begin() + static_cast<std::ptrdiff_t>(end));
  return result;
}

/// Poses are left, all of them were found, and they do not contradict the noise.
bool fits(const TouchAnswer& answer) {
  return answer.status == Status::complete && !answer.poses.empty() && !answer.verdict.fits_badly;
}

/// What the rolls share a pose without: what was said of the pose beforehand, the free paths, or one of the touches.
/// REQUIRES that the rolls alone fit together.
std::vector<TouchDiagnosis> not_of_rolls(const TouchProblem& problem) {
  std::vector<TouchDiagnosis> told;
  const auto add = [&](TouchDiagnosis what, TouchProblem without) {
    without.diagnose = false;
    const TouchAnswer found = solve_plain(without);
    if (!fits(found)) return;
    what.poses = found.poses.size();
    what.pose = found.poses.front().pose;
    if (found.fit) what.fit = *found.fit;
    told.push_back(what);
  };
  if (problem.pose) {
    TouchProblem without = problem;
    without.pose.reset();
    add({TouchCause::pose}, without);
  }
  if (!problem.clear.empty()) {
    TouchProblem without = problem;
    without.clear.clear();
    add({TouchCause::clear}, without);
  }
  for (std::size_t k = 0; k < std::min(problem.touches.size(), kMostTouches); ++k) {
    TouchProblem without = problem;
    without.touches.erase(without.touches.begin() + static_cast<std::ptrdiff_t>(k));
    TouchDiagnosis what{TouchCause::outlier};
    what.touch = k;
    add(what, without);
  }
  return told;
}

}  // namespace

/// Empty where some roll by itself is inconsistent: then it is no question of the part's move.
std::vector<TouchDiagnosis> moved(const TouchProblem& problem, const TouchAnswer& answer) {
  std::vector<TouchDiagnosis> told;
  const auto fits_alone = [](const RollFacts& roll) {
    return roll.alone.name != Verdict::inconsistent && !roll.alone.fits_badly;
  };
  if (!std::all_of(answer.rolls.begin(), answer.rolls.end(), fits_alone)) return told;
  // If the rolls alone fit, the fault lies in what else was given.
  if (problem.pose || !problem.touches.empty() || !problem.clear.empty()) {
    TouchProblem rolls_alone = some_rolls(problem, 0, problem.rolls.size());
    rolls_alone.pose.reset();
    if (fits(solve_plain(rolls_alone))) return not_of_rolls(problem);
  }
  // Each cut into rolls 1..k and k + 1..n, both of which must fit.
  for (std::size_t k = 1; k < problem.rolls.size(); ++k) {
    if (!fits(solve_plain(some_rolls(problem, 0, k)))) continue;
    const TouchAnswer after = solve_plain(some_rolls(problem, k, problem.rolls.size()));
    if (!fits(after)) continue;
    TouchDiagnosis what{TouchCause::moved};
    what.roll = k - 1;
    what.poses = after.poses.size();
    what.pose = after.poses.front().pose;
    if (after.fit) what.fit = *after.fit;
    told.push_back(what);
  }
  return told;
}

}  // namespace rollfix::touch
