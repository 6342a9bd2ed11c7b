#include "rollfix/outline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "outline/joining.hpp"
#include "rollfix/error.hpp"
#include "text/text.hpp"
#include "work/pulse.hpp"

// Notation:
//   step            a curve of the drawing, and which way it is passed through: Step
//   chain           steps that follow one another: Chain; closed ones, and those that others joined, are `whole_`
//   end             of open chain i the number 2 i, its back 2 i + 1: EndClusters
//   gap             `gap_`: ends that are no further apart meet, and curves no longer are left out
//   branching       chains that hang together with a place where more than two ends meet
// Follows docs/files.md, "Loops".
// Idea: entities' own chains first, then what is drawn twice goes, then chains are joined where two ends meet. Of what
// branches nothing is guessed: it is left out, or its outside is taken where that is asked for (outer_face.cpp).
namespace rollfix::outline {

namespace {

/// Ends that are the same but for rounding: what `gap` can't be below.
constexpr double kRoundingShare = 1e-12;

/// A curve of the drawing as it is passed through.
struct Step {
  std::size_t curve = 0;
  bool forward = true;
};

/// Curves that are known to follow one another, because they are one entity's, or a whole loop.
struct Chain {
  std::vector<Step> steps;
  bool closed = false;
};

/// A point as messages show it.
std::string place(const Vec2& point) { return shown_point(point.x(), point.y()); }

/// What a message calls an entity: "ARC 'layer' of line 12".
std::string called(const Origin& origin) {
  const std::string layer = origin.layer.empty() ? "" : fmt::format(" '{}'", origin.layer);
  return fmt::format("{}{} of line {}", origin.entity, layer, origin.line);
}

/// Joins the curves of one drawing, in the steps of run(); docs/files.md, "Loops".
class Assembler {
 public:
  Assembler(const Drawing& drawing, const LoopOptions& options) : drawing_(drawing), outer_(options.outer) {
    if (drawing.curves.empty()) {
      throw InputError(fmt::format("{}: draws no curve: expected lines, arcs or splines", drawing.name));
    }
    // Each curve is measured once; all steps work on these numbers.
    measures_.reserve(drawing.curves.size());
    for (const DrawnCurve& drawn : drawing.curves) measures_.push_back(measure(drawn.curve));
    Box all;
    for (const CurveMeasure& one : measures_) all.extend(one.box);
    const double size = all.diagonal().norm();
    // A length. A gap below rounding would let ends that are the same not meet.
    gap_ = std::max(options.gap.value_or(kGapShare * size), kRoundingShare * size);
  }

  /// All loops. The order of the steps matters: what is tiny or drawn twice would look like a branch.
  Loops run() {
    leave_out_tiny_curves();
    make_chains();
    leave_out_what_is_drawn_twice();
    join_chains();
    return sorted();
  }

 private:
  /// What was measured of a curve, by its number in the drawing.
  const CurveMeasure& measured(std::size_t curve) const { return measures_[curve]; }
  /// The first point of a step, and the last one, in the direction in which it is passed through.
  Vec2 front(const Step& step) const { return step.forward ? measured(step.curve).front : measured(step.curve).back; }
  Vec2 back(const Step& step) const { return step.forward ? measured(step.curve).back : measured(step.curve).front; }
  /// Whether two points are within the gap.
  bool meet(const Vec2& a, const Vec2& b) const { return (a - b).norm() <= gap_; }

  /// Fills `used_` with the curves that are longer than the gap: the ends of the others all meet one another. Throws
  /// InputError: none is left.
  void leave_out_tiny_curves() {
    std::size_t tiny = 0;
    for (std::size_t k = 0; k < measures_.size(); ++k) {
      if (measured(k).box.diagonal().norm() <= gap_) {
        ++tiny;
      } else {
        used_.push_back(k);
      }
    }
    if (used_.empty()) {
      throw InputError(fmt::format("{}: all {} curves are shorter than the gap of {:.3g} within which ends meet",
                                   drawing_.name, tiny, gap_));
    }
    if (tiny > 0)
      notes_.push_back(fmt::format("left out: {} no longer than {:.3g}", counted(tiny, "curve", "curves"), gap_));
  }

  /// Chains all of whose curves other chains draw as well; of several alike the first stays. Two outlines that share a
  /// wall keep it both.
  void leave_out_what_is_drawn_twice() {
    // One entry for each curve of a chain, chain by chain: the number of the chain, of the curve, and its middle.
    std::vector<std::size_t> chain_of;
    std::vector<std::size_t> curves;
    std::vector<Vec2> middles;
    for (std::size_t chain = 0; chain < chains_.size(); ++chain) {
      for (const Step& step : chains_[chain].steps) {
        chain_of.push_back(chain);
        curves.push_back(step.curve);
        middles.push_back(measured(step.curve).middle);
      }
    }
    // Curves that are the same have the same middle: only those in one cluster need comparing.
    const EndClusters places(middles, gap_);
    std::vector<bool> is_gone(chains_.size(), false);
    // By another chain that stays, so that of two alike never both go.
    const auto is_drawn_elsewhere = [&](std::size_t i) {
      const std::vector<std::size_t>& beside = places.members(places.of(i));
      return std::any_of(beside.begin(), beside.end(), [&](std::size_t j) {
        return chain_of[j] != chain_of[i] && !is_gone[chain_of[j]] && is_same(measured(curves[i]), measured(curves[j]));
      });
    };
    // From the last chain to the first, so that of several alike the first stays. [end - count, end) is one chain.
    for (std::size_t end = curves.size(); end > 0;) {
      const std::size_t chain = chain_of[end - 1];
      const std::size_t count = chains_[chain].steps.size();
      std::size_t k = end - count;
      while (k < end && is_drawn_elsewhere(k)) ++k;
      // Every curve of the chain is drawn elsewhere.
      if (k == end) {
        count_as_twice(curves[end - 1], count);
        is_gone[chain] = true;
      }
      end -= count;
    }
    if (twice_ == 0) return;
    notes_.push_back(fmt::format("left out: {} that {} drawn twice, such as the {}", counted(twice_, "curve", "curves"),
                                 twice_ == 1 ? "is" : "are", called(drawing_.curves[example_].origin)));
    std::vector<Chain> kept;
    for (std::size_t chain = 0; chain < chains_.size(); ++chain) {
      if (!is_gone[chain]) kept.push_back(std::move(chains_[chain]));
    }
    chains_ = std::move(kept);
  }

  /// Counts curves that were left out; the first stands as the example.
  void count_as_twice(std::size_t curve, std::size_t count) {
    if (twice_ == 0) example_ = curve;
    twice_ += count;
  }

  /// Two curves that draw the same, in whichever direction: ends, middle and box agree within the gap.
  bool is_same(const CurveMeasure& a, const CurveMeasure& b) const {
    const bool same_ends = (meet(a.front, b.front) && meet(a.back, b.back)) ||  //
                           (meet(a.front, b.back) && meet(a.back, b.front));
    return same_ends && meet(a.middle, b.middle) && meet(a.box.min(), b.box.min()) && meet(a.box.max(), b.box.max());
  }

  /// What one entity draws in a row belongs together, also where it passes one of its own points again; but not where
  /// the outside of all is asked for, of which it may be a part only.
  void make_chains() {
    // Each curve lengthens the last chain or starts another one.
    for (const std::size_t curve : used_) {
      const Step step{curve, true};
      if (continues(curve)) {
        if (is_same(measured(chains_.back().steps.back().curve), measured(curve))) {  // there and back
          count_as_twice(curve, 1);
          continue;
        }
        chains_.back().steps.push_back(step);
      } else {
        chains_.push_back({{step}, false});
      }
      Chain& chain = chains_.back();
      // A chain that comes back to its start is a loop: the next curve starts another chain.
      chain.closed = meet(back(step), front(chain.steps.front()));
    }
  }

  /// Whether a curve goes on from the last chain: of the same entity, and its front where the chain ends.
  bool continues(std::size_t curve) const {
    if (outer_ || chains_.empty() || chains_.back().closed) return false;
    const std::size_t before = chains_.back().steps.back().curve;
    const Origin& one = drawing_.curves[before].origin;
    const Origin& other = drawing_.curves[curve].origin;
    const bool same_entity = one.line == other.line && one.entity == other.entity && one.layer == other.layer;
    return same_entity && meet(measured(before).back, measured(curve).front);
  }

  /// Joins chains where their ends meet. An end's number is twice its chain's, one more for its back.
  void join_chains() {
    // open[i] is a chain's number; its ends are the numbers 2 i (front) and 2 i + 1 (back).
    std::vector<std::size_t> open;
    std::vector<Vec2> ends;
    for (std::size_t k = 0; k < chains_.size(); ++k) {
      if (chains_[k].closed) {
        whole_.push_back(chains_[k]);
        continue;
      }
      open.push_back(k);
      ends.push_back(front(chains_[k].steps.front()));
      ends.push_back(back(chains_[k].steps.back()));
    }
    // Ends that meet are one cluster: two ends join, more branch, one is a loose end.
    const EndClusters clusters(ends, gap_);
    // `done`: not to be joined any more; `left_out`: what the user is told of.
    std::vector<bool> done = branching(clusters, open.size());
    std::vector<bool> left_out = done;
    if (outer_) take_outer_faces(clusters, open, left_out);
    if (std::find(left_out.begin(), left_out.end(), true) != left_out.end()) {
      tell_of_branches(clusters, ends, open, left_out);
    }
    // What is left has at most two ends in each cluster: its chains join without a choice.
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (!done[i]) whole_.push_back(chain_through(i, open, clusters, done));
    }
  }

  /// Which of the open chains hang together with an end where more than two meet.
  static std::vector<bool> branching(const EndClusters& clusters, std::size_t chains) {
    std::vector<bool> branches(chains, false);
    std::vector<std::size_t> waiting;
    const auto take = [&](std::size_t chain) {
      if (branches[chain]) return;
      branches[chain] = true;
      waiting.push_back(chain);
    };
    // First those at a branch, then all that hang on them.
    for (std::size_t end = 0; end < 2 * chains; ++end) {
      if (clusters.members(clusters.of(end)).size() > 2) take(end / 2);
    }
    // All that is connected with a branching end is taken, step by step.
    while (!waiting.empty()) {
      const std::size_t chain = waiting.back();
      waiting.pop_back();
      for (const std::size_t end : {2 * chain, 2 * chain + 1}) {
        const std::vector<std::size_t>& meeting = clusters.members(clusters.of(end));
        if (meeting.size() > 2) continue;  // all of them are taken
        for (const std::size_t other : meeting) take(other / 2);
      }
    }
    return branches;
  }

  /// Notes what was left out because it branches, and where: `branch_` and `branching_`, which are looked at once the
  /// loops are known.
  void tell_of_branches(const EndClusters& clusters, const std::vector<Vec2>& ends,
                        const std::vector<std::size_t>& open, const std::vector<bool>& branches) {
    // The box of all that is left out, and the number of its curves.
    std::size_t count = 0;
    for (std::size_t k = 0; k < open.size(); ++k) {
      if (!branches[k]) continue;
      for (const Step& step : chains_[open[k]].steps) branching_.extend(measured(step.curve).box);
      count += chains_[open[k]].steps.size();
    }
    const std::size_t end = first_branch(clusters, branches);
    const std::vector<std::size_t>& meeting = clusters.members(clusters.of(end));
    // Up to four of the curves that meet there, by name.
    std::vector<std::string> names;
    for (std::size_t k = 0; k < std::min<std::size_t>(meeting.size(), 4); ++k) {
      const Chain& chain = chains_[open[meeting[k] / 2]];
      const Step& step = meeting[k] % 2 == 0 ? chain.steps.front() : chain.steps.back();
      names.push_back(called(drawing_.curves[step.curve].origin));
    }
    branch_ = fmt::format("{} ends of curves meet near {}, expected two at most ({}{})", meeting.size(),
                          place(ends[end]), fmt::join(names, ", "), meeting.size() > names.size() ? ", ..." : "");
    notes_.push_back(fmt::format("left out: {} curves that hang together where {}", count, branch_));
  }

  /// The first end, of chains that are left out, at which more than two meet.
  static std::size_t first_branch(const EndClusters& clusters, const std::vector<bool>& branches) {
    std::size_t end = 0;
    while (end + 1 < 2 * branches.size() && !(branches[end / 2] && clusters.members(clusters.of(end)).size() > 2))
      ++end;
    return end;
  }

  /// Of the branching chains those around the outside of what hangs together become loops. Those whose outside is none
  /// stay left out.
  void take_outer_faces(const EndClusters& clusters, const std::vector<std::size_t>& open,
                        std::vector<bool>& left_out) {
    // The graph: clusters are its nodes, branching chains its edges.
    std::vector<Edge> edges;
    std::vector<std::size_t> chains;  // of each edge, its place in `open`
    for (std::size_t k = 0; k < open.size(); ++k) {
      if (!left_out[k]) continue;
      edges.push_back(edge_along(curves_of(chains_[open[k]]), clusters.of(2 * k), clusters.of(2 * k + 1)));
      chains.push_back(k);
    }
    // One face for each connected piece.
    for (const Face& face : outer_faces(edges, 2 * open.size())) {
      if (face.encloses && face.loops.empty()) continue;
      // An outside was found, or there is none as nothing is enclosed: either way these need no message of a branch.
      std::size_t all = 0;
      for (const std::size_t edge : face.edges) {
        left_out[chains[edge]] = false;
        all += chains_[open[chains[edge]]].steps.size();
      }
      std::size_t taken = 0;
      for (const std::vector<Passage>& around : face.loops) {
        Chain loop{{}, true};
        for (const Passage& one : around) append(chains_[open[chains[one.edge]]], one.forward, loop.steps);
        taken += loop.steps.size();
        whole_.push_back(std::move(loop));
      }
      notes_.push_back(taken == 0
                           ? fmt::format("left out: {} curves that hang together and enclose nothing", all)
                           : fmt::format("of {} curves that hang together {} are around the outside (`outer`), in {}; "
                                         "the others are left out",
                                         all, taken, counted(face.loops.size(), "loop", "loops")));
    }
  }

  /// The curves of a chain in the direction in which they are passed.
  std::vector<Curve> curves_of(const Chain& chain) const {
    std::vector<Curve> curves;
    for (const Step& step : chain.steps) {
      const Curve& curve = drawing_.curves[step.curve].curve;
      curves.push_back(step.forward ? curve : reversed(curve));
    }
    return curves;
  }

  /// Throws InputError where nothing else is closed; else says why the largest loop may not be the one that is meant.
  void hold_against_branches(Loops& found) const {
    // No branch, no doubt. Nor where all that branches is within the box of the largest loop.
    if (branch_.empty()) return;
    // What the user can do about it, in the order of what is likely to help.
    const std::string cure = fmt::format(
        "{}remove the curves that do not belong to the outline, or take one layer only with `layer`; ends "
        "within {:.3g} count as meeting (`gap`)",
        outer_ ? "their outside is no loop; " : "take what is around the outside of them with `outer`, ", gap_);
    // Nothing closed at all: the branch is why.
    if (found.closed.empty()) throw InputError(fmt::format("{}: {}: {}", drawing_.name, branch_, cure));
    if (box_around(polygon_of(found.closed.front().outline).points).contains(branching_)) return;
    found.doubt = fmt::format(
        "{}: {}, on curves outside of the largest sound loop, of length {:.6g}: {}; or take {} with `loop` 1",
        drawing_.name, branch_, found.closed.front().length, cure,
        found.closed.size() == 1 ? "it" : fmt::format("one of the {} sound loops", found.closed.size()));
  }

  /// From chain i on to where no other follows or to its own start, then back from its start.
  Chain chain_through(std::size_t i, const std::vector<std::size_t>& open, const EndClusters& clusters,
                      std::vector<bool>& done) const {
    Chain result = chains_[open[i]];
    done[i] = true;
    // Follows the ends from `end` on and appends what it passes. Each turn takes a chain that was not done, so it ends.
    const auto walk = [&](std::size_t end, std::vector<Step>& steps) {  // returns whether it came to its start
      while (true) {
        const std::optional<std::size_t> next = partner(clusters, end);
        if (!next) return false;
        const std::size_t chain = *next / 2;
        // Only the chain that the walk started with can be done here: the way has closed.
        if (done[chain]) return true;
        done[chain] = true;
        const bool forward = *next % 2 == 0;
        append(chains_[open[chain]], forward, steps);
        end = forward ? *next + 1 : *next - 1;
      }
    };
    // Forwards from its back. If that does not return to its start, backwards from its front.
    result.closed = walk(2 * i + 1, result.steps);
    if (result.closed) return result;
    std::vector<Step> before;
    walk(2 * i, before);
    std::reverse(before.begin(), before.end());
    // What was found backwards is turned round and put in front.
    for (Step& step : before) step.forward = !step.forward;
    before.insert(before.end(), result.steps.begin(), result.steps.end());
    result.steps = std::move(before);
    return result;
  }

  /// The other end in the cluster; nothing at a loose end.
  static std::optional<std::size_t> partner(const EndClusters& clusters, std::size_t end) {
    for (const std::size_t other : clusters.members(clusters.of(end))) {
      if (other != end) return other;
    }
    return std::nullopt;
  }

  /// Appends a chain's steps, or those of the chain against its direction.
  static void append(const Chain& chain, bool forward, std::vector<Step>& steps) {
    if (forward) {
      steps.insert(steps.end(), chain.steps.begin(), chain.steps.end());
      return;
    }
    for (auto step = chain.steps.rbegin(); step != chain.steps.rend(); ++step) {
      steps.push_back({step->curve, !step->forward});
    }
  }

  /// The outline of a chain with its length, area (of a closed one) and its largest gap, from what each curve was
  /// measured as.
  Loop loop_of(const Chain& chain) const {
    Loop loop;
    loop.first = chain.steps.front().curve;
    for (const Step& step : chain.steps) loop.first = std::min(loop.first, step.curve);
    loop.outline.name = drawing_.name;
    loop.outline.closed = chain.closed;
    // The area is summed as seen from one point near the loop, so that coordinates far from (0, 0) cost no digits.
    const Vec2 origin = front(chain.steps.front());
    double twice_area = 0;
    const std::size_t count = chain.steps.size();
    for (std::size_t k = 0; k < count; ++k) {
      const Step& step = chain.steps[k];
      const CurveMeasure& one = measured(step.curve);
      const Curve& curve = drawing_.curves[step.curve].curve;
      loop.outline.curves.push_back(step.forward ? curve : reversed(curve));
      loop.length += one.length;
      // Twice the area that the ray from `origin` sweeps: what the ray from the curve's own front sweeps, and the
      // triangle of both points and the curve's end.
      const double swept = one.twice_area + cross(one.front - origin, one.back - one.front);
      twice_area += step.forward ? swept : -swept;
      if (k + 1 == count && !chain.closed) break;
      const Vec2 next = front(chain.steps[(k + 1) % count]);
      loop.gap = std::max(loop.gap, (next - back(step)).norm());
      // The gap counts as a line.
      twice_area += cross(back(step) - origin, next - origin);
    }
    loop.area = chain.closed ? 0.5 * std::abs(twice_area) : 0;
    loop.outline.gap = loop.gap;
    return loop;
  }

  /// The result: closed loops by area, open ones by length, with depths; what branches is held against the loops.
  Loops sorted() {
    Loops result;
    for (const Chain& chain : whole_) (chain.closed ? result.closed : result.open).push_back(loop_of(chain));
    std::stable_sort(result.closed.begin(), result.closed.end(),
                     [](const Loop& a, const Loop& b) { return a.area > b.area; });
    std::stable_sort(result.open.begin(), result.open.end(),
                     [](const Loop& a, const Loop& b) { return a.length > b.length; });
    find_depths(result.closed);
    hold_against_branches(result);
    result.notes = std::move(notes_);
    return result;
  }

  /// Fills depth and hole: an odd depth is a hole, as between two outlines inside each other there is material.
  static void find_depths(std::vector<Loop>& closed) {
    std::vector<Polygon> polygons;
    polygons.reserve(closed.size());
    for (const Loop& loop : closed) polygons.push_back(polygon_of(loop.outline));
    const std::vector<int> depths = nesting_depths(polygons);
    for (std::size_t k = 0; k < closed.size(); ++k) {
      closed[k].depth = depths[k];
      closed[k].outline.hole = depths[k] % 2 == 1;
    }
  }

  const Drawing& drawing_;
  std::vector<CurveMeasure> measures_;  // of all curves of the drawing
  bool outer_ = false;                  // the outside of what branches is asked for
  double gap_ = 0;                      // length
  std::vector<std::size_t> used_;       // curves not left out
  std::vector<Chain> chains_;           // of one entity each
  std::vector<Chain> whole_;            // closed, or joined as far as it goes
  std::vector<std::string> notes_;      // for the user, in the order of the steps
  std::size_t twice_ = 0;               // curves left out because others are the same, ...
  std::size_t example_ = 0;             // ... one of them
  std::string branch_;                  // where more than two ends meet; empty: nowhere
  Box branching_;                       // around the curves that hang together there
};

}  // namespace

}  // namespace rollfix::outline

namespace rollfix {

/// By Green's theorem, curve by curve, as seen from the first point. A gap between two curves is not followed: it
/// changes the area by the gap times the outline's size at most.
double enclosed_area(const Outline& outline) {
  double twice_area = 0;
  const Vec2 origin = outline.curves.front().front();
  for (const Curve& curve : outline.curves) {
    const outline::CurveMeasure one = outline::measure(curve);
    twice_area += one.twice_area + cross(one.front - origin, one.back - one.front);
  }
  return 0.5 * std::abs(twice_area);
}

Loops loops(const Drawing& drawing, const LoopOptions& options) {
  const Doing doing("joining the curves of the drawing");
  return outline::Assembler(drawing, options).run();
}

}  // namespace rollfix
