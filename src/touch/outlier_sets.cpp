#include "steps.hpp"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "belief/posterior.hpp"
#include "measured.hpp"
#include "pose_fit.hpp"
#include "problem.hpp"
#include "rollfix/touch.hpp"

// Notation:
//   S        a set of touches that are outliers; the other touches count, and all rolls
//   e        probability of a touch to be an outlier: belief::kOutlierShare
//   c_k      density of a touch that is nowhere off: of its place 1 / (2 pi sd^2), of its normal 1 / (sqrt(2 pi) sd)
//   q_k      density of an outlier: of its place 1 / P^2, of its normal 1 / (2 pi)
//   Z(S)     likelihood of what counts, averaged over where it can be on the part, summed over poses (x, y, heading);
//            `log_evidence` is its logarithm less that of (2 pi)^(3/2) and of all c_k
//   w(S)     (e / (1 - e))^|S| Z(S) prod_S q_k / c_k: the probability of S, but for one factor
// The mixture of docs/touch.md, "Outliers". Sets are looked at by their size, as the larger ones are the less probable.
// Idea, of many touches: of `most` + 1 groups one at least has no outlier, if there are no more than `most`. So every
// pose is among those that the groups leave by themselves. From each of them: the touches that don't fit it are left
// out, the others say the pose better, and so on until the touches that don't fit stay the same.
namespace rollfix::touch {
namespace {

/// Numbers of touches, ascending.
using Outliers = std::vector<std::size_t>;
/// The answer by all touches but these.
using SolveWithout = std::function<TouchAnswer(const Outliers&)>;

// A touch that counts is in doubt beyond so many standard deviations: nearer it is an outlier once in a thousand times.
constexpr double kInDoubt = 2.5;

/// Sets of outliers found from poses, instead of trying all sets.
class Candidates {
 public:
  /// `of_touches`: without its rolls, so that a touch's number is its contact's. `most`: outliers at most.
  /// `solve_without` counts the rolls as well.
  Candidates(const TouchProblem& of_touches, double radius, std::size_t most, const SolveWithout& solve_without)
      : contacts_(of_touches, radius), fit_(contacts_.each, {}), most_(most), solve_without_(solve_without) {}

  /// Touch k is in group k mod (most + 1). With at most `most` outliers one group at least is without, and its pose is
  /// followed from there.
  std::set<Outliers> find() {
    const std::size_t groups = most_ + 1;
    for (std::size_t group = 0; group < groups; ++group) {
      Outliers others;
      for (std::size_t k = 0; k < contacts_.each.size(); ++k) {
        if (k % groups != group) others.push_back(k);
      }
      for (const TouchPose& pose : solve_without_(others).poses) follow(pose);
    }
    return std::move(found_);
  }

 private:
  /// A group's pose may be known so badly that more touches seem to be off, or fewer: the worst of them are left out,
  /// and one more where the others still fit nowhere together.
  void follow(const TouchPose& from) {
    TouchPose pose = from;
    std::size_t count = std::min(beyond(pose, kPossibleSigmas).size(), most_);
    // `pose` is by the touches outside of the last set tried. `tried_` ends loops: no set is followed twice.
    for (;;) {
      Outliers outliers = beyond(pose, 0);
      outliers.resize(std::min(outliers.size(), count));
      std::sort(outliers.begin(), outliers.end());
      if (!tried_.insert(outliers).second) return;
      TouchAnswer answer = solve_without_(outliers);
      if (answer.poses.empty()) {
        if (++count > most_) return;
        continue;
      }
      pose = std::move(answer.poses.front());
      Outliers next = beyond(pose, kPossibleSigmas);
      // More outliers than there is any chance of.
      if (next.size() > most_) return;
      std::sort(next.begin(), next.end());
      // Each touch that does not fit the pose is among the outliers: the set explains itself.
      const bool all_are_out = std::includes(outliers.begin(), outliers.end(), next.begin(), next.end());
      if (all_are_out) add(outliers, beyond(pose, kInDoubt));
      count = next.size();
    }
  }

  /// Touches that are further off than so many standard deviations, their own and the pose's; the furthest first.
  /// Each touch's residuals from its nearest place, squared, by the touch's own variance and that of the pose there.
  Outliers beyond(const TouchPose& pose, double sigmas) const {
    std::vector<std::pair<double, std::size_t>> outliers;
    const Eigen::Matrix3d& covariance = pose.spread.covariance;
    for (std::size_t k = 0; k < contacts_.each.size(); ++k) {
      const Measured& touch = contacts_.each[k];
      const Pose& mean = pose.spread.mean;
      const TouchContact contact = nearest_contact(fit_, mean, k);
      // d(touch) / d(x, y, phi) of what moves with the part.
      Eigen::Matrix<double, 2, 3> moved;
      moved << Eigen::Matrix2d::Identity(), turned_left(touch.at - Vec2(mean.x, mean.y));
      const double place =
          touch.place_unit * touch.place_unit + (moved * covariance * moved.transpose()).eval().trace();
      const double turn = touch.angle_unit * touch.angle_unit + covariance(2, 2);
      const double off = (touch.has_place ? contact.distance * contact.distance / place : 0) +
                         (touch.tangent ? *contact.turn * *contact.turn / turn : 0);
      if (off >= sigmas * sigmas) outliers.emplace_back(-off, k);
    }
    std::sort(outliers.begin(), outliers.end());
    Outliers numbers;
    for (const auto& [off, k] : outliers) numbers.push_back(k);
    return numbers;
  }

  /// The set itself, and each one that has one touch more that is in doubt, or one outlier less.
  void add(const Outliers& outliers, const Outliers& in_doubt) {
    found_.insert(outliers);
    std::set<std::size_t> others(in_doubt.begin(), in_doubt.end());
    others.insert(outliers.begin(), outliers.end());
    for (const std::size_t k : others) {
      Outliers other = outliers;
      const auto at = std::lower_bound(other.begin(), other.end(), k);
      if (at != other.end() && *at == k) {
        other.erase(at);
      } else {
        other.insert(at, k);
      }
      found_.insert(std::move(other));
    }
  }

  // Of all touches.
  AllContacts contacts_;
  PoseFit fit_;
  std::size_t most_;
  const SolveWithout& solve_without_;
  std::set<Outliers> tried_;
  std::set<Outliers> found_;
};

/// Of many touches the sets of outliers that count: for each pose that all touches fit but `most`, or fewer, those that
/// do not, and sets that differ from them by one touch that is in doubt.
std::set<Outliers> outlier_candidates(const TouchProblem& problem, double radius, std::size_t most,
                                      const SolveWithout& solve_without) {
  TouchProblem of_touches = problem;
  of_touches.rolls.clear();
  return Candidates(of_touches, radius, most, solve_without).find();
}

// Larger sets are not looked at where all of one size have no more than this share: the next ones have about half its
// square, ...
constexpr double kNegligibleSize = 0.03;
// ... nor where chance makes so many outliers no more often than this.
constexpr double kLeastChance = 2e-4;
// So many touches and more leave few enough poses to look only at the sets of outliers that these leave.
constexpr std::size_t kLeastGroup = 3;
// From so many on there are too many sets to look at all of them.
constexpr std::size_t kManyTouches = 20;
constexpr double kNone = -std::numeric_limits<double>::infinity();

/// Probability that at least so many of `all` touches are outliers.
/// The binomial distribution's upper tail, as an incomplete beta function.
double chance_of(std::size_t outliers, std::size_t all) {
  if (outliers == 0) return 1;
  if (outliers > all) return 0;
  return boost::math::ibeta(static_cast<double>(outliers), static_cast<double>(all - outliers + 1),
                            belief::kOutlierShare);
}

/// As many as there is any chance of.
/// The largest number that chance makes more often than kLeastChance.
std::size_t most_outliers(std::size_t touches) {
  std::size_t most = 0;
  while (most < touches && chance_of(most + 1, touches) > kLeastChance) ++most;
  return most;
}

/// The next choice of as many of `count` things, in the order of their numbers; false after the last one.
/// `chosen`: ascending, REQUIRES at least one.
bool choose_next(Outliers& chosen, std::size_t count) {
  for (std::size_t k = chosen.size(); k-- > 0;) {
    // It is as large as it can be: the one before has to grow.
    if (chosen[k] == count - chosen.size() + k) continue;
    ++chosen[k];
    for (std::size_t next = k + 1; next < chosen.size(); ++next) chosen[next] = chosen[next - 1] + 1;
    return true;
  }
  return false;
}

/// log(e^a + e^b); of two that are minus infinity that.
double log_sum(double a, double b) {
  const double more = std::max(a, b);
  return std::isinf(more) ? more : more + std::log1p(std::exp(std::min(a, b) - more));
}

/// log(1 / c_k), and log q_k.
/// Units: length^2 for a place, radians for a normal; 0 of what was not measured.
double log_width(const Measured& touch) {
  return (touch.has_place ? std::log(2 * std::numbers::pi) + 2 * std::log(touch.place_unit) : 0) +
         (touch.tangent ? 0.5 * std::log(2 * std::numbers::pi) + std::log(touch.angle_unit) : 0);
}

double log_of_outlier(const Measured& touch, double perimeter) {
  return -(touch.has_place ? 2 * std::log(perimeter) : 0) - (touch.tangent ? std::log(2 * std::numbers::pi) : 0);
}

/// The sum over sets S of touches that are outliers, docs/touch.md, "Outliers".
class OutlierSets {
 public:
  OutlierSets(const TouchProblem& problem, const SolveCounted& solve_counted, TouchAnswer& answer)
      : problem_(problem), solve_counted_(solve_counted), answer_(answer), touches_(measured(problem)) {}

  /// First no outliers, S = {}: it tells facts of the answer that do not depend on S. If all touches together leave the
  /// pose open, so does any set.
  void solve() {
    add({});
    if (std::isfinite(log_anywhere_)) return leave_open();
    const std::size_t most = most_outliers(touches_.size());
    const bool are_many = touches_.size() >= kLeastGroup * (most + 1);
    // From kManyTouches on only candidates are looked at.
    const bool any_found = are_many && add_candidates(most);
    if (!any_found && touches_.size() < kManyTouches) add_all(most);
    finish();
  }

 private:
  /// By size, 1 to `most`. Ends early where all sets of one size have a share of kNegligibleSize at most, and the best
  /// set so far fits: larger sets are less probable still.
  void add_all(std::size_t most) {
    for (std::size_t size = 1; size <= most; ++size) {
      // The first choice: 0, 1, ...
      Outliers outliers(size);
      for (std::size_t k = 0; k < size; ++k) outliers[k] = k;
      double of_size = kNone;
      do {
        of_size = log_sum(of_size, add(outliers));
      } while (choose_next(outliers, touches_.size()));
      if (of_size <= log_total_ + std::log(kNegligibleSize) && leader_fits()) return;
    }
  }

  /// False: there are none.
  bool add_candidates(std::size_t most) {
    const auto solve_without = [&](const Outliers& outliers) { return without(outliers); };
    const std::set<Outliers> candidates = outlier_candidates(problem_, answer_.radius, most, solve_without);
    for (const Outliers& outliers : candidates) {
      if (!outliers.empty()) add(outliers);
    }
    return !candidates.empty();
  }

  /// Takes what the others say into account; the logarithm of the set's weight.
  /// log w(S). Minus infinity where nothing fits the others, or their evidence is not known.
  double add(const Outliers& outliers) {
    double log_weight = 0;
    for (const std::size_t k : outliers) {
      log_weight += std::log(belief::kOutlierShare / (1 - belief::kOutlierShare)) +
                    log_of_outlier(touches_[k], problem_.part.perimeter()) + log_width(touches_[k]);
    }
    TouchAnswer counted = without(outliers);
    const bool is_open = counted.verdict.name == Verdict::unobservable && counted.poses.empty();
    // log Z(S): as the counted solve says, or of an open pose in closed form.
    log_weight += is_open                            ? log_evidence_anywhere(outliers)
                  : std::isnan(counted.log_evidence) ? kNone
                                                     : counted.log_evidence;
    if (outliers.empty()) take_facts(counted);
    take_unresolved(outliers, counted);
    if (!std::isfinite(log_weight)) return kNone;
    log_total_ = log_sum(log_total_, log_weight);
    log_anywhere_ = is_open ? log_sum(log_anywhere_, log_weight) : log_anywhere_;
    log_outlier_.resize(touches_.size(), kNone);
    for (const std::size_t k : outliers) log_outlier_[k] = log_sum(log_outlier_[k], log_weight);
    if (is_open) return log_weight;
    // The leader: the most probable set so far, whose fit is told.
    if (log_weight > log_leader_) {
      log_leader_ = log_weight;
      answer_.fit = counted.fit;
      answer_.verdict.fits_badly = counted.verdict.fits_badly;
      answer_.improbable = counted.improbable;
    }
    mixture_.add(std::move(counted.poses), outliers, log_weight);
    return log_weight;
  }

  /// The answer by all touches but these.
  /// Unobservable, without a search, where there are no rolls and no touch that counts has a place.
  TouchAnswer without(const Outliers& outliers) const {
    TouchProblem counted = problem_;
    counted.touches.clear();
    for (std::size_t k = 0; k < problem_.touches.size(); ++k) {
      if (!std::binary_search(outliers.begin(), outliers.end(), k)) counted.touches.push_back(problem_.touches[k]);
    }
    TouchAnswer answer{problem_.part, counted.touches};
    answer.radius = answer_.radius;
    answer.noise = problem_.noise;
    const bool has_place =
        !problem_.rolls.empty() || std::any_of(counted.touches.begin(), counted.touches.end(),
                                               [](const MeasuredTouch& touch) { return touch.has_place(); });
    answer.verdict.name = Verdict::unobservable;
    if (has_place) solve_counted_(counted, answer);
    return answer;
  }

  /// Of touches that leave the pose open: one, or several at one place, which agree at best.
  /// log Z(S) of the others: the integral of their likelihood over all poses. Every place on the boundary is as good,
  /// so only what the touches do not tell counts: the place, P^2 or the prior's 2 pi sd^2, and the heading, 2 pi or the
  /// prior's sqrt(2 pi) sd. Each further touch divides by P sd sqrt(4 pi).
  double log_evidence_anywhere(const Outliers& outliers) const {
    const double perimeter = problem_.part.perimeter();
    double log_evidence = -1.5 * std::log(2 * std::numbers::pi);
    bool has_place = false, has_normal = false;
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      if (std::binary_search(outliers.begin(), outliers.end(), k)) continue;
      const Measured& touch = touches_[k];
      if (has_place) log_evidence -= std::log(perimeter * touch.place_unit * std::sqrt(4 * std::numbers::pi));
      log_evidence += log_width(touch);
      has_place |= touch.has_place;
      has_normal |= touch.tangent.has_value();
    }
    const double turn = std::log(2 * std::numbers::pi);
    const std::optional<PosePrior>& prior = problem_.pose;
    if (!has_place) {
      const bool is_known = prior && std::isfinite(prior->place_sd);
      log_evidence += is_known ? turn + 2 * std::log(prior->place_sd) : 2 * std::log(perimeter);
    }
    if (!has_normal) log_evidence += prior ? 0.5 * turn + std::log(prior->heading_sd) : turn;
    return log_evidence;
  }

  /// All touches leave the pose open, outliers or not.
  void leave_open() {
    answer_.anywhere = 1;
    answer_.outlier.assign(touches_.size(), belief::kOutlierShare);
    answer_.log_evidence = 0;  // the same on any part
  }

  /// Of the solve without outliers.
  void take_facts(const TouchAnswer& counted) {
    answer_.tolerance = counted.tolerance;
    answer_.rolls = counted.rolls;
    answer_.place = counted.place;
  }

  /// Arcs that were not decided, of the first set that has some.
  void take_unresolved(const Outliers& outliers, const TouchAnswer& counted) {
    answer_.comparisons += counted.comparisons;
    if (counted.status == Status::complete || !answer_.unresolved.empty()) return;
    answer_.unresolved = counted.unresolved;
    answer_.unresolved_touch = counted.unresolved_touch;
    for (const std::size_t k : outliers) {
      // Contacts of the counted solve are numbered without the outliers: numbers after each grow by one.
      if (problem_.rolls.size() + k <= answer_.unresolved_touch) ++answer_.unresolved_touch;
    }
  }

  /// The best set has weight and does not contradict the noise.
  bool leader_fits() const {
    return std::isfinite(log_leader_) && !answer_.verdict.fits_badly && !(answer_.fit && answer_.fit->is_bad());
  }

  /// Shares of the sum of all weights; (1 - e)^n, for n touches, is the factor that all w(S) lack.
  void finish() {
    if (!std::isfinite(log_total_)) return;
    answer_.log_evidence = log_total_ + static_cast<double>(touches_.size()) * std::log(1 - belief::kOutlierShare);
    answer_.anywhere = std::exp(log_anywhere_ - log_total_);
    for (const double one : log_outlier_) answer_.outlier.push_back(std::exp(one - log_total_));
    mixture_.finish(problem_, log_total_, answer_);
  }

  const TouchProblem& problem_;
  const SolveCounted& solve_counted_;
  TouchAnswer& answer_;
  std::vector<Measured> touches_;
  PoseMixture mixture_;
  // Logs of sums of w(S): of all sets, of those that leave the pose open, and the largest w.
  double log_total_ = kNone;
  double log_anywhere_ = kNone;
  double log_leader_ = kNone;
  // Of each touch: the sum over the sets in which it is an outlier.
  std::vector<double> log_outlier_;
};

}  // namespace

void solve_with_outliers(const TouchProblem& problem, const SolveCounted& solve_counted, TouchAnswer& answer) {
  OutlierSets(problem, solve_counted, answer).solve();
}

bool has_many_outliers(const TouchAnswer& answer) {
  if (answer.poses.empty()) return false;
  return chance_of(answer.poses.front().outliers.size(), answer.touches.size()) < TouchFit::kLeastP;
}

}  // namespace rollfix::touch
