#pragma once

// What one of two fingers feels, as a function of where it starts: for each reading the turn of its roll, with the
// facing also the tangent's angle. A tree of intervals with bounds, each halved when somebody asks.

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "oracle/boundary.hpp"

namespace oracle {

inline constexpr std::size_t kMostRows = 4;
using Row = std::array<Real, kMostRows>;
using Rows = std::array<Interval, kMostRows>;

/// A stretch of starts between corners, or a pivot: there s is one place, and x the share of the corner's turn.
struct PathPiece {
  Real lo = 0, hi = 0;  // of x: of a stretch s itself
  bool is_pivot = false;
  Real s = 0;  // of a pivot, with ...
  Row first{}, change{};
};

struct PathNode {
  std::size_t piece = 0;
  Real lo = 0, hi = 0;
  Row first{}, last{};
  Rows slope, values;
  std::size_t halves = 0;  // the first of two, 0: not asked for
};

class RollPath {
 public:
  RollPath(const Boundary& boundary, std::vector<Real> lengths, bool with_angle)
      : boundary_(boundary), lengths_(std::move(lengths)), with_angle_(with_angle) {
    place_pieces();
    nodes_.reserve(1 << 12);
    nodes_.emplace_back();  // number 0 is none
    for (std::size_t k = 0; k < pieces_.size(); ++k) add(k, pieces_[k].lo, pieces_[k].hi);
    roots_ = nodes_.size() - 1;
  }

  std::size_t rows() const { return lengths_.size() + (with_angle_ ? 1 : 0); }
  /// Two corners at once: what may be felt there is no path.
  bool is_branched() const { return is_branched_; }
  std::size_t roots() const { return roots_; }  // nodes 1 to here
  const PathNode& node(std::size_t k) const { return nodes_[k]; }
  const PathPiece& piece(const PathNode& node) const { return pieces_[node.piece]; }

  /// In units of the boundary's length; a pivot as if it were as long as a radian's share of it.
  Real width(const PathNode& node) const {
    const PathPiece& piece = pieces_[node.piece];
    return (node.hi - node.lo) * (piece.is_pivot ? 0.1L * boundary_.perimeter() : 1);
  }
  Interval starts(const PathNode& node) const {
    const PathPiece& piece = pieces_[node.piece];
    return piece.is_pivot ? Interval(piece.s) : Interval(node.lo, node.hi);
  }

  std::size_t halves(std::size_t k) {
    if (nodes_[k].halves == 0) {
      const PathNode node = nodes_[k];
      const Real amid = node.lo + (node.hi - node.lo) / 2;
      nodes_[k].halves = add(node.piece, node.lo, amid);
      add(node.piece, amid, node.hi);
    }
    return nodes_[k].halves;
  }

  /// Values and slopes at one x.
  std::pair<Row, Row> at(std::size_t piece_index, Real x) const {
    const PathPiece& piece = pieces_[piece_index];
    Row values{}, slopes{};
    if (piece.is_pivot) {
      for (std::size_t k = 0; k < rows(); ++k) values[k] = piece.first[k] + x * piece.change[k];
      return {values, piece.change};
    }
    const auto contacts = this->contacts(x, Side::after, Boundary::kNear);
    for (std::size_t k = 0; k < lengths_.size(); ++k) {
      slopes[k] = boundary_.curvature(contacts[k + 1]) - boundary_.curvature(contacts[0]);
    }
    if (with_angle_) slopes[lengths_.size()] = boundary_.curvature(contacts[0]);
    return {values_of(contacts), slopes};
  }

 private:
  using AllContacts = std::array<Contact, kMostRows + 1>;

  AllContacts contacts(Real s, Side side, Real near) const {
    AllContacts contacts;
    contacts[0] = boundary_.contact(s, side, near);
    for (std::size_t k = 0; k < lengths_.size(); ++k) contacts[k + 1] = boundary_.contact(s + lengths_[k], side, near);
    return contacts;
  }

  Row values_of(const AllContacts& contacts) const {
    Row values{};
    for (std::size_t k = 0; k < lengths_.size(); ++k) values[k] = contacts[k + 1].angle - contacts[0].angle;
    if (with_angle_) values[lengths_.size()] = contacts[0].angle;
    return values;
  }

  struct Event {
    Real s;
    std::size_t contact;
    Real turn;
  };

  std::vector<Event> events(Real lo, Real hi) const {
    std::vector<Event> events;
    const Real P = boundary_.perimeter();
    for (const Corner& corner : boundary_.corners()) {
      for (std::size_t k = 0; k <= lengths_.size(); ++k) {
        Real s = corner.s - (k == 0 ? 0 : lengths_[k - 1]);
        if (boundary_.closed()) s -= std::floor((s - lo) / P) * P;
        if (s > lo && s < hi) events.push_back({s, k, corner.turn});
      }
    }
    std::sort(events.begin(), events.end(), [](const Event& one, const Event& other) { return one.s < other.s; });
    return events;
  }

  void place_pieces() {
    const Real P = boundary_.perimeter();
    Real lo = boundary_.closed() ? kAnywhere * P : 0, hi = lo + P;
    for (const Real length : lengths_) {
      if (boundary_.closed()) continue;
      lo = std::max(lo, -length);
      hi = std::min(hi, P - length);
    }
    if (hi < lo) return;
    Real from = lo;
    for (const Event& event : events(lo, hi)) {
      if (event.s - from <= kSamePlace * P && from > lo) is_branched_ = true;
      pieces_.push_back({from, event.s, false, 0, {}, {}});
      if (event.turn > -kJoint) pieces_.push_back(pivot(event));
      from = event.s;
    }
    pieces_.push_back({from, hi, false, 0, {}, {}});
  }

  PathPiece pivot(const Event& event) const {
    PathPiece piece{0, 1, true, event.s, values_of(contacts(event.s, Side::before, kSamePlace)), {}};
    for (std::size_t k = 0; k < lengths_.size(); ++k) {
      if (event.contact == 0) piece.change[k] = -event.turn;
      if (event.contact == k + 1) piece.change[k] = event.turn;
    }
    if (with_angle_ && event.contact == 0) piece.change[lengths_.size()] = event.turn;
    return piece;
  }

  std::size_t add(std::size_t index, Real lo, Real hi) {
    const PathPiece& piece = pieces_[index];
    PathNode node;
    node.piece = index;
    node.lo = lo;
    node.hi = hi;
    if (piece.is_pivot) {
      node.first = at(index, lo).first;
      node.last = at(index, hi).first;
      for (std::size_t k = 0; k < rows(); ++k) node.slope[k] = piece.change[k];
    } else {
      const auto near = [&](bool is_end) { return is_end ? kSamePlace : Boundary::kNear; };
      const AllContacts first = contacts(lo, Side::after, near(lo == piece.lo));
      const AllContacts last = contacts(hi, Side::before, near(hi == piece.hi));
      node.first = values_of(first);
      node.last = values_of(last);
      for (std::size_t k = 0; k < lengths_.size(); ++k) {
        node.slope[k] = gain_of_curvature(boundary_, lengths_[k], {first[0], last[0]}, {first[k + 1], last[k + 1]});
      }
      if (with_angle_) node.slope[lengths_.size()] = boundary_.bend(first[0], last[0]).curvature;
    }
    for (std::size_t k = 0; k < rows(); ++k) {
      node.values[k] = between(node.first[k], node.last[k], node.slope[k], hi - lo);
    }
    nodes_.push_back(node);
    return nodes_.size() - 1;
  }

  static constexpr Real kAnywhere = 0.0314159L;
  static constexpr Real kSamePlace = 1e-12L;
  static constexpr Real kJoint = 1e-3L;

  const Boundary& boundary_;
  std::vector<Real> lengths_;
  bool with_angle_;
  bool is_branched_ = false;
  std::vector<PathPiece> pieces_;
  std::vector<PathNode> nodes_;
  std::size_t roots_ = 0;
};

}  // namespace oracle
