#include "pose_boxes.hpp"

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "answer_poses.hpp"
#include "outline/turn.hpp"

// Notation:
//   (X, phi)        a pose: a box is its `middle`, turned by up to `turn` about the touches' middle, then moved by up
//                   to `place` in x and in y
//   q_i, c(u)       a touch in the part's frame, and the finger's centre on the path: `in_part`, PathTree
//   delta, eps      tolerances of place and of angle: `place_most`, `angle_most`
//   slack           how far a touch moves in the part's frame over the box, at most
// Follows docs/touch.md, "How it works": the last step, where least squares have found no pose within the tolerance.
// Idea: in one pose the touches have nothing to do with each other. So a box goes when some touch is further from the
// path than tolerance and slack, a pose in which all are within the tolerance is a witness, and the rest is halved.
namespace rollfix::touch {
namespace {

// Places of a touch are looked at in pieces of this share of its tolerance; a box that is left is no larger than it.
constexpr double kFinest = 0.002;

// A box is moved only where it turns by no more, radians: what moves it turns with it.
constexpr double kLittleTurn = 0.3;

/// Poses: a middle, turned by up to so much about the touches' middle, and then moved by up to so much in x and in y.
struct PoseBox {
  Pose middle;
  double place = 0;  // half of its sides
  double turn = 0;
};

/// Whether an angle is within so much of another.
bool is_near(double one, double other, double most) { return std::abs(nearest_angle(one - other)) <= most; }

/// A place within these tolerances of a touch, or one that is not known to be outside them by more than a little.
std::optional<PathPlace> place_within(PathTree& tree, const InPart& touch, double place, double angle, bool surely) {
  boost::container::small_vector<std::int32_t, 64> waiting{tree.root()};
  while (!waiting.empty()) {
    const std::int32_t index = waiting.back();
    waiting.pop_back();
    const PathTree::Node& node = tree.node(index);
    const double off = touch.has_place ? (touch.at - node.middle).norm() : 0;
    if (touch.has_place && off - node.radius > place) continue;
    if (touch.tangent && !is_near(*touch.tangent, node.angle, angle + node.half_turn)) continue;
    if (node.is_single()) {
      const PathPlace middle{static_cast<std::size_t>(node.stretch), node.u.middle()};
      const bool is_inside =
          off <= place && (!touch.tangent || is_near(*touch.tangent, tree.path().at(middle).angle, angle));
      const bool is_small =
          (!touch.has_place || node.radius <= kFinest * place) && (!touch.tangent || node.half_turn <= kFinest * angle);
      if (is_inside || (is_small && !surely)) return middle;
      if (is_small) continue;
    }
    const auto [left, right] = tree.halves(index);
    if (left == right) continue;
    waiting.push_back(left);
    waiting.push_back(right);
  }
  return std::nullopt;
}

class BoxSearch {
 public:
  BoxSearch(PoseFit& fit, const PoseExtent& extent, std::size_t budget) : fit_(fit), extent_(extent), budget_(budget) {
    finest_ = fit.touches().front().place_most;
    for (const Measured& touch : fit.touches()) finest_ = std::min(finest_, touch.place_most);
    finest_ *= kFinest;
    for (const Measured& touch : fit.touches()) reach_ = std::max(reach_, (touch.at - fit.about()).norm());
  }

  BoxesFound search(const PoseBox& all) {
    std::vector<PoseBox> waiting{all};
    bool decided = true;
    for (std::size_t count = 0; !waiting.empty(); ++count) {
      if (count >= budget_) return {};
      const PoseBox box = waiting.back();
      waiting.pop_back();
      if (is_outside(box) || !may_fit(box)) continue;
      if (std::optional<FittedPose> witness = fits(box.middle)) return {std::move(witness), false};
      if (std::max(box.place, reach_ * box.turn) <= finest_) {
        decided = false;
        continue;
      }
      split(box, waiting);
    }
    return {std::nullopt, decided};
  }

 private:
  /// The touch that ruled out the box before is asked first: mostly it does again.
  bool may_fit(const PoseBox& box) {
    const std::size_t count = fit_.touches().size();
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t touch = (last_ + k) % count;
      if (may_fit(box, touch)) continue;
      last_ = touch;
      return false;
    }
    return true;
  }

  bool may_fit(const PoseBox& box, std::size_t which) {
    const Measured& touch = fit_.touches()[which];
    const double moved = std::numbers::sqrt2 * box.place;
    const double slack = moved + box.turn * (moved + (touch.at - fit_.about()).norm());
    return place_within(fit_.tree(which), fit_.in_part(box.middle, which), touch.place_most + slack,
                        touch.angle_most + box.turn, false)
        .has_value();
  }

  /// Whether no pose of the box is in the extent.
  bool is_outside(const PoseBox& box) const {
    const double swing = std::hypot(box.middle.x - fit_.about().x(), box.middle.y - fit_.about().y()) * box.turn;
    const double place = std::numbers::sqrt2 * box.place * (1 + box.turn) + swing;
    return !holds(extent_, box.middle, place, box.turn);
  }

  std::optional<FittedPose> fits(const Pose& pose) {
    if (!holds(extent_, pose)) return std::nullopt;
    std::vector<PathPlace> places;
    for (std::size_t k = 0; k < fit_.touches().size(); ++k) {
      const Measured& touch = fit_.touches()[k];
      const auto place = place_within(fit_.tree(k), fit_.in_part(pose, k), touch.place_most, touch.angle_most, true);
      if (!place) return std::nullopt;
      places.push_back(*place);
    }
    return fit_.at(pose, std::move(places));
  }

  /// In four, or where the turn moves the touches further in two.
  void split(const PoseBox& box, std::vector<PoseBox>& waiting) const {
    if (reach_ * box.turn > box.place || box.turn > kLittleTurn) {
      for (const double side : {-0.5, 0.5}) {
        waiting.push_back({fit_.moved(box.middle, {0, 0, side * box.turn}), box.place, 0.5 * box.turn});
      }
      return;
    }
    // The new middle's own move turns with it.
    const double place = 0.5 * box.place * (1 + std::numbers::sqrt2 * box.turn);
    for (const double x : {-0.5, 0.5}) {
      for (const double y : {-0.5, 0.5}) {
        waiting.push_back({fit_.moved(box.middle, {x * box.place, y * box.place, 0}), place, box.turn});
      }
    }
  }

  PoseFit& fit_;
  PoseExtent extent_;
  std::size_t budget_;
  double finest_ = 0;
  double reach_ = 0;
  std::size_t last_ = 0;
};

/// Around all poses of the cells.
PoseBox box_around(PoseFit& fit, const std::vector<Cell>& cells, const TouchPair& pair) {
  const Measured& first = fit.touches()[pair.first];
  const auto pose_of = [&](const Cell& cell) {
    const PathTree::Node& node = fit.tree(pair.first).node(cell.first);
    return fit.pose_at({pair.first, {static_cast<std::size_t>(node.stretch), node.u.middle()}}, cell.heading.middle);
  };
  PoseBox box{pose_of(cells.front()), 0, 0};
  for (const Cell& cell : cells) {
    const Pose pose = pose_of(cell);
    const double turn = nearest_angle(pose.heading - box.middle.heading);
    const Pose turned = fit.moved(box.middle, {0, 0, turn});
    const double swing = (first.at - fit.about()).norm() * cell.heading.half;
    const double slack = fit.tree(pair.first).node(cell.first).radius + first.place_most + swing;
    box.place = std::max(box.place, std::hypot(pose.x - turned.x, pose.y - turned.y) + slack);
    box.turn = std::max(box.turn, std::abs(turn) + cell.heading.half);
  }
  box.turn = std::min(box.turn, std::numbers::pi);
  return box;
}

}  // namespace

BoxesFound search_boxes(PoseFit& fit, const std::vector<Cell>& cells, const TouchPair& pair, std::size_t budget) {
  return BoxSearch(fit, extent_of(fit, cells, pair, {0, 0, cells.front().heading.middle}), budget)
      .search(box_around(fit, cells, pair));
}

}  // namespace rollfix::touch
