#include <algorithm>
#include <cmath>
#include <utility>

#include "pair_bounds.hpp"
#include "places.hpp"
#include "rollfix/certify.hpp"
#include "rollfix/error.hpp"

// Notation, as in docs/certificates.md, "Two fingers":
//   (s, t)          first contacts of finger a and of finger b: `start[0]`, `start[1]`
//   F(s, t)         A(s) - B(t), an equation for each reading, then the facing: PairBounds
//   box             around a placement, with exactly one root in it where `has_one_root` says so
//   line            of a family: pairs (s, t) along which both fingers' contacts move by the same arc length
//   needed          the placement's extent with some room, which its box must hold: `needed_`
//   row             a pair with the amounts by which the equations are off, in tolerances
// Follows docs/certificates.md, "Two fingers".
// Idea: nothing is proved here. A placement gets a box as large as has one root for certain, or else as small as holds
// it, and a family its line; what is around these is divided into cells by pair_cover.cpp.
namespace rollfix::certifying {
namespace {

// The cells of a closed outline begin at these shares of the perimeter, where no symmetry has a joint.
constexpr std::array<double, 2> kFrom = {0.013717421, 0.017832641};
// Boxes around roots: the first size that is tried, as a share of the perimeter, and by how much the next one shrinks.
constexpr double kFirstBox = 0.06;
constexpr double kShrink = 0.7;
// How much longer the one side of a box may be.
constexpr double kMostAspect = 8;
// A box that proves a root keeps so many of its widths from places where a curve is at rest: near one the verifier's
// bounds on curvature are far wider than the search's.
constexpr double kWidthsFromRest = 4;
// A box holds the pairs that fit with this much to spare.
constexpr double kSpare = 1.5;
// A continuum's line is straight, and of an exact lap or length, to this share of the perimeter.
constexpr double kStraight = 1e-9;
// Of a line that goes round the search leaves out no more than this share of the perimeter, where it begins.
constexpr double kBeginning = 1e-3;
// Pairs of a line, which fit to this share of the tolerance, that are looked at.
constexpr int kLookedAt = 97;
constexpr double kFittingShare = 0.25;
// A family that ends on a part leaves the tolerance within so many times what the search found beyond its line, and
// this share of the perimeter.
constexpr double kBeyondLine = 5;
constexpr double kRoomBeyond = 1e-4;
// To prove of a line on two parts of the outline that all of it fits takes the verifier time with each vertex: so many
// lines times vertices are some seconds.
constexpr std::size_t kMostOnLines = 200;

/// Draws up one certificate of two fingers: boxes and lines of the placements first, then the cover. Used once.
class PairMaker {
 public:
  PairMaker(const Part& part, const std::vector<Reading>& readings, const LocateOptions& options)
      : part_(part),
        search_(locate(part, readings, options)),
        bounds_(part, readings, options.facing),
        tolerance_(std::max(options.tolerance, kLeastTolerance)),
        rests_(places_at_rest(part)) {
    lengths_.resize(2);
    for (std::size_t finger = 0; finger < 2; ++finger) {
      for (const Reading& reading : readings) lengths_[finger].push_back(reading.length[finger]);
    }
  }

  /// Cells, ends and placements of the certificate.
  void fill(PairCertificate& certificate) {
    for (const Placement& placement : search_.placements) {
      pairs_.push_back({&placement, {}, false, line_of(placement)});
      proofs_.push_back(PairProof::fits);
      // What each placement's box must hold is known for all before the first box is looked for: boxes may not meet it.
      needed_.push_back({spared(placement, 0), spared(placement, 1)});
    }
    leave_costly_lines();
    for (std::size_t k = 0; k < pairs_.size(); ++k) find_box(k);
    const PairBox whole = this->whole();
    // The verifier builds the same tree from this corner, by halving.
    certificate.from = row(whole[0].lo, whole[1].lo);
    if (!part_.closed()) certificate.to = row(whole[0].hi, whole[1].hi);
    certificate.cells = PairCover(part_, bounds_, tolerance_, pairs_).cells(whole);
    for (std::size_t k = 0; k < pairs_.size(); ++k) certificate.placements.push_back(certified(k));
  }

 private:
  /// All pairs of first contacts. On a closed outline one lap from a place that is clear of joints.
  PairBox whole() const {
    PairBox box;
    for (std::size_t finger = 0; finger < 2; ++finger) {
      box[finger] = clear_starts(part_, lengths_[finger]);
      if (!part_.closed()) continue;
      const double lo = clear(finger, kFrom[finger] * part_.perimeter(), 1);
      box[finger] = {lo, lo + part_.perimeter()};
    }
    return box;
  }

  /// A first contact from which none of the finger's contacts is at a joint.
  double clear(std::size_t finger, double s, int way) const { return clear_of_joints(part_, lengths_[finger], s, way); }

  /// A pair by the outline's formulas, with each equation's value in tolerances; below `kTurnAccuracy` it is rounding.
  PairRow row(double s, double t) const {
    PairRow result{{place_of(part_, s), place_of(part_, t)}, bounds_.off(s, t)};
    for (double& off : result.off) off = std::abs(off) <= kTurnAccuracy ? 0 : off / tolerance_;
    return result;
  }

  // ---- boxes around placements ----

  /// Gives placement k the largest box that has one root for certain. If there is none, the smallest box with nothing
  /// that fits around it. No box: a continuum, or another placement is too near.
  void find_box(std::size_t k) {
    const Placement& placement = *pairs_[k].placement;
    // A continuum is no root in a box.
    if (placement.kind == Kind::stretch) return;
    if (placement.whole_loop[0] || placement.whole_loop[1]) return;
    const PairBox& needed = needed_[k];
    const std::array<double, 2> aspect = aspect_of(needed);
    // From large to small: the first that passes is the largest.
    for (double size = kFirstBox * part_.perimeter(); size > least_step(part_); size *= kShrink) {
      const PairBox box = box_around(placement, {size * aspect[0], size * aspect[1]});
      // Boxes shrink around the same pair: smaller ones don't hold the extent either.
      if (!holds(box, needed)) break;
      if (!is_free(box, k) || is_near_rest(box) || !bounds_.has_one_root(box, tolerance_)) continue;
      pairs_[k].box = box;
      // Of more than two equations the root of two of them need not satisfy the others: then `fits`.
      proofs_[k] = bounds_.count() == 2 ? PairProof::one : PairProof::fits;
      return;
    }
    find_loose_box(k, needed);
  }

  /// Whether some contact of a finger comes near to a place where a curve is at rest, for starts in the box.
  bool is_near_rest(const PairBox& box) const {
    for (std::size_t finger = 0; finger < 2; ++finger) {
      const double reach = kWidthsFromRest * box[finger].width();
      const auto is_near = [&](double from) {
        const Interval contacts{box[finger].lo + from, box[finger].hi + from};
        return std::any_of(rests_.begin(), rests_.end(),
                           [&](double s) { return part_.boundary().distance(contacts, s) < reach; });
      };
      if (is_near(0) || std::any_of(lengths_[finger].begin(), lengths_[finger].end(), is_near)) return true;
    }
    return false;
  }

  /// The smallest box with a frame around it, as wide as half the box, in which nothing fits. Without one the extent
  /// itself is the box if nothing else is in it.
  void find_loose_box(std::size_t k, const PairBox& needed) {
    const Placement& placement = *pairs_[k].placement;
    for (double size = kFirstBox * part_.perimeter(); size > least_step(part_); size *= kShrink) {
      const PairBox box = box_around(placement, {size, size});
      if (!holds(box, needed)) break;
      const PairBox outer = box_around(placement, {2 * size, 2 * size});
      if (!is_free(outer, k)) continue;
      if (!is_alone(box, outer)) {
        // Once a box is found, smaller ones are tried until their frame is not empty.
        if (pairs_[k].box) break;
        continue;
      }
      pairs_[k].box = box;
    }
    if (!pairs_[k].box && is_on_part(needed) && is_free(needed, k)) pairs_[k].box = needed;
  }

  /// The frame between a box and a larger one is apart: its four sides, two of them over the full width.
  bool is_alone(const PairBox& box, const PairBox& outer) {
    const Interval before{outer[0].lo, box[0].lo};
    const Interval after{box[0].hi, outer[0].hi};
    const Interval below{outer[1].lo, box[1].lo};
    const Interval above{box[1].hi, outer[1].hi};
    return bounds_.are_apart({before, outer[1]}, tolerance_) && bounds_.are_apart({after, outer[1]}, tolerance_) &&
           bounds_.are_apart({box[0], below}, tolerance_) && bounds_.are_apart({box[0], above}, tolerance_);
  }

  /// The extent with some room, unwrapped around the start.
  Interval spared(const Placement& placement, std::size_t finger) const {
    const double start = placement.start[finger];
    Interval extent = placement.extent[finger];
    if (part_.closed()) {
      const double shift = start - (extent.lo + wrap(start - extent.lo, part_.perimeter()).base);
      extent = {extent.lo + shift, extent.hi + shift};
    }
    const double more = 16 * least_step(part_);
    // On each side of the start the extent is stretched by `kSpare`, and by some steps more, as it may be a point.
    const double before = std::max(0.0, start - extent.lo);
    const double after = std::max(0.0, extent.hi - start);
    return {clear(finger, start - kSpare * before - more, -1), clear(finger, start + kSpare * after + more, 1)};
  }

  /// Factors for both sides of a box, with product 1: boxes are as oblong as the extent, up to `kMostAspect`.
  static std::array<double, 2> aspect_of(const PairBox& needed) {
    const double ratio = std::clamp(needed[0].width() / needed[1].width(), 1 / kMostAspect, kMostAspect);
    return {std::sqrt(ratio), 1 / std::sqrt(ratio)};
  }

  /// `size`: half of each side, moved on until all contacts are clear of joints.
  PairBox box_around(const Placement& placement, const std::array<double, 2>& size) const {
    PairBox box;
    for (std::size_t finger = 0; finger < 2; ++finger) {
      const double start = placement.start[finger];
      box[finger] = {clear(finger, start - size[finger], -1), clear(finger, start + size[finger], 1)};
    }
    return box;
  }

  static bool holds(const PairBox& box, const PairBox& inner) {
    return box[0].lo <= inner[0].lo && box[0].hi >= inner[0].hi && box[1].lo <= inner[1].lo && box[1].hi >= inner[1].hi;
  }

  /// Within the starts of an open outline; less than half a lap of a closed one, so that a box does not meet itself.
  bool is_on_part(const PairBox& box) const {
    if (part_.closed()) return box[0].width() < 0.5 * part_.perimeter() && box[1].width() < 0.5 * part_.perimeter();
    for (std::size_t finger = 0; finger < 2; ++finger) {
      const Interval range = clear_starts(part_, lengths_[finger]);
      if (box[finger].lo < range.lo || box[finger].hi > range.hi) return false;
    }
    return true;
  }

  /// On the part, and apart from every other placement that is no continuum: from its box, or without one from its
  /// extent.
  bool is_free(const PairBox& box, std::size_t k) const {
    if (!is_on_part(box)) return false;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      if (i == k) continue;
      // Placements that come later have no box yet: their extents stand for it.
      const PairBox& other = pairs_[i].box ? *pairs_[i].box : needed_[i];
      if (pairs_[i].placement->kind != Kind::stretch && meet(box, other)) return false;
    }
    return true;
  }

  /// To four steps, on this lap or a neighbouring one.
  bool meet(const PairBox& one, const PairBox& two) const {
    for (std::size_t finger = 0; finger < 2; ++finger) {
      const auto at = [&](double shift) {
        const double step = 4 * least_step(part_);
        return one[finger].lo + shift <= two[finger].hi + step && two[finger].lo <= one[finger].hi + shift + step;
      };
      // On this lap, the next one or the one before.
      const double lap = part_.closed() ? part_.perimeter() : 0;
      if (!at(0) && !at(lap) && !at(-lap)) return false;
    }
    return true;
  }

  // ---- families ----

  /// The line of a continuum, if it has slope 1, or -1 and goes round: both fingers' contacts move by the same arc
  /// length. Nothing if it is bent or has another slope, or if a pair on it is off by more than a share of the
  /// tolerance.
  std::optional<PairLine> line_of(const Placement& placement) const {
    if (placement.kind != Kind::stretch || placement.family.size() != 2) return std::nullopt;
    auto from = placement.family[0];
    auto to = placement.family[1];
    // So that finger a moves ahead.
    if (from[0] > to[0]) std::swap(from, to);
    const double period = part_.perimeter();
    PairLine line{from[0], from[1], to[1] < from[1] ? -1 : 1, to[0] - from[0]};
    // From end to end both fingers must move by the same length.
    if (!(std::abs(std::abs(to[1] - from[1]) - line.length) <= kStraight * period)) return std::nullopt;
    const bool is_same = is_same_for_both(line);
    // The verifier proves no line across a corner, unless both fingers' contacts are at the same places.
    if (!part_.corners().empty() && !is_same) return std::nullopt;
    if (is_same) line.t = line.s;
    // A line that goes round begins and ends at the same pair: the search may leave out a little there.
    if (placement.whole_loop[0] && placement.whole_loop[1]) {
      if (line.length < (1 - kBeginning) * period) return std::nullopt;
      line.length = period;
    } else if (!clear_ends(line)) {
      return std::nullopt;
    }
    // Samples only: that all of the line fits is proved by the verifier.
    for (int k = 0; k <= kLookedAt; ++k) {
      const double way = line.length * k / kLookedAt;
      for (const double off : bounds_.off(line.s + way, line.t + line.way * way)) {
        if (!(std::abs(off) <= kFittingShare * tolerance_)) return std::nullopt;
      }
    }
    return line;
  }

  /// Drops lines between different places if proving them costs too much. Then their cells exclude nothing.
  void leave_costly_lines() {
    const auto is_costly = [&](const CoveredPair& pair) { return pair.line && !is_same_for_both(*pair.line); };
    const auto count = static_cast<std::size_t>(std::count_if(pairs_.begin(), pairs_.end(), is_costly));
    if (count * (part_.vertices().size() + 1) <= kMostOnLines) return;
    for (CoveredPair& pair : pairs_) {
      if (is_costly(pair)) pair.line.reset();
    }
  }

  /// Both fingers start at the same place, laps aside, and roll by the same lengths in each reading: the equations of
  /// both cancel all along.
  bool is_same_for_both(const PairLine& line) const {
    const double apart = line.t - line.s;
    const double lap = part_.closed() ? part_.perimeter() * std::round(apart / part_.perimeter()) : 0;
    return line.way > 0 && lengths_[0] == lengths_[1] && std::abs(apart - lap) <= kStraight * part_.perimeter();
  }

  /// Lets a line end where no contact of either finger is at a joint or beyond an end.
  bool clear_ends(PairLine& line) const {
    if (line.way < 0) return false;
    // All contacts of both fingers, measured from finger a's first one: they move together along the line.
    std::vector<double> contacts = {0, line.t - line.s};
    for (std::size_t finger = 0; finger < 2; ++finger) {
      for (const double length : lengths_[finger]) contacts.push_back(contacts[finger] + length);
    }
    Interval ends{line.s, line.s + line.length};
    // The line ends where some contact of either finger comes to an end of the outline.
    if (!part_.closed()) {
      const Interval range = clear_starts(part_, contacts);
      ends = {std::max(ends.lo, range.lo), std::min(ends.hi, range.hi)};
    }
    ends = {clear_of_joints(part_, contacts, ends.lo, 1), clear_of_joints(part_, contacts, ends.hi, -1)};
    line = {ends.lo, line.t + (ends.lo - line.s), 1, ends.width()};
    return line.length > 8 * least_step(part_);
  }

  /// First contacts of one finger within which all of a family's cells are; a full lap where the line goes round, all
  /// of an open outline.
  Interval room_for(const Placement& placement, const PairLine& line, std::size_t finger) const {
    const double period = part_.perimeter();
    if (!part_.closed() || line.length >= period) return {0, period};
    const double from = finger == 0 ? line.s : line.t;
    const Interval& extent = placement.extent[finger];
    const double room = kBeyondLine * std::max(0.0, extent.width() - line.length) + kRoomBeyond * period;
    return {from - room, from + line.length + room};
  }

  /// The proof is `none` for a placement that has no box and starts in no cell of its own.
  CertifiedPair certified(std::size_t k) const {
    const CoveredPair& pair = pairs_[k];
    CertifiedPair result;
    result.placement = *pair.placement;
    result.at = {place_of(part_, pair.placement->start[0]), place_of(part_, pair.placement->start[1])};
    result.proof = pair.box || pair.has_cell ? proofs_[k] : PairProof::none;
    if (pair.line && pair.has_cell) result.proof = PairProof::family;
    if (pair.line) {
      const auto& [s, t, way, length] = *pair.line;
      result.line = {{{s, t}, {s + length, t + way * length}}};
      for (std::size_t finger : {0U, 1U}) result.extent[finger] = room_for(*pair.placement, *pair.line, finger);
    }
    // Two opposite corners.
    if (pair.box) {
      const PairBox& box = *pair.box;
      result.box = std::array<PairRow, 2>{row(box[0].lo, box[1].lo), row(box[0].hi, box[1].hi)};
    }
    return result;
  }

  const Part& part_;
  Search search_;
  mutable PairBounds bounds_;
  double tolerance_;
  std::vector<double> rests_;                 // s of the places where a curve is at rest
  std::vector<std::vector<double>> lengths_;  // of each finger
  std::vector<CoveredPair> pairs_;
  std::vector<PairProof> proofs_;
  std::vector<PairBox> needed_;  // what a box of each has to hold
};

}  // namespace

}  // namespace rollfix::certifying

namespace rollfix {

/// The word in the certificate.
const char* name_of(PairProof proof) {
  switch (proof) {
    case PairProof::one:
      return "one";
    case PairProof::family:
      return "family";
    case PairProof::fits:
      return "fits";
    case PairProof::none:
      break;
  }
  return "none";
}

/// Whether every cell belongs to a placement or excludes its pairs, and every placement has its own.
bool PairCertificate::is_complete() const {
  return cells.find('?') == std::string::npos &&
         std::none_of(placements.begin(), placements.end(),
                      [](const CertifiedPair& one) { return one.proof == PairProof::none; });
}

/// Searches by itself and draws up the certificate. Throws InputError: readings that are not of two fingers; a curve
/// without a formula.
PairCertificate certify_pair(const Part& part, const std::vector<Reading>& readings, const LocateOptions& options) {
  if (readings.empty() || readings.front().fingers() != 2) {
    throw InputError("certificates of two fingers are of two fingers' readings");
  }
  PairCertificate certificate;
  static_cast<CertifiedOutline&>(certificate) = certifying::certified_outline(part);
  certificate.readings = readings;
  certificate.facing = options.facing;
  certificate.tolerance = std::max(options.tolerance, kLeastTolerance);
  certifying::PairMaker(part, readings, options).fill(certificate);
  return certificate;
}

}  // namespace rollfix
