#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "belief/two/pair_density.hpp"
#include "outline/turn.hpp"
#include "rollfix/turning_function.hpp"

// Notation:
//   w               tilted turnings (w_a, w_b) of two first contacts: `PairStart::w`
//   deviance        -2 log L(w): `cost + log_volume`
//   g, F            slope and expected information of log L by w: `PairScore::slope`, `information`
//   lambda          Levenberg's damping: `damping`
//   step            (F + lambda diag F)^-1 g
// Follows docs/two_fingers.md, "The search", step 2; K. Levenberg, "A method for the solution of certain non-linear
// problems in least squares" (1944).
// Idea: from every candidate that no neighbour surpasses climb to a maximum, with few rows first and then with all.
// Near corners the slope misleads: there steps along the axes of F are tried as well (`search_around`).
namespace rollfix::belief {

namespace {

// Rows that candidates are compared by, and that the first steps from them take.
constexpr std::size_t kVeryFewRows = 20;
// Of what these leave, each comparison takes so many times more.
constexpr std::size_t kRowsMore = 4;
constexpr std::size_t kFewRows = 40;
constexpr int kCoarseSteps = 12;
constexpr int kFineSteps = 8;
// Candidates whose deviance with few rows is further above the best one's than this, in units of how badly the best
// fits itself, can't be the answer.
constexpr double kHopeless = 120;
constexpr std::size_t kMostStarts = 400;
constexpr std::size_t kMostPeaks = 200;
// Of as many, half are the best there are; the others come from wherever they can, of so many parts of a perimeter: a
// plateau has thousands, all as good, and would leave none for what is a little worse elsewhere.
constexpr std::uint32_t kParts = 16;
// Of an explanation on trial only the best peak matters.
constexpr std::size_t kMostStartsOnTrial = 100;
constexpr std::size_t kMostPeaksOnTrial = 24;
constexpr std::size_t kMostSearchedOnTrial = 3;
constexpr double kSmallStep = 1e-3;  // in standard deviations
// Near corners variances change so fast that the cost's slope misleads: from where it leads to, steps along and across
// are tried, from this many standard deviations down to that many.
constexpr double kFirstTrial = 6;
constexpr double kLastTrial = 0.2;
constexpr int kMostTrials = 100;
constexpr double kLongestTrial = 0.01;  // of an arc
// Only where the deviance is within this of the best one's.
constexpr double kWorthTrying = 80;
// A pivot begins where the boundary before the corner ends, but for this share of the perimeter.
constexpr double kBeforeCorner = 1e-9;

/// -2 log L, up to what is the same everywhere.
double deviance(const PairScore& score) { return score.cost + score.log_volume; }

/// Levenberg's method from a pair, at most so many steps. The deviance never rises: a step that would raise it is not
/// taken, and damping grows.
PairPeak climb(const PairModel& model, PairPeak peak, const std::vector<PairNode>& nodes, int steps) {
  double damping = 1e-3;
  for (int k = 0; k < steps; ++k) {
    Eigen::Matrix2d information = peak.score.information;
    // Where a direction is not known at all, the matrix stays regular.
    const double floor = 1e-9 * information.trace() + 1e-300;
    information(0, 0) += damping * information(0, 0) + floor;
    information(1, 1) += damping * information(1, 1) + floor;
    Eigen::Vector2d step = information.ldlt().solve(peak.score.slope);
    // No further than from one side of the part to the other.
    for (const std::size_t finger : {0U, 1U}) {
      const auto i = static_cast<Eigen::Index>(finger);
      const double most = 0.05 * (peak.start.arc[finger]->hi() - peak.start.arc[finger]->lo());
      if (std::abs(step[i]) > most) step *= most / std::abs(step[i]);
    }
    if (!std::isfinite(step[0]) || !std::isfinite(step[1])) break;
    const PairStart start = moved(peak.start, step);
    PairScore score = score_of(model, start, nodes, peak.score.errors, 2);
    if (deviance(score) <= deviance(peak.score)) {
      // The step in standard deviations: below kSmallStep it is there.
      const double length = std::sqrt(std::max(0.0, step.dot(peak.score.information * step)));
      peak.start = start;
      peak.score = score;
      damping = std::max(1e-6, 0.1 * damping);
      if (length < kSmallStep) break;
    } else {
      damping = std::max(1e-2, 8 * damping);
      if (damping > 1e6) break;
    }
  }
  return peak;
}

/// Pattern search along the axes of F: four directions, steps 1.5 times as long after a success and half after none.
PairPeak search_around(const PairModel& model, PairPeak peak, const std::vector<PairNode>& nodes) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(peak.score.information);
  Eigen::Matrix2d frame;
  double longest = 1e300;
  for (const TiltedArc* arc : peak.start.arc) longest = std::min(longest, kLongestTrial * (arc->hi() - arc->lo()));
  for (const Eigen::Index i : {0, 1}) {
    // A standard deviation each way, and no longer than kLongestTrial of an arc where F knows nothing.
    const double precision = std::max(1e-300, solver.eigenvalues()[i]);
    frame.col(i) = std::min(longest, 1 / std::sqrt(precision)) * solver.eigenvectors().col(i);
  }
  int trials = 0;
  for (double size = kFirstTrial; size > kLastTrial && trials < kMostTrials;) {
    bool is_better = false;
    for (int k = 0; k < 4 && !is_better; ++k) {
      const Eigen::Vector2d step = (k % 2 == 0 ? size : -size) * frame.col(k / 2);
      const PairStart start = moved(peak.start, step);
      const PairScore score = score_of(model, start, nodes, peak.score.errors, 2);
      ++trials;
      if (deviance(score) < deviance(peak.score)) {
        peak = {start, score};
        is_better = true;
      }
    }
    size *= is_better ? 1.5 : 0.5;
  }
  return peak;
}

/// The same rows by lengths and turns alone.
std::vector<PairNode> without_centres(std::vector<PairNode> nodes) {
  for (PairNode& node : nodes) node.centres.reset();
  return nodes;
}

/// The likelier one is less.
bool by_deviance(const PairPeak& one, const PairPeak& other) { return deviance(one.score) < deviance(other.score); }

/// Where one first contact may be in a cell: a place on the boundary, or a corner at which the finger has pivoted by up
/// to `pivot` from w on.
struct Stand {
  const TiltedArc* arc = nullptr;
  double w = 0;
  double pivot = 0;
};

/// Where s is on the boundary: nothing where a finger can't be there.
std::optional<Stand> stand_at(const PairModel& model, std::size_t finger, double s) {
  for (const TiltedArc& arc : model.boundary[finger]->arcs()) {
    const double lo = arc.at(arc.lo()).s;
    const double from_lo = model.places.ahead(lo, s);
    // s grows with w: halve until w is found.
    double below = arc.lo();
    double above = arc.hi();
    // How far s is ahead of the arc's start; beyond the arc's length it is on another one.
    const double end = arc.loop() ? lo + model.perimeter() : arc.at(arc.hi()).s;
    if (from_lo < 0 || from_lo > end - lo) continue;
    for (int k = 0; k < 40; ++k) {
      const double middle = 0.5 * (below + above);
      (arc.at(middle).s - lo < from_lo ? below : above) = middle;
    }
    return Stand{&arc, below};
  }
  return std::nullopt;
}

/// The places of a finger in the cells of the candidates' grid that are in use: the middle of each, or of each interval
/// between passings in it, and its corners.
class Stands {
 public:
  Stands(const PairModel& model, std::size_t finger, std::uint32_t cells, const Passings* passings)
      : model_(model), finger_(finger), step_(model.perimeter() / static_cast<double>(cells)), passings_(passings) {}

  /// Computed once for each cell. Empty where this finger can't be in it.
  const std::vector<Stand>& in(std::uint32_t cell) {
    const auto [found, is_new] = of_cell_.try_emplace(cell);
    if (is_new) add_places(cell, found->second);
    return found->second;
  }

 private:
  void add_places(std::uint32_t cell, std::vector<Stand>& places) const {
    const double from = static_cast<double>(cell) * step_;
    for (const double s : middles_in(from)) {
      if (const auto middle = stand_at(model_, finger_, s)) places.push_back(*middle);
    }
    for (const Corner& corner : model_.part->corners()) {
      if (corner.s < from || corner.s >= from + step_ || !is_felt(model_, corner)) continue;
      // Just before the corner w is that of a pivot that begins; it goes on for `corner.turn`.
      auto pivot = stand_at(model_, finger_, corner.s - kBeforeCorner * model_.perimeter());
      if (!pivot) continue;
      pivot->pivot = corner.turn;
      places.push_back(*pivot);
    }
  }

  /// Of the cell from here on: the middle of each group of passings that a contact's error can't tell apart, and of
  /// each gap between two.
  std::vector<double> middles_in(double from) const {
    std::vector<double> middles;
    double begin = from;
    const std::span<const Passing> passings =
        passings_ == nullptr ? std::span<const Passing>() : passings_->between(from, from + step_);
    for (auto next = passings.begin(); next != passings.end();) {
      const double first = next->s;
      double last = first;
      // Passings nearer together than kWide of their standard deviations are one group.
      while (++next != passings.end() && next->s - last < kWide * next->sd) last = next->s;
      middles.push_back(0.5 * (begin + first));
      middles.push_back(0.5 * (first + last));
      begin = last;
    }
    middles.push_back(0.5 * (begin + from + step_));
    return middles;
  }

  const PairModel& model_;
  std::size_t finger_;
  double step_;               // length of a cell
  const Passings* passings_;  // none: nullptr
  std::unordered_map<std::uint32_t, std::vector<Stand>> of_cell_;
};

/// How far fingers at corners have pivoted follows from the facing, where it is known: Theta(s) - Theta(t) = C. Else,
/// and of both at first, half way.
PairStart faced(const PairModel& model, const std::array<Stand, 2>& stands, const PairNode& first) {
  PairStart start;
  for (const std::size_t finger : {0U, 1U}) {
    start.arc[finger] = stands[finger].arc;
    start.w[finger] = stands[finger].w + 0.5 * stands[finger].pivot;
  }
  if (!first.is_facing) return start;
  for (const std::size_t finger : {0U, 1U}) {
    const Stand& stand = stands[finger];
    if (!(stand.pivot > 0)) continue;
    // Theta = w - c s as far as the finger has pivoted by now.
    const auto tangent = [&](std::size_t k) {
      return start.w[k] - model.boundary[k]->tilt() * start.arc[k]->at(start.w[k]).s;
    };
    // At a corner w and Theta grow alike: the whole difference is pivoted, as far as the corner turns.
    const double off = std::remainder(tangent(0) - tangent(1) - first.turn, kFullTurn);
    start.w[finger] = std::clamp(start.w[finger] + (finger == 0 ? -off : off), stand.w, stand.w + stand.pivot);
  }
  return start;
}

/// The candidates by few rows: no arc where a finger can't be there.
std::vector<PairPeak> scored(const PairModel& model, const PairCandidates& candidates,
                             const std::vector<PairNode>& nodes) {
  Stands of_a(model, 0, candidates.cells, nullptr);
  Stands of_b(model, 1, candidates.cells, nullptr);
  std::vector<PairPeak> peaks(candidates.squares.size());
  for (std::size_t k = 0; k < peaks.size(); ++k) {
    PairPeak& best = peaks[k];
    for (const Stand& a : of_a.in(candidates.squares[k].i)) {
      for (const Stand& b : of_b.in(candidates.squares[k].j)) {
        const PairStart start = faced(model, {a, b}, nodes.front());
        const PairScore score = score_of(model, start, nodes, PairShared::Zero(), 1);
        // Of all stands in a square the likeliest pair is kept.
        if (best.start.arc[0] == nullptr || deviance(score) < deviance(best.score)) best = {start, score};
      }
    }
  }
  return peaks;
}

/// The places in candidates' squares that are wide beside a contact's error: from each interval between passings.
std::vector<PairPeak> scored_within(const PairModel& model, const PairCandidates& candidates,
                                    const std::vector<PairNode>& nodes) {
  Stands of_a(model, 0, candidates.cells, model.passings[0]);
  Stands of_b(model, 1, candidates.cells, model.passings[1]);
  std::vector<PairPeak> peaks;
  for (const PairSquare& square : candidates.squares) {
    for (const Stand& a : of_a.in(square.i)) {
      for (const Stand& b : of_b.in(square.j)) {
        const PairStart start = faced(model, {a, b}, nodes.front());
        peaks.push_back({start, score_of(model, start, nodes, PairShared::Zero(), 1)});
      }
    }
  }
  return peaks;
}

/// The candidates that no neighbour of theirs surpasses. `peaks`: of each candidate.
std::vector<PairPeak> best_of_neighbours(const PairModel& model, const PairCandidates& candidates,
                                         const std::vector<PairPeak>& peaks) {
  const auto key = [](std::uint32_t i, std::uint32_t j) { return (static_cast<std::uint64_t>(i) << 32) | j; };
  std::unordered_map<std::uint64_t, std::size_t> index;
  for (std::size_t k = 0; k < peaks.size(); ++k) index[key(candidates.squares[k].i, candidates.squares[k].j)] = k;
  std::vector<PairPeak> best;
  for (std::size_t k = 0; k < peaks.size(); ++k) {
    // No finger can be in the square.
    if (peaks[k].start.arc[0] == nullptr) continue;
    const PairSquare& square = candidates.squares[k];
    bool is_best = true;
    // An open part's last square is beside no first one: its number is of no square.
    const std::uint32_t n = candidates.cells;
    const auto stepped = [&](std::uint32_t at, std::uint32_t by) {
      // `by` is 0, 1 or 2: one cell back, the same, one on.
      return model.places.closed ? (at + n + by - 1) % n : at + by - 1;
    };
    for (std::uint32_t di = 0; di < 3 && is_best; ++di) {
      for (std::uint32_t dj = 0; dj < 3 && is_best; ++dj) {
        const auto beside = index.find(key(stepped(square.i, di), stepped(square.j, dj)));
        if (beside == index.end() || beside->second == k || peaks[beside->second].start.arc[0] == nullptr) continue;
        is_best = deviance(peaks[beside->second].score) >= deviance(peaks[k].score);
      }
    }
    if (is_best) best.push_back(peaks[k]);
  }
  return best;
}

/// Of peaks, the best first, no more than `most`: half of them the best, then the best of each part of the boundary,
/// the second best of each, and so on.
std::vector<PairPeak> from_everywhere(const PairModel& model, std::vector<PairPeak> peaks, std::size_t most) {
  if (peaks.size() <= most) return peaks;
  const auto part_at = [&](const PairStart& start, std::size_t finger) {
    const double s = model.places.on_first_lap(start.arc[finger]->at(start.w[finger]).s);
    return static_cast<std::uint32_t>(kParts * s / model.perimeter());
  };
  std::unordered_map<std::uint32_t, std::size_t> count;
  std::vector<std::pair<std::size_t, std::size_t>> turns;  // of each peak, when it is its part's turn
  for (std::size_t k = 0; k < peaks.size(); ++k) {
    const std::uint32_t part = kParts * part_at(peaks[k].start, 0) + part_at(peaks[k].start, 1);
    const std::size_t rank = count[part]++;
    // The first half of `most` has the first turn, whatever its part; others the turn of their rank within the part.
    turns.emplace_back(2 * k < most ? 0 : rank, k);
  }
  std::sort(turns.begin(), turns.end());
  turns.resize(most);
  std::vector<PairPeak> chosen;
  for (const auto& [rank, k] : turns) chosen.push_back(peaks[k]);
  std::sort(chosen.begin(), chosen.end(), by_deviance);
  return chosen;
}

/// Less than so many standard deviations from another one: squared.
bool is_near(const PairPeak& peak, const PairPeak& other, double squared) {
  if (other.start.arc != peak.start.arc) return false;
  const Eigen::Vector2d off(peak.start.w[0] - other.start.w[0], peak.start.w[1] - other.start.w[1]);
  // By the information, and near in w as well: where nothing is known all are near by the information.
  return off.dot(peak.score.information * off) < squared &&
         off.norm() < 1e-3 * (peak.start.arc[0]->hi() - peak.start.arc[0]->lo());
}

/// Of peaks, the best first, those that may be the answer, each once. `rows`: by which they were compared.
std::vector<PairPeak> distinct(const std::vector<PairPeak>& peaks, double rows) {
  std::vector<PairPeak> found;
  for (const PairPeak& peak : peaks) {
    // How many times larger the best one's cost is than expected.
    const double scale = std::max(1.0, peaks.front().score.cost / rows);
    if (deviance(peak.score) > deviance(peaks.front().score) + kHopeless * scale) break;
    const bool is_known =
        std::any_of(found.begin(), found.end(), [&](const PairPeak& other) { return is_near(peak, other, 1e-2); });
    if (!is_known) found.push_back(peak);
  }
  return found;
}

/// The peaks by some rows that climbs from the best of these places lead to, the best first.
std::vector<PairPeak> climbed(const PairModel& model, std::vector<PairPeak> chosen,
                              const std::vector<PairNode>& nodes) {
  std::sort(chosen.begin(), chosen.end(), by_deviance);
  const bool on_trial = model.effort != Effort::whole;
  chosen = from_everywhere(model, std::move(chosen), on_trial ? kMostStartsOnTrial : kMostStarts);
  for (PairPeak& peak : chosen) {
    peak.score = score_of(model, peak.start, nodes, PairShared::Zero(), 1);
    peak = climb(model, peak, nodes, kCoarseSteps);
  }
  std::sort(chosen.begin(), chosen.end(), by_deviance);
  return from_everywhere(model, distinct(chosen, static_cast<double>(nodes.size())),
                         on_trial ? kMostPeaksOnTrial : kMostPeaks);
}

/// Of places compared by so many rows, those that these do not rule out; the others have no arc.
void drop_hopeless(std::vector<PairPeak>& places, double rows) {
  const auto is_place = [](const PairPeak& one) { return one.start.arc[0] != nullptr; };
  const auto best = std::min_element(places.begin(), places.end(), [&](const PairPeak& one, const PairPeak& other) {
    return is_place(one) && (!is_place(other) || by_deviance(one, other));
  });
  if (best == places.end()) return;
  const double scale = std::max(1.0, best->score.cost / rows);
  const double most = deviance(best->score) + kHopeless * scale;
  for (PairPeak& each : places) {
    if (is_place(each) && deviance(each.score) > most) each.start.arc[0] = nullptr;
  }
}

/// Places that were compared by very few rows, compared by all of them; those that fewer rule out have no arc.
std::vector<PairPeak> rescored(const PairModel& model, std::vector<PairPeak> places,
                               const std::vector<PairNode>& nodes) {
  for (std::size_t rows = kVeryFewRows; rows < nodes.size();) {
    drop_hopeless(places, static_cast<double>(rows));
    rows = std::min(kRowsMore * rows, nodes.size());
    const std::vector<PairNode> some = some_of(nodes, rows);
    for (PairPeak& each : places) {
      if (each.start.arc[0] != nullptr) each.score = score_of(model, each.start, some, PairShared::Zero(), 1);
    }
  }
  return places;
}

/// Without those that have no arc.
std::vector<PairPeak> places_left(std::vector<PairPeak> places) {
  std::erase_if(places, [](const PairPeak& each) { return each.start.arc[0] == nullptr; });
  return places;
}

/// The candidates' peaks: by few of the rows and, as these leave plateaus where the instant at which a finger passes a
/// corner tells a place, by all.
std::vector<PairPeak> peaks_of(const PairModel& model, const PairCandidates& candidates,
                               const std::vector<PairNode>& nodes) {
  const std::vector<PairNode> few = some_of(nodes, kVeryFewRows);
  const std::vector<PairPeak> scores = scored(model, candidates, few);
  std::vector<PairPeak> found = climbed(model, best_of_neighbours(model, candidates, scores), some_of(nodes, kFewRows));
  if (model.effort != Effort::whole || model.passings[0] == nullptr) return found;
  const double width = model.perimeter() / static_cast<double>(candidates.cells);
  const bool is_wide = width > kWide * model.errors->contact_sd();
  if (!is_wide && nodes.size() <= kVeryFewRows) return found;
  const std::vector<PairPeak> by_all =
      climbed(model,
              is_wide ? places_left(rescored(model, scored_within(model, candidates, few), nodes))
                      : best_of_neighbours(model, candidates, rescored(model, scores, nodes)),
              nodes);
  found.insert(found.end(), by_all.begin(), by_all.end());
  return found;
}

}  // namespace

PairStart moved(const PairStart& start, const Eigen::Vector2d& by) {
  PairStart next = start;
  for (const std::size_t finger : {0U, 1U}) {
    const TiltedArc& arc = *start.arc[finger];
    double& w = next.w[finger];
    w += by[static_cast<Eigen::Index>(finger)];
    // A loop goes on around; on any other arc a finger stops at its end.
    w = arc.loop() ? arc.lo() + wrap(w - arc.lo(), arc.hi() - arc.lo()).base : std::clamp(w, arc.lo(), arc.hi());
  }
  return next;
}

std::vector<PairPeak> pair_peaks(const PairModel& model, const PairCandidates& candidates,
                                 const std::vector<PairNode>& nodes) {
  // Centres tell a place so sharply that from far away the slope does not lead to it. Normals alone leave families of
  // places on straight sides, and the best of a family may be anywhere. So the search runs without centres and with
  // them.
  std::vector<PairPeak> found = peaks_of(model, candidates, without_centres(nodes));
  const bool has_centres = nodes.back().centres.has_value();
  if (has_centres && model.path != nullptr) {
    const std::vector<PairPeak> sharp = peaks_of(model, candidates, nodes);
    found.insert(found.end(), sharp.begin(), sharp.end());
  }
  const bool on_trial = model.effort != Effort::whole;
  // Peaks by few rows, or without centres, go on by all rows.
  if (nodes.size() > kFewRows || has_centres) {
    for (PairPeak& peak : found) {
      peak.score = score_of(model, peak.start, nodes, peak.score.errors, 3);
      peak = climb(model, peak, nodes, kFineSteps);
    }
    std::sort(found.begin(), found.end(), by_deviance);
    found = distinct(found, static_cast<double>(nodes.size()));
  }
  const std::size_t searched = on_trial ? kMostSearchedOnTrial : found.size();
  for (std::size_t k = 0; k < std::min(searched, found.size()); ++k) {
    PairPeak& peak = found[k];
    const double scale = std::max(1.0, found.front().score.cost / static_cast<double>(nodes.size()));
    if (deviance(peak.score) <= deviance(found.front().score) + kWorthTrying * scale) {
      peak = search_around(model, peak, nodes);
    }
  }
  std::sort(found.begin(), found.end(), by_deviance);
  return found;
}

}  // namespace rollfix::belief
