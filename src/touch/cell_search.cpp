#include "cell_search.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "work/pulse.hpp"
#include "work/union_find.hpp"

// Notation:
//   q_i, delta_i    a touch's measured centre, and how far it may be off: `Measured::at`, `place_most`
//   tau_i, eps_i    tangent in the world by a measured normal (normal + 90 degrees): `tangent`, `angle_most`
//   (c, rho)        disc around a stretch of the path of centres: `Node::middle`, `radius`
//   theta +- w      the tangents on it: `Node::angle`, `half_turn`
//   (a, b)          stretches of two touches, a cell: `first`, `second`; phi +- h are the part's headings:
//                   `Cell::heading`
//   lists           stretches on which each further touch can be: `candidates_`, from `list.first` to `list.second`
//   f               a node is no wider than this to both sides of its tangent: `Node::flat`
// Tests: the chord, |R(phi)(c_b - c_a) - (q_2 - q_1)| <= rho_a + rho_b + delta_1 + delta_2, by the law of cosines, and
// where c_b - c_a is in the rectangle that the widths leave; normals, |tau - theta - phi| <= w + eps; further touches,
// from a and from b, |c_a + R(-phi)(q_i - q_1) - c_i| <= radii and deltas and 2 |q_i - q_1| sin(h / 2).
// Follows docs/touch.md, "How it works".
// Idea: branch and prune over pairs of stretches. Each test follows from "some pose has every residual within its
// most", so that no such pose is lost; a touch with an empty list refutes the cell. What is left hangs together by
// union and find: cells are neighbours where the places of both touches are and headings meet.
namespace rollfix::touch {
namespace {

// Headings are rounded, radians.
// Tests by normals are wider by it, so that rounding drops no cell.
constexpr double kGrain = 1e-12;

// Strips tell more than discs where they are longer than what touches are off by, and where two chords' ends are on
// strips whose directions have a sine below this.
constexpr double kAlike = 0.3;

/// How far from its middle the centres of a node are across a direction by which its own has this cosine and sine.
/// Its centres lie within `radius` of the middle, and within `flat` of its own line: both bound it, the smaller counts.
double across(double radius, double flat, double cosine, double sine) {
  return std::min(radius, cosine * flat + sine * radius);
}

/// Every vector from a centre of one single node to one of another. The box has the direction of `from`. Along it, `to`
/// reaches cos * radius + sin * flat, across it cos * flat + sin * radius: in each the cosine and the sine change
/// places.
VectorBox chords(const PathTree::Node& from, const PathTree::Node& to) {
  const Vec2 middle = to.middle - from.middle;
  const double cosine = std::abs(from.along.dot(to.along));
  const double sine = std::abs(cross(from.along, to.along));
  const double ahead = from.radius + across(to.radius, to.flat, sine, cosine);
  const double left = from.flat + across(to.radius, to.flat, cosine, sine);
  const Vec2 at(from.along.dot(middle), cross(from.along, middle));
  return {from.along, {at.x() - ahead, at.x() + ahead}, {at.y() - left, at.y() + left}};
}

/// Cells in order, and which of them are neighbours. REQUIRES that cells are sorted by the first touch's number, then
/// by the second's. All neighbours are found where the nodes of each touch are the leaves of one fineness, which do not
/// overlap. All cells with one first node are a column.
class Neighbours {
 public:
  Neighbours(const PathTree& first, const PathTree& second, const std::vector<Cell>& cells)
      : first_(first), second_(second), cells_(cells) {
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (k == 0 || cells[k].first != cells[k - 1].first) columns_.push_back({k, k});
      columns_.back().second = k + 1;
    }
  }

  /// Calls `found(i, j)` for neighbouring cells with the same stretch for the first touch.
  /// Each pair is found at least once from either side.
  template <class Found>
  void within(const Found& found) const {
    for (const Column& column : columns_) {
      for (std::size_t k = column.first; k < column.second; ++k) each_in(column, k, found);
    }
  }

  /// The same for those with neighbouring ones.
  /// Leaves do not overlap, so a column's only neighbours are the next one and, across the start, the first after the
  /// last. A gap of the path or of the cells between two columns shows in their numbers.
  template <class Found>
  void between(const Found& found) const {
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const std::size_t next = c + 1 < columns_.size() ? c + 1 : 0;
      if (next == c || !touch(first_, first(columns_[c].first), first(columns_[next].first))) continue;
      for (std::size_t k = columns_[c].first; k < columns_[c].second; ++k) each_in(columns_[next], k, found);
    }
  }

 private:
  // From the first cell of a column to behind its last one.
  using Column = std::pair<std::size_t, std::size_t>;

  // Numbers of the places of cell k, of the first touch and of the second.
  const Interval& first(std::size_t k) const { return first_.node(cells_[k].first).number; }
  const Interval& second(std::size_t k) const { return second_.node(cells_[k].second).number; }

  /// Whether the numbers of places meet, also across the start of a closed path.
  /// `period` 0: the path does not go round.
  static bool touch(const PathTree& tree, const Interval& one, const Interval& other) {
    if (one.lo <= other.hi && other.lo <= one.hi) return true;
    const double period = tree.path().period();
    return period > 0 && ((one.hi >= period && other.lo <= 0) || (other.hi >= period && one.lo <= 0));
  }

  /// Calls `found(k, j)` for each cell j of the column whose second place meets that of cell k, and whose headings do.
  /// The column is sorted: bisection, then one pass over those that meet.
  template <class Found>
  void each_in(const Column& column, std::size_t k, const Found& found) const {
    const Interval& at = second(k);
    const auto try_one = [&](std::size_t j) {
      if (j != k && touch(second_, at, second(j)) && meet(cells_[k].heading, cells_[j].heading)) found(k, j);
    };
    std::size_t lo = column.first;
    std::size_t hi = column.second;
    while (lo < hi) {  // the first whose second touch lies no further back
      const std::size_t middle = lo + (hi - lo) / 2;
      (second(middle).hi < at.lo ? lo : hi) = second(middle).hi < at.lo ? middle + 1 : middle;
    }
    for (std::size_t j = lo; j < column.second && second(j).lo <= at.hi; ++j) try_one(j);
    // On a closed path a neighbour across the start is the first or the last cell of the column.
    try_one(column.first);  // across the start
    try_one(column.second - 1);
  }

  const PathTree& first_;
  const PathTree& second_;
  const std::vector<Cell>& cells_;
  std::vector<Column> columns_;
};

}  // namespace

/// Compares all pairs of touches by (how many have a place, how many have a normal, distance in the world), the larger
/// first. A long chord fixes the heading best: it is off by about (delta_1 + delta_2) / distance.
TouchPair choose_pair(const std::vector<Measured>& touches) {
  TouchPair best;
  std::tuple<int, int, double> most{-1, -1, -1};
  for (std::size_t i = 0; i < touches.size(); ++i) {
    for (std::size_t j = i + 1; j < touches.size(); ++j) {
      const Measured& one = touches[i];
      const Measured& other = touches[j];
      const int places = (one.has_place ? 1 : 0) + (other.has_place ? 1 : 0);
      const int normals = (one.tangent ? 1 : 0) + (other.tangent ? 1 : 0);
      // Without both places there is no chord, and the distance does not count.
      const double apart = places == 2 ? (other.at - one.at).norm() : 0;
      const std::tuple<int, int, double> worth{places, normals, apart};
      if (worth <= most) continue;
      most = worth;
      // The places of the first are what the posterior is summed over: there are few where it has a normal.
      const bool in_order = one.has_place == other.has_place ? one.tangent || !other.tangent : one.has_place;
      best = in_order ? TouchPair{i, j} : TouchPair{j, i};
    }
  }
  return best;
}

/// REQUIRES two touches or more.
CellSearch::CellSearch(const std::vector<Measured>& touches, const TouchPair& pair, std::size_t budget,
                       std::size_t most_cells)
    : touches_(touches), pair_(pair), budget_(budget), most_cells_(most_cells) {
  for (std::size_t k = 0; k < touches.size(); ++k) {
    if (k != pair.first && k != pair.second) others_.push_back(k);
  }
}

/// Every start cell begins with the whole boundary as each further touch's list. Comparisons count on over all
/// searches.
Cells CellSearch::search(const std::vector<Cell>& from, double leaf) {
  leaf_ = leaf;
  found_ = {};
  for (const Cell& cell : from) {
    candidates_.clear();
    Lists lists;
    for (std::size_t k = 0; k < others_.size(); ++k) {
      candidates_.push_back(tree(others_[k]).root());
      lists.emplace_back(k, k + 1);
    }
    visit(cell, lists);
  }
  return std::move(found_);
}

/// phi = tau - theta, within w + eps: the headings with the touch on this node by its normal. All, without a normal.
HeadingArc CellSearch::by_normal(std::size_t touch, std::int32_t node) const {
  const Measured& one = touches_[touch];
  if (!one.tangent) return {};
  const PathTree::Node& at = tree(touch).node(node);
  return {nearest_angle(*one.tangent - at.angle), at.half_turn + one.angle_most + kGrain};
}

/// phi +- h of a cell: what the normals and, of two places, the chord leave. Empty: no pose has its touches on (a, b).
HeadingArc CellSearch::headings(const Cell& cell) const {
  const HeadingArc by_normals = common(by_normal(pair_.first, cell.first), by_normal(pair_.second, cell.second));
  const Measured& one = touches_[pair_.first];
  const Measured& other = touches_[pair_.second];
  if (by_normals.is_empty() || !one.has_place || !other.has_place) return by_normals;
  const PathTree::Node& first = tree(pair_.first).node(cell.first);
  const PathTree::Node& second = tree(pair_.second).node(cell.second);
  // The chord q_2 - q_1 is c_b - c_a turned by phi, but for both radii and both tolerances.
  const double slack = one.place_most + other.place_most;
  const Vec2 measured = other.at - one.at;
  const double radii = first.radius + second.radius;
  const HeadingArc by_discs =
      common(by_normals, headings_between(second.middle - first.middle, measured, radii + slack));
  // The rectangle of chords is tighter than the discs only where the two strips are nearly parallel and the discs
  // larger than the tolerances.
  const bool are_strips = first.is_single() && second.is_single() && radii > slack;
  if (by_discs.is_empty() || !are_strips || std::abs(cross(first.along, second.along)) > kAlike) return by_discs;
  return common(by_discs, headings_between(chords(first, second), measured, slack));
}

/// The larger of rho / (leaf delta) and w / (leaf eps), of those that were measured.
double CellSearch::size(std::size_t touch, std::int32_t node) const {
  const Measured& one = touches_[touch];
  const PathTree::Node& at = tree(touch).node(node);
  const double place = one.has_place ? at.radius / (leaf_ * one.place_most) : 0;
  if (!at.is_single()) return std::max(place, 1.5);  // only single ones are leaves
  return one.tangent ? std::max(place, at.half_turn / (leaf_ * one.angle_most)) : place;
}

/// Where a touch can be, with the two touches of the cell in theirs: by each of them that has a place.
CellSearch::Expected CellSearch::expected(const Cell& cell, std::size_t touch) const {
  const Measured& one = touches_[touch];
  Expected result;
  if (!one.has_place) return result;
  // A vector of length d, turned by up to h from the middle heading, ends no further than 2 d sin(h / 2) from there.
  const double swing = cell.heading.is_all() ? 2 : 2 * std::sin(0.5 * cell.heading.half);
  // c_a + R(-phi)(q_i - q_1), for the middle heading; its disc and its strip are those of the cell's node.
  const auto add = [&](std::size_t from, std::int32_t base) {
    if (!touches_[from].has_place) return;
    const PathTree::Node& of = tree(from).node(base);
    const Vec2 vector = one.at - touches_[from].at;
    const Vec2 in_part(cosine_ * vector.x() + sine_ * vector.y(), cosine_ * vector.y() - sine_ * vector.x());
    Around& around = result.places[result.count++];
    around = {of.middle + in_part, of.along, of.radius, of.flat,
              one.place_most + touches_[from].place_most + swing * vector.norm()};
  };
  add(pair_.first, cell.first);
  add(pair_.second, cell.second);
  return result;
}

/// Whether no centre of the node can be where the touch is expected, by discs and by strips. Discs: the middles are
/// further apart than both radii and the slack. Strips: the same across either node's own line, where the discs are
/// wider than the slack.
bool CellSearch::are_apart(const Around& around, const PathTree::Node& node) {
  const Vec2 off = node.middle - around.middle;
  const double radii = around.radius + node.radius;
  const double reach = radii + around.slack;
  if (off.squaredNorm() > reach * reach) return true;
  if (radii <= around.slack) return false;
  const double cosine = std::abs(around.along.dot(node.along));
  const double sine = std::abs(cross(around.along, node.along));
  return std::abs(cross(around.along, off)) >
             around.flat + across(node.radius, node.flat, cosine, sine) + around.slack ||
         std::abs(cross(node.along, off)) > node.flat + across(around.radius, around.flat, cosine, sine) + around.slack;
}

/// Whether a touch can be in this node.
/// By place from each of the pair that has one, then by the normal, |tau - theta - phi| <= w + eps + h.
bool CellSearch::may_hold(const Cell& cell, const Expected& expected, std::size_t touch, std::int32_t node) {
  ++comparisons_;
  const Measured& one = touches_[touch];
  const PathTree::Node& at = tree(touch).node(node);
  for (std::size_t k = 0; k < expected.count; ++k) {
    if (are_apart(expected.places[k], at)) return false;
  }
  if (!one.tangent) return true;
  const double off = std::abs(nearest_angle(*one.tangent - at.angle - cell.heading.middle));
  return off <= at.half_turn + one.angle_most + cell.heading.half + kGrain;
}

/// The nodes of a list that may hold a touch, halved down to the cell's own size, as a new list on top of the stack.
/// False: the list is empty, which refutes the cell.
bool CellSearch::narrow(const Cell& cell, std::size_t touch, std::pair<std::size_t, std::size_t>& list) {
  // Nodes much finer than the cell would refute little more, as the cell's own width is in every test.
  const double coarse = std::max({1.0, size(pair_.first, cell.first), size(pair_.second, cell.second)});
  const Expected places = expected(cell, touch);
  const std::size_t top = candidates_.size();
  waiting_.assign(candidates_.begin() + static_cast<std::ptrdiff_t>(list.first),
                  candidates_.begin() + static_cast<std::ptrdiff_t>(list.second));
  // `waiting_` holds nodes that are still to be tested, above `top` of the stack are those that passed at their size.
  while (!waiting_.empty()) {
    const std::int32_t node = waiting_.back();
    waiting_.pop_back();
    if (!may_hold(cell, places, touch, node)) continue;
    if (size(touch, node) > coarse) {
      const auto [left, right] = tree(touch).halves(node);
      if (left != right) {
        waiting_.push_back(left);
        waiting_.push_back(right);
        continue;
      }
    }
    candidates_.push_back(node);
  }
  list = {top, candidates_.size()};
  return list.first != list.second;
}

/// One cell of the search, to its end: it is refuted, found, left undecided, or halved. The stack of candidates has the
/// same height before and after. The heading is computed anew, from the cell's own nodes.
void CellSearch::visit(const Cell& cell, const Lists& lists) {
  // Undecided cells are kept, never dropped: they make the answer `incomplete`, or are searched again.
  if (comparisons_ >= budget_ || found_.fit.size() >= most_cells_) {
    found_.undecided.push_back(cell);
    return;
  }
  ++comparisons_;
  beat();
  Cell narrowed = cell;
  narrowed.heading = headings(cell);
  if (narrowed.heading.is_empty()) return;
  // Needed by `expected` for each further touch, so computed once a cell.
  cosine_ = std::cos(narrowed.heading.middle);
  sine_ = std::sin(narrowed.heading.middle);
  const std::size_t top = candidates_.size();
  // The parent's lists stay below on the stack: the sibling needs them as well.
  Lists own = lists;
  bool fits = true;
  for (std::size_t k = 0; k < others_.size() && fits; ++k) fits = narrow(narrowed, others_[k], own[k]);
  if (fits) split(narrowed, own);
  candidates_.resize(top);
}

/// Halves the node that is larger, in leaves; a cell of two leaves is found. A node is halved exactly if it is larger
/// than a leaf, so that the cells found have nodes that do not overlap.
void CellSearch::split(const Cell& cell, const Lists& lists) {
  const double first = size(pair_.first, cell.first);
  const double second = size(pair_.second, cell.second);
  const bool is_first = first >= second;
  const std::int32_t node = is_first ? cell.first : cell.second;
  const std::pair<std::int32_t, std::int32_t> halves = std::max(first, second) <= 1
                                                           ? std::make_pair(node, node)
                                                           : tree(is_first ? pair_.first : pair_.second).halves(node);
  // Two leaves, or a node too short to be halved in doubles.
  if (halves.first == halves.second) {
    found_.fit.push_back(cell);
    return;
  }
  for (const std::int32_t half : {halves.first, halves.second}) {
    Cell child = cell;
    (is_first ? child.first : child.second) = half;
    visit(child, lists);
  }
}

/// Two levels of union and find: cells to groups, within columns, and groups to components, between columns. O(n log n)
/// for n cells, but for pairs of neighbours that are compared.
CellSets sets_of(const PathTree& first, const PathTree& second, std::vector<Cell> cells) {
  // Neighbours::Neighbours relies on this order.
  std::sort(cells.begin(), cells.end(), [&](const Cell& one, const Cell& other) {
    const double a = first.node(one.first).number.lo;
    const double b = first.node(other.first).number.lo;
    return a != b ? a < b : second.node(one.second).number.lo < second.node(other.second).number.lo;
  });
  CellSets result;
  result.cells = std::move(cells);
  const Neighbours neighbours(first, second, result.cells);
  UnionFind columns(result.cells.size());
  neighbours.within([&](std::size_t i, std::size_t j) { columns.join(i, j); });
  result.groups = columns.sets();
  std::vector<std::size_t> group_of(result.cells.size());
  for (std::size_t g = 0; g < result.groups.size(); ++g) {
    for (const std::size_t k : result.groups[g]) group_of[k] = g;
  }
  UnionFind all(result.groups.size());
  neighbours.between([&](std::size_t i, std::size_t j) {
    result.links.emplace_back(group_of[i], group_of[j]);
    all.join(group_of[i], group_of[j]);
  });
  // Many pairs of cells link the same two groups.
  std::sort(result.links.begin(), result.links.end());
  result.links.erase(std::unique(result.links.begin(), result.links.end()), result.links.end());
  result.components = all.sets();
  return result;
}

}  // namespace rollfix::touch
