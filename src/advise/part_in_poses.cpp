#include "advise/part_in_poses.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "outline/turn.hpp"

namespace rollfix::touch {
namespace {

// Approaches where none are given: directions all around, and parallel ways in each.
constexpr int kDirections = 36;
constexpr std::size_t kParallel = 7;
// In a hole they start at places that are so far apart, a share of its diagonal, and are looked for among so many.
constexpr double kApart = 0.02;
constexpr std::size_t kMostPlaces = 40;

/// Probability of the poses in which the finger touches nothing there.
double share_free(PartInPoses& lying, const Vec2& at) {
  double share = 0;
  for (const LikelyPose& one : lying.poses()) {
    if (lying.part().nearest(lying.in_part(one, at)).distance > lying.answer().radius) share += one.weight;
  }
  return share;
}

/// Where the hole's middle is in the likeliest poses, if it is free in all of them; else where it is in most.
std::vector<Vec2> places_within(PartInPoses& lying) {
  const Vec2 middle = lying.part().middle_of_hole();
  std::vector<std::pair<double, Vec2>> places;
  for (const LikelyPose& one : lying.poses()) {
    const Vec2 place = lying.in_world(one, middle);
    const bool is_known = std::any_of(places.begin(), places.end(), [&](const auto& known) {
      return (known.second - place).norm() < kApart * lying.part().diagonal();
    });
    if (!is_known && places.size() < kMostPlaces) places.emplace_back(share_free(lying, place), place);
  }
  std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Vec2> result;
  for (const auto& [share, place] : places) {
    if (share >= places.front().first && result.size() < kParallel) result.push_back(place);
  }
  return result;
}

}  // namespace

PartInPoses::PartInPoses(const TouchAnswer& answer, std::vector<LikelyPose> poses)
    : answer_(answer), poses_(std::move(poses)), part_(answer.part) {
  const std::vector<Vec2> outline = answer_.part.polyline(0, answer_.part.perimeter(), 200);
  Vec2 least = Vec2::Constant(std::numeric_limits<double>::infinity()), most = -least;
  for (const LikelyPose& one : poses_) {
    for (const Vec2& point : outline) {
      const Vec2 world = in_world(one, point);
      least = least.cwiseMin(world);
      most = most.cwiseMax(world);
    }
  }
  for (const Vec2& point : outline) farthest_ = std::max(farthest_, point.norm());
  middle_ = 0.5 * (least + most);
  reach_ = 0.5 * (most - least).norm();
}

Vec2 PartInPoses::in_part(const LikelyPose& one, const Vec2& at) const {
  return mirrored(Pose{0, 0, -one.pose.heading}.turned(at - Vec2(one.pose.x, one.pose.y)));
}

std::vector<Approach> approaches_around(PartInPoses& lying) {
  std::vector<Approach> approaches;
  if (lying.part().is_hole()) {
    for (const Vec2& from : places_within(lying)) {
      for (int k = 0; k < kDirections; ++k) approaches.push_back({from, kFullTurn * k / kDirections});
    }
    return approaches;
  }
  for (int k = 0; k < kDirections; ++k) {
    const double direction = kFullTurn * k / kDirections;
    const Vec2 along(std::cos(direction), std::sin(direction));
    const Vec2 across(-along.y(), along.x());
    for (std::size_t i = 0; i < kParallel; ++i) {
      const double off = ((2.0 * static_cast<double>(i) + 1) / kParallel - 1) * lying.reach();
      approaches.push_back(
          {lying.middle() + off * across - (lying.reach() + lying.answer().radius) * along, direction});
    }
  }
  return approaches;
}

}  // namespace rollfix::touch
