// How probable each part is, against a plain sum over all poses and all places of every contact.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "catalogs.hpp"
#include "random.hpp"
#include "rollfix/identify.hpp"
#include "touch/touch_cases.hpp"

namespace identify_evidence_test {

using namespace touch_cases;
using catalogs::Catalog;

/// In the part's frame: the likelihood of a touch there of which nothing is known but that it is somewhere on the
/// boundary, on a grid.
class OneTouch {
 public:
  OneTouch(const Part& part, double sd) : step_(0.25 * sd), margin_(6 * sd) {
    const int count = 1000;
    const std::vector<Vec2> points = part.polyline(0, part.perimeter(), count);
    Vec2 most = points.front();
    least_ = points.front();
    for (const Vec2& point : points) {
      least_ = least_.cwiseMin(point);
      most = most.cwiseMax(point);
    }
    least_ -= Vec2(margin_, margin_);
    width_ = static_cast<int>((most.x() + margin_ - least_.x()) / step_) + 2;
    height_ = static_cast<int>((most.y() + margin_ - least_.y()) / step_) + 2;
    values_.assign(static_cast<std::size_t>(width_ * height_), 0);
    for (int k = 0; k < count; ++k) add(points[static_cast<std::size_t>(k)], sd, 1.0 / count);
  }

  double at(const Vec2& place) const {
    const Vec2 cell = (place - least_) / step_;
    const int i = static_cast<int>(std::floor(cell.x())), j = static_cast<int>(std::floor(cell.y()));
    if (i < 0 || j < 0 || i + 1 >= width_ || j + 1 >= height_) return 0;
    const double x = cell.x() - i, y = cell.y() - j;
    return (1 - x) * ((1 - y) * value(i, j) + y * value(i, j + 1)) +
           x * ((1 - y) * value(i + 1, j) + y * value(i + 1, j + 1));
  }

  /// The integral over all poses of the likelihoods of all touches: with the first at any place, and any heading.
  double of_all(const std::vector<MeasuredTouch>& touches, int headings) const {
    double sum = 0;
    for (int h = 0; h < headings; ++h) {
      const Pose turn{0, 0, -kFullTurn * h / headings};
      std::vector<Vec2> apart;
      for (const MeasuredTouch& touch : touches) apart.push_back(turn.turned(touch.at - touches.front().at));
      for (int i = 0; i < width_; ++i) {
        for (int j = 0; j < height_; ++j) {
          double product = value(i, j);
          for (std::size_t k = 1; k < apart.size() && product > 0; ++k) {
            product *= at(least_ + step_ * Vec2(i, j) + apart[k]);
          }
          sum += product;
        }
      }
    }
    return sum * step_ * step_ * kFullTurn / headings;
  }

 private:
  double value(int i, int j) const { return values_[static_cast<std::size_t>(i * height_ + j)]; }

  void add(const Vec2& point, double sd, double share) {
    const auto range = [&](double middle) {
      return std::pair{static_cast<int>((middle - margin_) / step_), static_cast<int>((middle + margin_) / step_) + 1};
    };
    const Vec2 own = point - least_;
    const auto [x_from, x_to] = range(own.x());
    const auto [y_from, y_to] = range(own.y());
    for (int i = std::max(0, x_from); i < std::min(width_, x_to); ++i) {
      for (int j = std::max(0, y_from); j < std::min(height_, y_to); ++j) {
        values_[static_cast<std::size_t>(i * height_ + j)] +=
            share * std::exp(-0.5 * (step_ * Vec2(i, j) - own).squaredNorm() / (sd * sd));
      }
    }
  }

  double step_, margin_;
  Vec2 least_ = Vec2::Zero();
  int width_ = 0, height_ = 0;
  std::vector<double> values_;
};

TEST(PartByTouches, is_as_probable_as_a_sum_over_all_poses_says) {
  const cli::Folder folder;
  const Catalog catalog =
      catalogs::of({"spline,n=9,wobble=0.2,seed=1", "spline,n=9,wobble=0.2,seed=2", "ellipse,a=1.2,b=0.9"});
  for (int k = 0; k < test_count(3); ++k) {
    std::mt19937_64 generator = test_generator(static_cast<std::uint64_t>(k));
    const double sd = 0.03;
    const Part touched = catalog.part(static_cast<std::size_t>(k) % 3);
    const TouchProblem problem = random_case(touched, {4, 0, 0, sd, 0}, generator).problem;
    std::vector<double> expected;
    double total = 0;
    for (std::size_t part = 0; part < 3; ++part) {
      expected.push_back(OneTouch(catalog.part(part), sd).of_all(problem.touches, 180));
      total += expected.back();
    }
    for (const rollfix::PartTouched& part : identify(catalog, problem).parts) {
      EXPECT_NEAR(part.probability, expected[part.part] / total, 0.03)
          << catalog.entry(part.part).name << ", case " << k;
    }
  }
}

}  // namespace identify_evidence_test
