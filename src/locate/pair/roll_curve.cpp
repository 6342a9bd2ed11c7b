#include "roll_curve.hpp"

#include <algorithm>
#include <cmath>

#include "locate/corner_sets.hpp"

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
    : part_(part),
      turning_(part.turning()),
      equations_(std::move(equations)),
      strips_(part, equations_, range),
      rows_(equations_.rows()),
      contacts_(equations_.contacts()) {
  root_ = strips_.is_empty() ? cut(range) : make_uncut(range, strips_.whole().data());
}

// What is called for every place is inline.

inline RollCurve::Contact RollCurve::contact_at(const RollPiece& piece, double x, std::size_t c,
                                                std::uint32_t first_panel, std::uint32_t last_panel) const {
  const double base = x + piece.offset[c];
  const std::uint32_t panel = turning_.panel_index(first_panel, last_panel, base);
  const Turning at = turning_.on_panel(turning_.panels()[panel], base);
  ++evaluations_;
  return {{piece.angle[c] + at.angle, at.curvature}, panel};
}

inline RollCurve::Contact RollCurve::contact_on_spiral(const RollPiece& piece, double x, std::size_t c) const {
  if (piece.pivot_at) return pivot_at(piece, x, c);
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

inline RollCurve::Contact RollCurve::contact_between(const Node& node, double x, std::size_t c) const {
  const RollPiece& piece = this->piece(node);
  if (piece.pivot_at) return pivot_at(piece, x, c);
  return contact_at(piece, x, c, panels_[node.first * contacts_ + c], panels_[node.last * contacts_ + c]);
}

/// A node over all pieces of this range.
std::int32_t RollCurve::cut(const Interval& range) {
  const std::size_t before = pieces_.size();
  make_pieces(range);
  const auto first_node = static_cast<std::int32_t>(nodes_.size());
  if (before == 0) {
    const std::size_t room = kRoomOfPiece * pieces_.size() + kRoomAtFirst;
    nodes_.reserve(room);
    components_.reserve(room * rows_);
    make_room(room);
  }
  boost::container::small_vector<Contact, 4> at(contacts_);
  const auto contact_of = [&](std::size_t c) { return at[c]; };
  for (std::size_t k = before; k < pieces_.size(); ++k) {
    RollPiece& piece = pieces_[k];
    const bool goes_on = k > before && pieces_[k - 1].hi == piece.lo && !pieces_[k - 1].pivot_at && !piece.pivot_at;
    for (std::size_t c = 0; c < contacts_; ++c) {
      const bool is_known = goes_on && pieces_[k - 1].spiral[c] == piece.spiral[c];
      if (!is_known) at[c] = contact_on_spiral(piece, piece.lo, c);
    }
    const std::uint32_t first = add_point(contact_of);
    for (std::size_t c = 0; c < contacts_; ++c) at[c] = contact_on_spiral(piece, piece.hi, c);
    const std::uint32_t last = add_point(contact_of);
    find_constants(piece, first, last);
    make_node(static_cast<std::uint32_t>(k), piece.lo, piece.hi, first, last);
  }
  if (pieces_.size() == before) return -1;
  return join(first_node, static_cast<std::int32_t>(nodes_.size()));
}

std::int32_t RollCurve::make_uncut(const Interval& s, const RollStrips::Span* spans) {
  Node node;
  node.lo = s.lo;
  node.hi = s.hi;
  node.first = static_cast<std::uint32_t>(spans_.size());
  spans_.insert(spans_.end(), spans, spans + contacts_);
  boost::container::small_vector<Range, 4> values(rows_);
  strips_.bound(s, &spans_[node.first], values.data());
  for (const Range& value : values) components_.emplace_back().value = value;
  if (rows_ > 1) node.diagonals = {values[0] + values[1], values[0] - values[1]};
  nodes_.push_back(node);
  return static_cast<std::int32_t>(nodes_.size() - 1);
}

/// Gives an uncut node its children: pieces where they are few.
void RollCurve::divide(std::size_t index) {
  const Interval s{nodes_[index].lo, nodes_[index].hi};
  const RollStrips::Span* spans = &spans_[nodes_[index].first];
  boost::container::small_vector<RollStrips::Span, 8> halves(2 * contacts_);
  const bool few = strips_.cuts(spans) <= kFewCuts;
  const double middle = few ? s.lo : strips_.halve(spans, halves.data(), halves.data() + contacts_);
  std::int32_t left = -1;
  std::int32_t right = -1;
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
  adopt(static_cast<std::int32_t>(index), left, right);
}

/// Gives a node its halves, whose bounds leave less than its own and its parents' did.
void RollCurve::adopt(std::int32_t index, std::int32_t left, std::int32_t right) {
  nodes_[static_cast<std::size_t>(index)].left = left;
  nodes_[static_cast<std::size_t>(index)].right = right;
  for (const std::int32_t half : {left, right}) {
    if (half >= 0) nodes_[static_cast<std::size_t>(half)].parent = index;
  }
  while (index >= 0 && tighten(index)) index = node(index).parent;
}

/// Bounds on both halves are bounds on the whole. False: they leave no less.
bool RollCurve::tighten(std::int32_t index) {
  Node& node = nodes_[static_cast<std::size_t>(index)];
  if (node.left < 0 || node.right < 0) return false;
  const Node& left = this->node(node.left);
  const Node& right = this->node(node.right);
  bool tighter = false;
  const auto take = [&](Range& whole, const Range& one, const Range& other) {
    const Range both = hull(one, other);
    if (!(both.least > whole.least || both.most < whole.most)) return;
    whole = common(whole, both);
    tighter = true;
  };
  Component* of = &components_[static_cast<std::size_t>(index) * rows_];
  for (std::size_t row = 0; row < rows_; ++row) {
    take(of[row].value, components(node.left)[row].value, components(node.right)[row].value);
  }
  for (const std::size_t k : {0U, 1U}) take(node.diagonals[k], left.diagonals[k], right.diagonals[k]);
  return tighter;
}

/// Cuts the range of first contacts wherever a contact passes from one spiral to the next, and puts a pivot wherever
/// one passes a convex corner, or the tiny concave joint of a drawing (kJointTurn).
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
      if (!contacts[c].is_last()) next = std::min(next, end_of(c));
    }
    if (range.hi - next <= same_place) next = range.hi;
    piece.lo = here;
    piece.hi = next;
    if (!(next - here > same_place)) pieces_.pop_back();
    here = std::max(here, next);
    bool moved = false;
    for (std::size_t c = 0; c < contacts_; ++c) {
      if (contacts[c].is_last() || end_of(c) - here > same_place) continue;
      contacts[c].advance();
      moved = true;
    }
    if (moved && (here < range.hi || !turning_.closed())) pass_corners(here, contacts);
  }
}

/// The contacts that stand at a joint while the first one is at s, which their cursors have just passed.
void RollCurve::pass_corners(double s, const Cursors& contacts) {
  if (part_.corners().empty()) return;
  const auto jump_of = [&](const Cursor& ahead, std::size_t c) {
    const bool passes = std::abs(s + offset_of(c, ahead) - ahead.spiral().lo) <= kLengthAccuracy * turning_.perimeter();
    return passes ? std::optional(ahead.jump()) : std::nullopt;
  };
  const auto pivots = [&](double jump) { return std::abs(jump) > kTurnAccuracy && !Corner{s, jump}.is_concave(); };
  std::size_t corners = 0;
  for (std::size_t c = 0; c < contacts_; ++c) corners += pivots(jump_of(contacts[c], c).value_or(0)) ? 1 : 0;
  if (corners == 0) return;
  std::vector<Range> tangents;
  for (std::size_t c = 0; c < contacts_; ++c) {
    const std::optional<double> jump = jump_of(contacts[c], c);
    const double after = jump ? contacts[c].angle_after() : turning_.angle(s + equations_.length_to(c));
    const double before = jump && pivots(*jump) ? after - *jump : after;
    tangents.push_back({std::min(before, after), std::max(before, after)});
  }
  add_pivots(s, tangents);
  if (corners < 2) return;
  for (std::size_t c = 1; c < contacts_; ++c) {
    const double shift = equations_.shifts[c - 1];
    tangents[c] = tangents[c] + Range{shift, shift};
  }
  patches_.push_back({s, tangents, equations_.facing.value_or(0)});
}

/// One contact pivots while the others stand at one limit of their tangents or at the other.
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

/// Bounds on the two rates of a component never see that they are the same: a whole lap, a symmetric part. Where the
/// slope vanishes at more points than the turning function's polynomials have terms it vanishes in between.
void RollCurve::find_constants(RollPiece& piece, std::uint32_t first, std::uint32_t last) const {
  piece.constant.assign(rows_, true);
  boost::container::small_vector<double, 4> rate(contacts_);
  const int samples = piece.pivot_at ? 0 : kConstantSamples;  // where it pivots all rates are the same all along
  for (int k = 0; k <= samples; ++k) {
    const double* rates = k <= 1 ? &rates_[(k == 0 ? first : last) * contacts_] : rate.data();
    if (k > 1) {  // both ends first: nearly always they settle it
      const double x = piece.lo + piece.width() * (k - 1) / kConstantSamples;
      for (std::size_t c = 0; c < contacts_; ++c) rate[c] = contact_on_spiral(piece, x, c).turning.curvature;
    }
    double scale = 1 / turning_.perimeter();
    for (std::size_t c = 0; c < contacts_; ++c) scale += std::abs(rates[c]);
    bool any = false;
    for (std::size_t row = 0; row < rows_; ++row) {
      const double slope = row + 1 < contacts_ ? rates[row + 1] - rates[0] : rates[0];
      if (std::abs(slope) > kNoSlope * scale) piece.constant[row] = false;
      any = any || piece.constant[row];
    }
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
  if (equations_.facing) value[rows_ - 1] = start.angle + *equations_.facing;
}

RollCurve::Place RollCurve::place(const Node& node, double x, std::size_t row) const {
  const Turning start = contact_between(node, x, 0).turning;
  if (is_facing(row)) return {start.angle + *equations_.facing, start.curvature};
  const Turning end = contact_between(node, x, row + 1).turning;
  return {end.angle - start.angle + equations_.shifts[row], end.curvature - start.curvature};
}

void RollCurve::move(RollPoint& point, const Node& node, double x) const {
  point.x = x;
  point.value.resize(rows_, boost::container::default_init);
  point.rate.resize(contacts_, boost::container::default_init);
  const double nearest = std::clamp(x, node.lo, node.hi);
  const auto contact_of = [&](std::size_t c) { return contact_between(node, nearest, c).turning; };
  evaluate(contact_of, point.value.data(), point.rate.data());
  if (x != nearest) {
    for (std::size_t row = 0; row < rows_; ++row) point.value[row] += (x - nearest) * point.slope(row);
  }
}

RollPoint RollCurve::stored(std::uint32_t index, double x) const {
  RollPoint point;
  point.x = x;
  const double* value = &values_[index * rows_];
  const double* rate = &rates_[index * contacts_];
  point.value.assign(value, value + rows_);
  point.rate.assign(rate, rate + contacts_);
  return point;
}

void RollCurve::make_room(std::size_t points) {
  values_.resize(points * rows_, boost::container::default_init);
  rates_.resize(points * contacts_, boost::container::default_init);
  panels_.resize(points * contacts_, boost::container::default_init);
}

template <class ContactOf>
std::uint32_t RollCurve::add_point(const ContactOf& contact_of) {
  const std::size_t index = points_++;
  if (points_ * contacts_ > panels_.size()) make_room(2 * points_);
  std::uint32_t* panels = &panels_[index * contacts_];
  const auto keep_panel = [&](std::size_t c) {
    const Contact contact = contact_of(c);
    panels[c] = contact.panel;
    return contact.turning;
  };
  evaluate(keep_panel, &values_[index * rows_], &rates_[index * contacts_]);
  return static_cast<std::uint32_t>(index);
}

inline RollCurve::Component RollCurve::component_between(const RollPiece& piece, std::size_t row, std::uint32_t first,
                                                         std::uint32_t last, double width) const {
  const double* rates_first = &rates_[first * contacts_];
  const double* rates_last = &rates_[last * contacts_];
  Component component;
  component.first = values_[first * rows_ + row];
  component.last = values_[last * rows_ + row];
  component.value = hull(component.first, component.last);
  if (piece.constant[row]) return component;
  component.slope = slope_between(piece, rates_first, rates_last, row);
  const double of_start = 0.5 * (rates_last[0] - rates_first[0]);
  component.by_start = is_facing(row) ? of_start : -of_start;
  if (!is_facing(row)) component.by_end = 0.5 * (rates_last[row + 1] - rates_first[row + 1]);
  if (component.slope.keeps_sign()) return component;
  const Range bend = 0.5 * width * (hull(0, component.by_start) + hull(0, component.by_end));
  component.value =
      common(value_range(component.first, component.last, component.slope, width), component.value - bend);
  return component;
}

std::int32_t RollCurve::make_node(std::uint32_t piece, double lo, double hi, std::uint32_t first, std::uint32_t last) {
  Node& node = nodes_.emplace_back();
  node.lo = lo;
  node.hi = hi;
  node.piece = piece;
  node.first = first;
  node.last = last;
  for (std::size_t row = 0; row < rows_; ++row) {
    components_.push_back(component_between(pieces_[piece], row, first, last, hi - lo));
  }
  if (rows_ > 1) {
    const Component& one = components_[components_.size() - rows_];
    const Component& two = components_[components_.size() - rows_ + 1];
    node.diagonals = {common(Combination{1, 1, one, two}.value(hi - lo), one.value + two.value),
                      common(Combination{1, -1, one, two}.value(hi - lo), one.value - two.value)};
  }
  return static_cast<std::int32_t>(nodes_.size() - 1);
}

/// A node over these of pieces, the last one not included.
std::int32_t RollCurve::join(std::int32_t from, std::int32_t to) {
  if (to - from == 1) return from;
  const std::int32_t middle = from + (to - from) / 2;
  Node node;
  node.left = join(from, middle);
  node.right = join(middle, to);
  const Node& first = this->node(node.left);  // good until the next one is made
  const Node& last = this->node(node.right);
  node.lo = first.on_one_piece() ? piece(first).s(first.lo) : first.lo;
  node.hi = last.on_one_piece() ? piece(last).s(last.hi) : last.hi;
  for (std::size_t row = 0; row < rows_; ++row) {
    Component component;
    component.value = hull(components(node.left)[row].value, components(node.right)[row].value);
    components_.push_back(component);
  }
  for (const std::size_t k : {0U, 1U}) node.diagonals[k] = hull(first.diagonals[k], last.diagonals[k]);
  nodes_.push_back(node);
  const auto index = static_cast<std::int32_t>(nodes_.size() - 1);
  for (const std::int32_t half : {node.left, node.right}) nodes_[static_cast<std::size_t>(half)].parent = index;
  return index;
}

std::pair<std::int32_t, std::int32_t> RollCurve::halves(std::int32_t index) {
  if (!node(index).on_one_piece() && node(index).left < 0) divide(static_cast<std::size_t>(index));
  const Node node = this->node(index);
  if (node.left >= 0 || !node.on_one_piece()) return {node.left, node.right};
  const double x = 0.5 * (node.lo + node.hi);
  const std::uint32_t middle = add_point([&](std::size_t c) { return contact_between(node, x, c); });
  const std::int32_t left = make_node(node.piece, node.lo, x, node.first, middle);
  const std::int32_t right = make_node(node.piece, x, node.hi, middle, node.last);
  adopt(index, left, right);
  return {left, right};
}

}  // namespace rollfix::locating
