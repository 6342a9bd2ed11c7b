#include "outlier_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "all_contacts.hpp"
#include "answer_poses.hpp"
#include "pose_fit.hpp"

// Idea: of most + 1 groups of touches one at least has no outlier, if there are no more than `most`. So every pose is
// among those that the groups leave by themselves. From each of them: the touches that don't fit it are left out, the
// others say the pose better, and so on until the touches that don't fit stay the same.
namespace rollfix::touch {
namespace {

// A touch that counts is in doubt beyond so many standard deviations: nearer it is an outlier once in a thousand times.
constexpr double kInDoubt = 2.5;

class Candidates {
 public:
  Candidates(const TouchProblem& of_touches, double radius, std::size_t most, const SolveWithout& solve_without)
      : contacts_(of_touches, radius), fit_(contacts_.each, {}), most_(most), solve_without_(solve_without) {}

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
    std::size_t count = std::min(beyond(pose, kTouchSigmas).size(), most_);
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
      Outliers next = beyond(pose, kTouchSigmas);
      if (next.size() > most_) return;
      std::sort(next.begin(), next.end());
      const bool all_are_out = std::includes(outliers.begin(), outliers.end(), next.begin(), next.end());
      if (all_are_out) add(outliers, beyond(pose, kInDoubt));
      count = next.size();
    }
  }

  /// Touches that are further off than so many standard deviations, their own and the pose's; the furthest first.
  Outliers beyond(const TouchPose& pose, double sigmas) const {
    std::vector<std::pair<double, std::size_t>> outliers;
    const Eigen::Matrix3d& covariance = pose.spread.covariance;
    for (std::size_t k = 0; k < contacts_.each.size(); ++k) {
      const Measured& touch = contacts_.each[k];
      const Pose& mean = pose.spread.mean;
      const TouchContact contact = nearest_contact(fit_, mean, k);
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

  AllContacts contacts_;
  PoseFit fit_;
  std::size_t most_;
  const SolveWithout& solve_without_;
  std::set<Outliers> tried_;
  std::set<Outliers> found_;
};

}  // namespace

std::set<Outliers> outlier_candidates(const TouchProblem& problem, double radius, std::size_t most,
                                      const SolveWithout& solve_without) {
  TouchProblem of_touches = problem;
  of_touches.rolls.clear();
  return Candidates(of_touches, radius, most, solve_without).find();
}

}  // namespace rollfix::touch
