// The part and the fingers in the world, and how sure the part's pose is.

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "draw/answer/answer_plan.hpp"
#include "draw/answer/densities.hpp"
#include "draw/labels.hpp"
#include "draw/posed_part.hpp"
#include "outline/turn.hpp"
#include "rollfix/log.hpp"

namespace rollfix::draw {
namespace {

constexpr double kWorldShare = 0.44;  // of the page's width
constexpr double kWorldLeft = 54;     // around the frame, pixels
constexpr double kWorldRight = 14;
constexpr double kWorldAbove = 26;
constexpr double kWorldBelow = 32;  // ... to the first line of words
constexpr double kWordsLine = 14;
constexpr double kWordsSize = 10.5;
constexpr double kMostSpreadSeen = 0.4;     // of the part's size, beyond the part
constexpr double kWorldMargin = 0.06;       // around what is shown, as a share of it
constexpr double kPoseWorthDrawing = 0.01;  // probability
constexpr std::size_t kMostPoses = 6;
constexpr double kHeadingShare = 0.3;      // length of the arrow along the part's x axis, of the part's size
constexpr double kSmallEllipse = 9;        // pixels: a smaller half axis is drawn larger, and the factor is told
constexpr double kSmallFan = 3 * kDegree;  // likewise
constexpr double kOriginNear = 0.25;       // the part's origin is shown where it is no further from it, of its size
constexpr double kUnknownHeading = 1;      // radians: with a larger standard deviation there is no heading to speak of
constexpr double kGhostOpacity = 0.3;
constexpr int kDiskSides = 72;
constexpr int kOutlineSides = 200;
constexpr std::string_view kWorldFinger = "#8a8a8a";

std::vector<std::size_t> posed_rows(const AnswerPlan& plan) {
  std::vector<std::size_t> chosen;
  const std::size_t first = plan.world_placement();
  for (std::size_t k = 0; k < plan.placements().size() && chosen.size() < kMostPoses; ++k) {
    const Placement& placement = plan.placements()[k];
    const bool counts = !plan.has_noise() || placement.probability >= kPoseWorthDrawing;
    if (k != first && counts && !placement.pose.empty() && !plan.has_pairs()) chosen.push_back(k);
  }
  chosen.push_back(first);  // on top
  return chosen;
}

Pose first_pose(const Placement& placement) {
  return placement.pose_spread ? placement.pose_spread->mean : placement.pose.front();
}

class WorldPicture {
 public:
  WorldPicture(Svg& svg, const AnswerPlan& plan, const Box& area)
      : svg_(svg), plan_(plan), log_(*plan.figure->log), shown_(posed_rows(plan)) {
    size_ = plan.framing.part.sizes().maxCoeff();
    outline_ = coarse_outline(plan.part(), size_).points;
    middle_ = pivot();
    frame(area);
  }

  void draw() {
    svg_.open_group("world");
    draw_axes(svg_, axes_, round_ticks(axes_.x, 5), round_ticks(axes_.y, 5), title(), "");
    svg_.open_clip(axes_.corner.x(), axes_.corner.y(), axes_.size.x(), axes_.size.y());
    for (const std::size_t k : shown_) part_at(k);
    later_pose();
    for (std::size_t finger = 0; finger < log_.fingers.size(); ++finger) finger_path(finger);
    uncertainty();
    svg_.close_group();
    words();
    svg_.close_group();
  }

 private:
  const Placement& main() const { return plan_.placements()[shown_.back()]; }
  std::string_view colour_of(std::size_t k) const { return plan_.has_pairs() ? kInk : plan_.colour_of(k, 0); }

  /// The point of the part whose uncertainty is drawn: the origin of its frame, which the pose says, or its middle.
  Vec2 pivot() const {
    const Box& bounds = plan_.framing.part;
    const Vec2 near = Vec2::Constant(kOriginNear * size_);
    const bool has_origin = Box(bounds.min() - near, bounds.max() + near).contains(Vec2(0, 0));
    return has_origin ? Vec2(0, 0) : Vec2(bounds.center());
  }

  const Finger& finger_at(std::size_t which) const { return *finger_of(plan_.figure->answer->fingers, which); }

  Pose finger_pose(std::size_t which, std::size_t row) const {
    const FingerRows& rows = log_.fingers[which];
    return {rows.x[row], rows.y[row], rows.psi[row]};
  }

  std::vector<Vec2> rim(std::size_t which, std::size_t row) const {
    const Finger& finger = finger_at(which);
    return posed(shape_of(finger, finger.is_disk() ? kDiskSides : kOutlineSides, size_), finger_pose(which, row));
  }

  std::vector<Vec2> on_page(const std::vector<Vec2>& points) const {
    std::vector<Vec2> out;
    for (const Vec2& point : points) out.push_back(axes_(point.x(), point.y()));
    return pick(out, simplify(out, kInvisible, kMostVertices));
  }

  /// Chooses what is seen: all parts, and the fingers at both ends of the roll.
  void frame(const Box& area) {
    Box seen;
    for (const std::size_t k : shown_) seen.extend(box_around(posed(outline_, first_pose(plan_.placements()[k]))));
    if (plan_.has_pairs()) seen.extend(box_around(posed(outline_, main().pose.back())));
    for (std::size_t finger = 0; finger < log_.fingers.size(); ++finger) {
      for (const std::size_t row : {std::size_t{0}, log_.rows() - 1}) {
        seen.extend(box_around(rim(finger, row)));
      }
    }
    for (const FingerRows& rows : log_.fingers) {
      for (std::size_t row = 0; row < rows.x.size(); ++row) seen.extend(Vec2(rows.x[row], rows.y[row]));
    }
    include_spread(seen);
    const double below = kWorldBelow + kWordsLine * static_cast<double>(most_lines());
    axes_.corner = area.min() + Vec2(kWorldLeft, kWorldAbove);
    axes_.size = area.sizes() - Vec2(kWorldLeft + kWorldRight, kWorldAbove + below);
    const Vec2 needed = (1 + 2 * kWorldMargin) * seen.sizes();
    scale_ = std::min(axes_.size.x() / needed.x(), axes_.size.y() / needed.y());
    // No more frame than is needed: what is not seen is not there.
    const Vec2 half = 0.5 * axes_.size / scale_, centre = seen.center();
    axes_.x = {centre.x() - half.x(), centre.x() + half.x()};
    axes_.y = {centre.y() - half.y(), centre.y() + half.y()};
  }

  /// The ellipse, unless it reaches too far.
  void include_spread(Box& seen) const {
    if (!main().pose_spread || heading_sd(*main().pose_spread) >= kUnknownHeading) return;
    const Vec2 reach = Vec2::Constant(kMostSpreadSeen * size_);
    const Vec2 lo = seen.min() - reach, hi = seen.max() + reach;
    const Vec2 at = main().pose_spread->mean.world(middle_);
    for (const Vec2& point : ellipse(at, place_covariance(*main().pose_spread), kEllipse95)) {
      seen.extend(point.cwiseMax(lo).cwiseMin(hi));
    }
  }

  Text title() const {
    Text text = {{"in the world"}};
    if (!plan_.part().unit().empty()) text.push_back({", " + plan_.part().unit()});
    return text;
  }

  void part_at(std::size_t k) {
    const bool is_main = k == shown_.back();
    const std::vector<Vec2> path = on_page(posed(outline_, first_pose(plan_.placements()[k])));
    svg_.open_group(is_main ? "part" : "other-pose");
    Paint paint = stroke(colour_of(k), is_main ? 1.6 : 1, is_main ? "" : "5 3", is_main ? 1 : 0.8);
    const bool is_solid = is_main && plan_.part().closed() && plan_.part().turns() > 0;
    if (is_solid) paint.fill = std::string(kMaterial);
    if (plan_.part().closed()) {
      svg_.polygon(path, paint);
    } else {
      svg_.polyline(path, paint);
    }
    for (std::size_t other = 0; is_main && other < plan_.figure->others.size(); ++other) {
      const std::vector<Vec2> loop = posed(polyline_of(plan_.figure->others[other]), first_pose(main()));
      svg_.polyline(on_page(loop), stroke(kSoftInk, 0.7));
    }
    svg_.close_group();
  }

  /// Where two fingers have moved it to.
  void later_pose() {
    if (!plan_.has_pairs()) return;
    svg_.open_group("last-pose");
    svg_.polyline(on_page(posed(outline_, main().pose.back())), stroke(kInk, 0.9, "5 3"));
    svg_.close_group();
  }

  void finger_path(std::size_t which) {
    const FingerRows& rows = log_.fingers[which];
    std::vector<Vec2> path;
    for (std::size_t row = 0; row < rows.x.size(); ++row) path.emplace_back(rows.x[row], rows.y[row]);
    const std::string_view colour = plan_.has_pairs() ? kFingerColours[which] : kWorldFinger;
    svg_.open_group("finger-path");
    svg_.polyline(on_page(path), stroke(colour, 1.2));
    for (const std::size_t row : {std::size_t{0}, log_.rows() - 1}) {
      Paint paint = stroke(colour, 1.2);
      if (!finger_at(which).is_jaw() && row == 0) {
        paint.fill = std::string(colour);
        paint.fill_opacity = 0.2;
      }
      svg_.polyline(on_page(rim(which, row)), paint);
    }
    const std::vector<Vec2> ends = on_page({path.front(), path.back()});
    svg_.circle(ends.front(), 2.2, filled(colour));
    if (ends.size() > 1) svg_.circle(ends.back(), 2.2, with_rim(kPaper, colour, 1.2));
    svg_.close_group();
  }

  // ---- the pose's uncertainty

  /// Of the pivot's place in the world.
  Eigen::Matrix2d place_covariance(const PoseSpread& spread) const {
    const Vec2 arm = spread.mean.turned(middle_);
    Eigen::Matrix<double, 2, 3> by = Eigen::Matrix<double, 2, 3>::Zero();
    by.leftCols<2>().setIdentity();
    by.col(2) = Vec2(-arm.y(), arm.x());
    return by * spread.covariance * by.transpose();
  }

  static double heading_sd(const PoseSpread& spread) { return std::sqrt(std::max(0.0, spread.covariance(2, 2))); }

  /// A round factor by which something is drawn larger so that it is as large as `wanted`; 1: it is.
  static double magnified(double size, double wanted) {
    if (!(size > 0) || size >= wanted) return 1;
    return 5 * round_below(wanted / size) <= 5 ? 1 : round_below(wanted / size);
  }

  void arrow(const Vec2& from, double heading, double length) {
    const Vec2 direction(std::cos(heading), -std::sin(heading));
    const std::vector<Vec2> path = {from, from + length * direction};
    svg_.polyline(without_tip(path, 6), stroke(kInk, 1.4));
    draw_arrowhead(svg_, path, 8, kInk);
  }

  void uncertainty() {
    const Pose pose = first_pose(main());
    const Vec2 at_world = pose.world(middle_), at = axes_(at_world.x(), at_world.y());
    const double length = kHeadingShare * size_ * scale_;
    if (main().pose_spread) {
      const PoseSpread& spread = *main().pose_spread;
      const double sd = heading_sd(spread);
      if (sd < kUnknownHeading) {
        ghosts(spread);
        const Eigen::Matrix2d covariance = place_covariance(spread);
        ellipse_by_ = magnified(kEllipse95 * half_axes(covariance).x() * scale_, kSmallEllipse);
        fan_by_ = magnified(kInterval95 * sd, kSmallFan);
        fan(at, pose.heading, std::min(std::numbers::pi, fan_by_ * kInterval95 * sd), length);
        std::vector<Vec2> rim;
        for (const Vec2& point : ellipse(at_world, ellipse_by_ * ellipse_by_ * covariance, kEllipse95)) {
          rim.emplace_back(axes_(point.x(), point.y()));
        }
        Paint paint = stroke(kInk, 1);
        paint.fill = std::string(kEllipseFill);
        paint.fill_opacity = 0.6;
        svg_.open_group("pose-ellipse");
        svg_.polygon(rim, paint);
        svg_.close_group();
      } else {
        fan(at, pose.heading, std::numbers::pi, length);
      }
    }
    svg_.open_group("heading");
    arrow(at, pose.heading, length);
    svg_.circle(at, 2.2, filled(kInk));
    svg_.close_group();
  }

  void fan(const Vec2& at, double heading, double half, double length) {
    std::vector<Vec2> points = {at};
    constexpr int kSteps = 48;
    for (int k = 0; k <= kSteps; ++k) {
      const double angle = heading + half * (2.0 * k / kSteps - 1);
      points.emplace_back(at + length * Vec2(std::cos(angle), -std::sin(angle)));
    }
    svg_.open_group("heading-fan");
    svg_.polygon(points, filled(kEllipseFill, 0.5));
    svg_.close_group();
  }

  /// The outline at the ends of the covariance's axes, where 95 % of each lies within.
  void ghosts(const PoseSpread& spread) {
    // Angles as lengths at the part's rim.
    const Eigen::Vector3d unit(1, 1, 0.5 * size_);
    const Eigen::Matrix3d scaled = unit.asDiagonal() * spread.covariance * unit.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scaled);
    svg_.open_group("pose-within");
    for (int axis = 0; axis < 3; ++axis) {
      const double sd = std::sqrt(std::max(0.0, axes.eigenvalues()[axis]));
      if (sd * scale_ < 0.5) continue;
      for (const double side : {-kInterval95, kInterval95}) {
        const Eigen::Vector3d off = (side * sd * axes.eigenvectors().col(axis)).cwiseQuotient(unit);
        const Pose pose{spread.mean.x + off.x(), spread.mean.y + off.y(), spread.mean.heading + off.z()};
        svg_.polyline(on_page(posed(outline_, pose)), stroke(colour_of(shown_.back()), 0.8, "", kGhostOpacity));
      }
    }
    svg_.close_group();
  }

  // ---- what it says

  void words() {
    const double x = axes_.corner.x(), room = axes_.size.x();
    double y = axes_.corner.y() + axes_.size.y() + kWorldBelow;
    TextStyle style{kWordsSize, Align::start, std::string(kInk)};
    for (const Text& line : pose_lines()) {
      style.size = fitting_size(line, kWordsSize, room);
      svg_.text({x, y}, line, style);
      y += kWordsLine;
    }
    style.fill = std::string(kSoftInk);
    for (const std::string& line : key_texts()) {
      style.size = fitting_size({{line}}, kWordsSize, room);
      svg_.text({x, y}, {{line}}, style);
      y += kWordsLine;
    }
  }

  /// How many there may be: how much is magnified is known when there is a frame.
  std::size_t most_lines() const {
    constexpr std::size_t kOfPose = 2;
    const std::size_t of_spread = main().pose_spread ? 3 : 0;
    return kOfPose + 1 + of_spread + (plan_.has_pairs() ? 1 : 0) + (shown_.size() > 1 ? 1 : 0);
  }

  std::vector<Text> pose_lines() const {
    const Pose pose = first_pose(main());
    const double heading = nearest_angle(pose.heading);
    Text where = plan_.has_pairs() ? Text{{"part"}} : contact_name(plan_, {shown_.back(), 0}, 0);
    std::string turned;
    if (!main().pose_spread) {
      where.push_back({": x " + with_unit(pretty_on(plan_.part(), pose.x), plan_.part()) + ", y " +
                       with_unit(pretty_on(plan_.part(), pose.y), plan_.part())});
      turned = "heading " + pretty_degrees(heading);
    } else {
      const Eigen::Matrix3d& covariance = main().pose_spread->covariance;
      const auto sd = [&](int k) { return std::sqrt(std::max(0.0, covariance(k, k))); };
      where.push_back({": x " + with_unit(with_sd(pose.x, sd(0)), plan_.part()) + ", y " +
                       with_unit(with_sd(pose.y, sd(1)), plan_.part())});
      turned = sd(2) < kUnknownHeading ? "heading " + with_sd(heading / kDegree, sd(2) / kDegree) + "\u00b0"
                                       : "heading not known";
    }
    Text both = where;
    both.push_back({", " + turned});
    if (text_width(both, kWordsSize) <= axes_.size.x()) return {both};
    return {where, {{turned}}};
  }

  std::vector<std::string> key_texts() const {
    std::vector<std::string> lines;
    lines.emplace_back(middle_.isZero() ? "arrow: the part's x axis at its origin"
                                        : "arrow: the part's x axis, at its middle");
    if (main().pose_spread) {
      const bool is_known = heading_sd(*main().pose_spread) < kUnknownHeading;
      lines.emplace_back(is_known ? "ellipse and fan: 95 %" : "the heading may be any");
      if (ellipse_by_ > 1) lines.push_back("the ellipse is drawn " + pretty(ellipse_by_) + " times as large");
      if (fan_by_ > 1) lines.push_back("the fan is drawn " + pretty(fan_by_) + " times as wide");
    }
    if (plan_.has_pairs()) lines.emplace_back("dashed: the part after the roll");
    if (shown_.size() > 1) lines.emplace_back("dashed: the part in the other places");
    return lines;
  }

  Svg& svg_;
  const AnswerPlan& plan_;
  const Log& log_;
  std::vector<std::size_t> shown_;  // placements; the last is the one that is looked at
  std::vector<Vec2> outline_;
  Vec2 middle_ = Vec2::Zero();
  Axes axes_;
  double size_ = 1;
  double scale_ = 1;
  double ellipse_by_ = 1;
  double fan_by_ = 1;
};

}  // namespace

double world_width(const AnswerPlan& plan) { return plan.has_world() ? kWorldShare * plan.width() : 0; }

void draw_world(Svg& svg, const AnswerPlan& plan, const Box& area) { WorldPicture(svg, plan, area).draw(); }

}  // namespace rollfix::draw
