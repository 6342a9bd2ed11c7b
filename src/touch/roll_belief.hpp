#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

#include "centre_path.hpp"
#include "posterior.hpp"
#include "rollfix/belief.hpp"
#include "rollfix/reading.hpp"

namespace rollfix::touch {

/// What the centre of a rolling finger is taken for.
enum class RollCentre {
  evidence,  // a measurement, as of a touch
  unused,    // nothing: the roll tells the part's heading alone
  reference  // where the part is, if the first contact is known: then no other contact's place is evidence
};

/// A little of the boundary on which a roll's first contact can be, and what all rows say if it is there: a normal
/// distribution of where the finger's centre was at the first contact, and of how the part's tangent pointed.
struct RollNode {
  PathPlace place;
  CentrePoint point;  // of the part
  Vec2 at = Vec2::Zero();
  double tangent = 0;                                     // radians, in the world
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // of x and y of the centre, and of the tangent
  double heading_information = 0;                         // of the tangent, whatever the centre is
  double log_peak = 0;                                    // of that distribution's density at its mean
  double log_weight = 0;                                  // of the probability that the first contact is here
  double log_density = 0;                                 // of it by length, as a share of the largest
  double width = 0;                                       // of the stretch of boundary that it stands for, in u
  double density_slope = 0;                               // minus the first derivative of the log density by u, and ...
  double density_bend = 0;                                // ... minus the second one, no less than 0
  bool ends_before = false;                               // no node is before it on the boundary, ...
  bool ends_behind = false;                               // ... or behind it
};

/// A roll's likelihood by the part's pose: the belief of its first contact's place, on nodes no further apart than a
/// standard deviation of what they say.
class RollBelief {
 public:
  /// `path`: that all of the pieces lie on, or they are left out; outlives this.
  RollBelief(const CentrePath& path, const std::vector<PosePiece>& pieces, RollCentre centre);

  bool has_place() const { return centre_ != RollCentre::unused; }
  const std::vector<RollNode>& nodes() const { return nodes_; }
  /// Those on a stretch whose u is from lo up to hi: first and behind the last.
  std::pair<std::size_t, std::size_t> nodes_in(std::size_t stretch, const Interval& u) const;
  /// The one at this place. REQUIRES that there is one.
  const RollNode& at(const PathPlace& place) const;

  /// The pose that a node asks for.
  Pose pose_at(const RollNode& node) const;
  /// The node that fits a pose best.
  const RollNode& nearest(const Pose& pose) const;
  /// The same from this node on, over neighbours that fit better and better.
  const RollNode& downhill(const Pose& pose, const RollNode& from) const;
  /// By how much a pose misses what a node says: of the centre, length, and of the tangent, radians.
  Eigen::Vector3d residual(const Pose& pose, const RollNode& node) const;
  /// The same in standard deviations, as a share of those that are allowed.
  double worst(const Pose& pose, const RollNode& node) const;
  /// By how much a node misses a pose: the square in standard deviations, and twice the logarithm of how much denser
  /// the belief is elsewhere. `slides`: to the place near the node's where that is least.
  double square(const Pose& pose, const RollNode& node, bool slides) const;
  /// The same as a share of the normal equations, for steps of the pose about a point of the world.
  Normals normals(const Pose& pose, const RollNode& node, const Vec2& about, bool slides) const;
  /// The likelihood, wherever the first contact is.
  TiltedTouch tilted(const Pose& pose, const Vec2& about) const;

 private:
  /// From a node to the place next to it that fits a pose best.
  struct Slide {
    double by = 0;         // in u
    double square = 0;     // there, of miss and density
    bool is_free = false;  // it is a minimum, and no end
  };
  Slide slide(const Pose& pose, const RollNode& node) const;
  void add_slopes();
  void add(const PosePiece& piece);
  void add_node(const PosePiece& piece, const PosePiece::End& lo, const PosePiece::End& hi, double from, double to);

  /// What a node says of the heading: all that most poses need to know of most nodes.
  struct OfHeading {
    double heading = 0;
    double information = 0;
    double log_density = 0;
  };

  const CentrePath& path_;
  RollCentre centre_;
  std::vector<RollNode> nodes_;       // by place
  std::vector<OfHeading> headings_;   // of each
  mutable std::size_t nearest_ = 0;   // the last one that was asked for: the next is not far from it
  mutable std::vector<double> logs_;  // of `tilted`
};

}  // namespace rollfix::touch
