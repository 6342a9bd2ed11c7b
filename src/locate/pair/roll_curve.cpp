#include "roll_curve.hpp"

#include <algorithm>
#include <cmath>

#include "locate/searches.hpp"

// Notation:
//   s, L_k          first contact, length of reading k: `equations_.lengths`. Contact 0 is at s, contact k + 1 at s +
//                   L_k
//   A_k(s)          Theta(s + L_k) - Theta(s) + shift_k, and with the facing Theta(s) + facing: component `row`
//   kappa           `rate` of each contact's tangent; the component's slope is kappa(s + L_k) - kappa(s)
//   x               coordinate on a piece: s, or at a convex corner the angle by which the finger has pivoted
//   node            an interval of x on one piece, or of s over many, with bounds on every A_k and its slope
// Follows one side of eqs. (8) and (9) of the paper (Jia, IROS 2001); docs/search.md, "Two fingers", steps 1 and 2.
// Idea: the boundary is cut where any contact passes to another spiral. Between cuts all rates are monotone, so that
// rates at both ends bound slopes, and each tangent's angle leaves its chord by a quarter of the rate's change times
// the width at the most: `Combination::value` adds these up before it bounds, so that x A_p + y A_q sees its first
// contact once.
namespace rollfix::locating {

namespace {

// So many shares of a piece at whose ends slopes are sampled: at more places than the polynomials have terms.
constexpr int kConstantSamples = 20;
// Nodes and points that there is room for at first.
constexpr std::size_t kRoomOfPiece = 8;
constexpr std::size_t kRoomAtFirst = 32;
// So close to a spiral's end, in parts of the perimeter, a place is there but for rounding.
constexpr double kEndRounding = 1e-15;
// Down to so many cuts halves are bounded by the part's tree: below, pieces have bounds that are as good.
constexpr std::size_t kFewCuts = 6;

}  // namespace

RollCurve::RollCurve(const Part& part, RollEquations equations, const Interval& range)
    : PlaneCurve(equations.rows()),
      part_(part),
      turning_(part.turning()),
      equations_(std::move(equations)),
      strips_(part, equations_, range),
      contacts_(equations_.contacts()) {
  set_root(strips_.is_empty() ? cut(range) : make_uncut(range, strips_.whole().data()));
}

// What is called for every place is inline.

/// Contact c while the first one is at x on a piece that is no pivot; it is on one of these panels.
inline RollCurve::Contact RollCurve::contact_at(const RollPiece& piece, double x, std::size_t c,
                                                std::uint32_t first_panel, std::uint32_t last_panel) const {
  const double base = x + piece.offset[c];
  const std::uint32_t panel = turning_.panel_index(first_panel, last_panel, base);
  const Turning at = turning_.on_panel(turning_.panels()[panel], base);
  ++evaluations_;
  return {{piece.angle[c] + at.angle, at.curvature}, panel};
}

/// Contact c at x on a piece. Beside an end of its spiral it takes the spiral's own limit: beyond a corner Theta
/// differs.
inline RollCurve::Contact RollCurve::contact_on_spiral(const RollPiece& piece, double x, std::size_t c) const {
  if (piece.pivot_at) return pivoted(piece, x, c);
  const Spiral& spiral = turning_.spirals()[piece.spiral[c]];
  const auto is_at = [&](double end) {
    return std::abs(x + piece.offset[c] - end) <= kEndRounding * turning_.perimeter();
  };
  const auto known = [&](const Turning& end, std::uint32_t panel) {
    return Contact{{piece.angle[c] + end.angle, end.curvature}, panel};
  };
  if (is_at(spiral.lo)) return known(spiral.start, spiral.first_panel);
  if (is_at(spiral.hi)) return known(spiral.end, spiral.last_panel);
  return contact_at(piece, x, c, spiral.first_panel, spiral.last_panel);
}

/// Contact c at x on a node: its panel is between those of the node's two points.
inline RollCurve::Contact RollCurve::contact_between(const Node& node, double x, std::size_t c) const {
  const RollPiece& piece = pieces_[node.piece];
  if (piece.pivot_at) return pivoted(piece, x, c);
  return contact_at(piece, x, c, panels_[node.first * contacts_ + c], panels_[node.last * contacts_ + c]);
}

/// Cuts a range of s into pieces, with a node for each, and returns the index of a node over all of them; -1 where the
/// range is no wider than rounding and no contact pivots.
std::int32_t RollCurve::cut(const Interval& range) {
  const std::size_t before = pieces_.size();
  make_pieces(range);
  const auto first_node = static_cast<std::int32_t>(count());
  if (before == 0) {
    const std::size_t room = kRoomOfPiece * pieces_.size() + kRoomAtFirst;
    reserve(room);
    make_room(room);
  }
  boost::container::small_vector<Contact, 4> at(contacts_);
  const auto contact_of = [&](std::size_t c) { return at[c]; };
  for (std::size_t k = before; k < pieces_.size(); ++k) {
    RollPiece& piece = pieces_[k];
    // Contacts that stay on their spiral are the same at this piece's start as at the end of the piece before.
    const bool goes_on = k > before && pieces_[k - 1].hi == piece.lo && !pieces_[k - 1].pivot_at && !piece.pivot_at;
    for (std::size_t c = 0; c < contacts_; ++c) {
      const bool is_known = goes_on && pieces_[k - 1].spiral[c] == piece.spiral[c];
      if (!is_known) at[c] = contact_on_spiral(piece, piece.lo, c);
    }
    // The points at both ends of the piece, from which the node's bounds follow.
    const std::uint32_t first = add_point(contact_of);
    for (std::size_t c = 0; c < contacts_; ++c) at[c] = contact_on_spiral(piece, piece.hi, c);
    const std::uint32_t last = add_point(contact_of);
    find_constants(piece, first, last);
    make_node(static_cast<std::uint32_t>(k), piece.lo, piece.hi, first, last);
  }
  if (pieces_.size() == before) return -1;
  return join(first_node, static_cast<std::int32_t>(count()));
}

/// A node over all first contacts in s, bounded by the part's tree alone.
std::int32_t RollCurve::make_uncut(const Interval& s, const RollStrips::Span* spans) {
  Node node;
  node.lo = s.lo;
  node.hi = s.hi;
  node.first = static_cast<std::uint32_t>(spans_.size());
  spans_.insert(spans_.end(), spans, spans + contacts_);
  boost::container::small_vector<Range, 4> values(rows());
  strips_.bound(s, &spans_[node.first], values.data());
  return make_bounded(node, values.data());
}

void RollCurve::divide(std::int32_t index) {
  if (node(index).on_one_piece()) {
    divide_on_piece(index);
  } else {
    divide_uncut(index);
  }
}

/// Halves an interval of x at its middle. Both halves share the point there, so that halving costs one evaluation of
/// each contact.
void RollCurve::divide_on_piece(std::int32_t index) {
  const Node node = this->node(index);
  const double x = 0.5 * (node.lo + node.hi);
  const std::uint32_t middle = add_point([&](std::size_t c) { return contact_between(node, x, c); });
  const std::int32_t left = make_node(node.piece, node.lo, x, node.first, middle);
  const std::int32_t right = make_node(node.piece, x, node.hi, middle, node.last);
  adopt(index, left, right);
}

/// Gives an uncut node its children: pieces where they are few.
void RollCurve::divide_uncut(std::int32_t index) {
  const Interval s{node(index).lo, node(index).hi};
  const RollStrips::Span* spans = &spans_[node(index).first];
  boost::container::small_vector<RollStrips::Span, 8> halves(2 * contacts_);
  const bool few = strips_.cuts(spans) <= kFewCuts;
  const double middle = few ? s.lo : strips_.halve(spans, halves.data(), halves.data() + contacts_);
  std::int32_t left = -1;
  std::int32_t right = -1;
  // Enough cuts inside: two uncut halves. Else (few cuts, or all at one end) the pieces themselves, under one node
  // whose two children become this node's.
  if (middle > s.lo && middle < s.hi) {
    left = make_uncut({s.lo, middle}, halves.data());
    right = make_uncut({middle, s.hi}, halves.data() + contacts_);
  } else {
    left = cut(s);
    if (left >= 0 && !node(left).on_one_piece()) {
      const Node joined = node(left);
      left = joined.left;
      right = joined.right;
    }
  }
  adopt(index, left, right);
}

/// Cuts the range of first contacts into pieces, wherever a contact passes from one spiral to the next. Puts pivots
/// between them wherever a contact passes a convex corner, or the tiny concave joint of a drawing (kJointTurn). At each
/// turn of the loop every contact's cursor is on the spiral that it goes on along from `here`.
void RollCurve::make_pieces(const Interval& range) {
  const double same_place = kLengthAccuracy * turning_.perimeter();
  Cursors contacts;
  for (std::size_t c = 0; c < contacts_; ++c) {
    contacts.push_back(Cursor::ahead(turning_, range.lo + equations_.length_to(c)));
  }
  const auto end_of = [&](std::size_t c) { return contacts[c].spiral().hi - offset_of(c, contacts[c]); };

  if (strips_.is_empty()) pieces_.reserve(contacts_ * (turning_.spirals().size() + 1));
  double here = range.lo;
  pass_corners(here, contacts);
  while (here < range.hi) {
    RollPiece& piece = pieces_.emplace_back();
    double next = range.hi;
    for (std::size_t c = 0; c < contacts_; ++c) {
      piece.spiral.push_back(static_cast<std::uint32_t>(contacts[c].index()));
      piece.offset.push_back(offset_of(c, contacts[c]));
      piece.angle.push_back(contacts[c].lift());
      // The piece ends where the first of the contacts leaves its spiral.
      if (!contacts[c].is_last()) next = std::min(next, end_of(c));
    }
    if (range.hi - next <= same_place) next = range.hi;
    piece.lo = here;
    piece.hi = next;
    // Contacts that pass within rounding of each other leave no piece between them.
    if (!(next - here > same_place)) pieces_.pop_back();
    here = std::max(here, next);
    bool moved = false;
    for (std::size_t c = 0; c < contacts_; ++c) {
      if (contacts[c].is_last() || end_of(c) - here > same_place) continue;
      contacts[c].advance();
      moved = true;
    }
    // At s = P of a closed part the corners are those of s = 0, which were passed first.
    if (moved && (here < range.hi || !turning_.closed())) pass_corners(here, contacts);
  }
}

/// The contacts that stand at a joint while the first one is at s, which their cursors have just passed.
void RollCurve::pass_corners(double s, const Cursors& contacts) {
  if (part_.corners().empty()) return;
  // The jump of Theta that contact c passes at s; empty where it is not at a joint.
  const auto jump_of = [&](const Cursor& ahead, std::size_t c) {
    const bool passes = std::abs(s + offset_of(c, ahead) - ahead.spiral().lo) <= kLengthAccuracy * turning_.perimeter();
    return passes ? std::optional(ahead.jump()) : std::nullopt;
  };
  const auto pivots = [&](double jump) { return std::abs(jump) > kTurnAccuracy && !Corner{s, jump}.is_concave(); };
  std::size_t corners = 0;
  for (std::size_t c = 0; c < contacts_; ++c) corners += pivots(jump_of(contacts[c], c).value_or(0)) ? 1 : 0;
  if (corners == 0) return;
  // {Theta} of each contact at s. A concave corner's jump is no set: the curve jumps, and only its pieces count.
  std::vector<Range> tangents;
  for (std::size_t c = 0; c < contacts_; ++c) {
    const std::optional<double> jump = jump_of(contacts[c], c);
    const double after = jump ? contacts[c].angle_after() : turning_.angle(s + equations_.length_to(c));
    const double before = jump && pivots(*jump) ? after - *jump : after;
    tangents.push_back({std::min(before, after), std::max(before, after)});
  }
  add_pivots(s, tangents);
  // Two contacts or more pivot independently: besides its edges the curve is all of a patch there.
  if (corners < 2) return;
  for (std::size_t c = 1; c < contacts_; ++c) {
    const double shift = equations_.shifts[c - 1];
    tangents[c] = tangents[c] + Range{shift, shift};
  }
  patches_.push_back({s, tangents, equations_.facing.value_or(0)});
}

/// Pieces of the pivots at s: for each contact that stands at a corner, it pivots while the others there stand at one
/// limit of their tangents, then at the other. x runs from 0 to the corner's turn. With two contacts at corners these
/// are the four edges of their patch.
void RollCurve::add_pivots(double s, const std::vector<Range>& tangents) {
  for (std::size_t contact = 0; contact < tangents.size(); ++contact) {
    if (tangents[contact].spread() == 0) continue;
    for (const bool others_after : {false, true}) {
      RollPiece piece;
      piece.pivot_at = s;
      piece.pivot = contact;
      piece.hi = tangents[contact].spread();
      bool others_pivot = false;
      for (std::size_t c = 0; c < tangents.size(); ++c) {
        others_pivot |= c != contact && tangents[c].spread() > 0;
        piece.angle.push_back(others_after && c != contact ? tangents[c].most : tangents[c].least);
      }
      if (others_after && !others_pivot) break;  // the same again
      pieces_.push_back(piece);
    }
  }
}

/// Finds the components that do not change along a piece: a whole lap, arcs of one radius, a symmetric part's period.
/// Bounds on both rates alone never show that the rates are the same. Where the slope vanishes at more points than the
/// turning function's polynomials have terms it vanishes in between.
void RollCurve::find_constants(RollPiece& piece, std::uint32_t first, std::uint32_t last) const {
  piece.constant.assign(rows(), true);
  boost::container::small_vector<double, 4> rate(contacts_);
  const int samples = piece.pivot_at ? 0 : kConstantSamples;  // where it pivots all rates are the same all along
  for (int k = 0; k <= samples; ++k) {
    const double* rates = k <= 1 ? &rates_[(k == 0 ? first : last) * contacts_] : rate.data();
    if (k > 1) {  // both ends first: nearly always they settle it
      const double x = piece.lo + piece.width() * (k - 1) / kConstantSamples;
      for (std::size_t c = 0; c < contacts_; ++c) rate[c] = contact_on_spiral(piece, x, c).turning.curvature;
    }
    // A slope below kNoSlope times the rates that it is made of is rounding.
    double scale = 1 / turning_.perimeter();
    for (std::size_t c = 0; c < contacts_; ++c) scale += std::abs(rates[c]);
    bool any = false;
    for (std::size_t row = 0; row < rows(); ++row) {
      const double slope = slope_of(rates, row);
      if (std::abs(slope) > kNoSlope * scale) piece.constant[row] = false;
      any = any || piece.constant[row];
    }
    // No component is left that may be constant.
    if (!any) return;
  }
}

template <class ContactOf>
void RollCurve::evaluate(const ContactOf& contact_of, double* value, double* rate) const {
  const Turning start = contact_of(0);
  rate[0] = start.curvature;
  for (std::size_t c = 1; c < contacts_; ++c) {
    const Turning end = contact_of(c);
    rate[c] = end.curvature;
    value[c - 1] = end.angle - start.angle + equations_.shifts[c - 1];  // one side of (8), (9)
  }
  if (equations_.facing) value[rows() - 1] = start.angle + *equations_.facing;
}

RollCurve::Place RollCurve::place(const Node& node, double x, std::size_t row) const {
  const Turning start = contact_between(node, x, 0).turning;
  if (is_facing(row)) return {start.angle + *equations_.facing, start.curvature};
  const Turning end = contact_between(node, x, row + 1).turning;
  return {end.angle - start.angle + equations_.shifts[row], end.curvature - start.curvature};
}

CurvePoint RollCurve::point(const Node& node, double x) const {
  // Beyond the node the curve goes on along its tangent at the nearer end.
  const double nearest = std::clamp(x, node.lo, node.hi);
  CurvePoint point(nearest, rows(), contacts_);
  evaluate([&](std::size_t c) { return contact_between(node, nearest, c).turning; }, point.values().data(),
           point.rates().data());
  for (std::size_t row = 0; row < rows(); ++row) point.slopes()[row] = slope_of(point.rates().data(), row);
  if (x != nearest) point.step(x - nearest);
  point.x = x;
  return point;
}

/// Makes room for so many points.
void RollCurve::make_room(std::size_t points) {
  values_.resize(points * rows(), boost::container::default_init);
  rates_.resize(points * contacts_, boost::container::default_init);
  panels_.resize(points * contacts_, boost::container::default_init);
}

template <class ContactOf>
std::uint32_t RollCurve::add_point(const ContactOf& contact_of) {
  const std::size_t index = points_++;
  // Twice as many: each point is moved a constant number of times on average.
  if (points_ * contacts_ > panels_.size()) make_room(2 * points_);
  std::uint32_t* panels = &panels_[index * contacts_];
  const auto keep_panel = [&](std::size_t c) {
    const Contact contact = contact_of(c);
    panels[c] = contact.panel;
    return contact.turning;
  };
  evaluate(keep_panel, &values_[index * rows()], &rates_[index * contacts_]);
  return static_cast<std::uint32_t>(index);
}

/// Bounds on component `row` between two points of a piece, `width` of x apart.
inline RollCurve::Component RollCurve::component_between(const RollPiece& piece, std::size_t row, std::uint32_t first,
                                                         std::uint32_t last, double width) const {
  const double* rates_first = &rates_[first * contacts_];
  const double* rates_last = &rates_[last * contacts_];
  Component component;
  component.first = values_[first * rows() + row];
  component.last = values_[last * rows() + row];
  component.first_slope = slope_of(rates_first, row);
  component.last_slope = slope_of(rates_last, row);
  component.value = hull(component.first, component.last);
  // Its slope is 0, also where the two rates' bounds would leave a range.
  if (piece.constant[row]) return component;
  component.slope = slopes_of(piece, rates_first, rates_last, row);
  // Half of what the slopes change by, of Theta at the first contact (shared by all components) and at the last (own).
  const double of_start = 0.5 * (rates_last[0] - rates_first[0]);
  component.shared = is_facing(row) ? of_start : -of_start;
  if (!is_facing(row)) component.own = hull(0, 0.5 * (rates_last[row + 1] - rates_first[row + 1]));
  // Monotone: between its values at the ends. Else the sharper of the cone by the slope and the strip by the rates'
  // change.
  if (component.slope.keeps_sign()) return component;
  const Range bend = 0.5 * width * (hull(0, component.shared) + component.own);
  component.value =
      common(value_range(component.first, component.last, component.slope, width), component.value - bend);
  return component;
}

/// A node on [lo, hi] of a piece; `first` and `last` are the points at its ends.
std::int32_t RollCurve::make_node(std::uint32_t piece, double lo, double hi, std::uint32_t first, std::uint32_t last) {
  Node node;
  node.lo = lo;
  node.hi = hi;
  node.piece = piece;
  node.first = first;
  node.last = last;
  return make_on_piece(node,
                       [&](std::size_t row) { return component_between(pieces_[piece], row, first, last, hi - lo); });
}

}  // namespace rollfix::locating
