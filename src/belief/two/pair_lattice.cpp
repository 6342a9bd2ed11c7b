#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>

#include "belief/two/pair_density.hpp"

// Notation:
//   w               (w_a, w_b); F: information on it at a peak, `score.information`
//   gap             from the passing before a place to the next after it, length: `Passings::gap`
//   heat            log-likelihoods are divided by it where the rows fit badly
// Follows docs/two_fingers.md, "The search", step 3.
// Idea: the squares of a density are turned and scaled by F. Between passings F is 0 on flat sides, though the density
// ends at them: a gap counts as information there, and the square begins in its middle.
namespace rollfix::belief {

namespace {

// Squares are no longer than this share of the boundary.
constexpr double kLongestSquare = 1.0 / 96;
// On either side of a gap the density ends within so many standard deviations of a contact.
constexpr double kEdge = 2;
// The middle of a gap is as good as a peak if its log-likelihood is no further below.
constexpr double kAsGood = 1;

/// On w, of a density that is constant in a gap: one square is as wide as the gap with its edges.
Eigen::Matrix2d information_of_gaps(const PairModel& model, const PairStart& start) {
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  for (const std::size_t finger : {0U, 1U}) {
    if (model.passings[finger] == nullptr) continue;
    const auto i = static_cast<Eigen::Index>(finger);
    const TiltedPlace place = start.arc[finger]->at(start.w[finger]);
    const double width = model.passings[finger]->gap(place.s).width() + 2 * kEdge * model.errors->contact_sd();
    information(i, i) = square(place.slope / width);
  }
  return information;
}

}  // namespace

/// The peak itself where no gap is wide, or where the middle is worse by kAsGood or more. `nodes`: all rows.
PairPeak between_passings(const PairModel& model, const PairPeak& peak, const std::vector<PairNode>& nodes,
                          double heat) {
  PairStart start = peak.start;
  for (const std::size_t finger : {0U, 1U}) {
    if (model.passings[finger] == nullptr) continue;
    const TiltedArc& arc = *start.arc[finger];
    const TiltedPlace place = arc.at(start.w[finger]);
    const Interval gap = model.passings[finger]->gap(place.s);
    // A narrow gap has no flat middle; in a corner (slope 0) w does not move s.
    if (!(gap.width() > kWide * model.errors->contact_sd()) || !std::isfinite(gap.width()) || place.slope <= 0)
      continue;
    // The middle of the gap, to first order in w.
    const double middle = start.w[finger] + (gap.middle() - place.s) / place.slope;
    if (middle > arc.lo() && middle < arc.hi()) start.w[finger] = middle;
  }
  if (start.w == peak.start.w) return peak;
  const PairPeak found{start, score_of(model, start, nodes, peak.score.errors, kPasses)};
  return (peak.score.log_likelihood() - found.score.log_likelihood()) / heat < kAsGood ? found : peak;
}

/// Columns are the axes of F + that of the gaps, each a standard deviation long (times `factor`), or `longest`.
Eigen::Matrix2d frame_of(const PairModel& model, const PairPeak& peak, double heat, double factor) {
  const double longest = kLongestSquare * std::min(span(*peak.start.arc[0]), span(*peak.start.arc[1]));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(peak.score.information / heat +
                                                              information_of_gaps(model, peak.start));
  Eigen::Matrix2d frame;
  for (const Eigen::Index i : {0, 1}) {
    // Rounding may leave an eigenvalue below 0: nothing is known along it.
    const double precision = std::max(0.0, solver.eigenvalues()[i]);
    const double step = std::min(longest, precision > 0 ? factor / std::sqrt(precision) : longest);
    frame.col(i) = step * solver.eigenvectors().col(i);
  }
  return frame;
}

// ---- the lattice
// Notation:
//   w, y            (w_a, w_b), and the region's own coordinates: w = origin + `frame` y, so that a unit square of y is
//                   about a standard deviation wide
//   d^2, log V      `score.cost`, `score.log_volume`: -2 log L = d^2 + log V
//   g, F            slope and information of log L at a square's centre: `score.slope`, `score.information`
//   heat            `heat_`: log-likelihoods are divided by it where the rows fit badly
//   prior           ds dt, at a corner r dTheta: `log_prior`
// Follows docs/two_fingers.md, "The search", step 3.
// Idea: from a peak squares spread to wherever the density is not negligible (exp(-`kNegligiblePair`) of the best), and
// are quartered where d changes by more than `kFinePairStep`. A square's mass is summed over `kGrainsAcross`^2 points
// of the quadratic with g and F at its centre. The rate of d is taken `kPairRateSafety` times as large: a safety
// factor, not a proof.

namespace {

// Squares whose density is below this share of the best one's are not looked into: exp(-12.5), five standard
// deviations.
constexpr double kNegligiblePair = 12.5;
// A square is resolved when the distance changes by no more than this within it, in standard deviations: a quadratic
// of its own serves there.
constexpr double kFinePairStep = 1.6;
// The distance's rate of change varies within a square: it is taken as this much larger.
constexpr double kPairRateSafety = 1.3;
// A whole square is 1 wide: no side is halved below this.
constexpr double kLeastPairSize = 1.0 / 256;
// Both sides are halved where the distance changes along the better one by more than this share of the other.
constexpr double kWorthHalving = 0.5;
// By Effort. Hypotheses looked at; what is not resolved by then counts as rest.
constexpr std::array<std::size_t, 3> kMostHypotheses = {60000, 6000, 600};
// A region of more whole squares than this has them too small, and is begun again with larger ones, ...
constexpr std::array<std::size_t, 3> kManySquares = {2500, 1500, 150};
// ... by this factor, so often at most.
constexpr double kLargerSquares = 3;
constexpr int kMostBeginnings = 4;
constexpr double kOffTop = 4;
// Wide peaks come first, but not improbable ones: a peak's rank is its square's area times this power of its density.
constexpr double kShareOfDensity = 0.5;
// The middle of a square sees a passing from so many of its standard deviations.
constexpr double kPassingWidth = 2;
// Passings along a square's sides are none within it.
constexpr double kInside = 0.9;
// A square is as wide as the gap between two, or less: halved so often it says well enough how much is on either side.
constexpr double kLeastAtPassings = 1.0 / 8;
// A square's quadratic must be this near to a peak that is known in it: else the peak is sharper than the square.
constexpr double kForetold = 1;

/// The whole square of a region's grid in which y lies: squares are centred at whole numbers.
std::uint64_t square_key(const Eigen::Vector2d& y) {
  const auto i = static_cast<std::int32_t>(std::floor(y[0] + 0.5));
  const auto j = static_cast<std::int32_t>(std::floor(y[1] + 0.5));
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) << 32) | static_cast<std::uint32_t>(j);
}

/// What the region's leaves hold, in units of the likeliest peak's density.
double mass_of(const PairRegion& region) {
  double sum = 0;
  for (const PairLeaf& leaf : region.leaves) sum += leaf.share;
  return sum;
}

/// Is a point as far from a region's origin as the region goes: half a loop either way, and to the ends of an arc.
bool is_within(const PairStart& origin, const Eigen::Vector2d& by) {
  for (const std::size_t finger : {0U, 1U}) {
    const TiltedArc& arc = *origin.arc[finger];
    const double off = by[static_cast<Eigen::Index>(finger)];
    const double at = origin.w[finger] + off;
    if (arc.loop() ? !(off >= -0.5 * span(arc) && off < 0.5 * span(arc)) : !(at >= arc.lo() && at <= arc.hi())) {
      return false;
    }
  }
  return true;
}

/// Spreads regions from peaks, one after the other, until the density is covered or the effort is used up.
class Spreading {
 public:
  Spreading(const PairModel& model, const std::vector<PairNode>& nodes, double excess,
            const std::array<double, 2>& corner_length, const std::vector<PairPeak>& peaks, PairDensity& density)
      : model_(model),
        nodes_(nodes),
        heat_(excess * excess),
        corner_length_(corner_length),
        best_(peaks.front().score.log_likelihood()),
        peaks_(peaks),
        most_hypotheses_(kMostHypotheses[static_cast<std::size_t>(model.effort)]),
        many_squares_(kManySquares[static_cast<std::size_t>(model.effort)]),
        density_(density) {}

  /// Spreads a region from a peak, unless it is negligible or a region has it already.
  void from(const PairPeak& peak);
  void from(const PairStart& start);
  /// The peaks, those first that have the widest squares: these suit a ridge that leads to a sharper peak, and that
  /// one's own, which are not turned along it, do not.
  std::vector<PairPeak> widest_first() const;
  double total() const { return total_; }
  double unresolved() const { return unresolved_; }

 private:
  /// A square to look into, with a guess of the shared errors x there: linear in w about the square that it came from.
  struct Task {
    Eigen::Vector2d centre;
    Eigen::Vector2d size;  // of its sides
    PairShared guess;
    Eigen::Vector2d guess_at;              // w from the origin, of the guess
    Eigen::Matrix<double, 5, 2> by_start;  // dx/dw
  };

  /// A peak, in a region's coordinates.
  struct Known {
    Eigen::Vector2d at;
    double log_likelihood;
  };

  /// By a region that spread already.
  bool is_taken(const PairStart& start) const;
  /// From the peak's square to its neighbours, as long as they hold anything.
  bool spread(PairRegion& region, const PairPeak& peak, std::size_t most_squares);
  /// The peaks within a region's reach.
  std::vector<Known> known_in(const PairRegion& region) const;
  /// Peaks in a square that its quadratic does not foretell are sharper than it is.
  bool foretells_peaks(const PairRegion& region, const PairLeaf& leaf) const;
  bool has_passings(const PairRegion& region, const PairLeaf& leaf) const;
  bool look_into(PairRegion& region, const Task& task, std::vector<std::size_t>& leaves);
  /// Sums a leaf's mass over its grains.
  void weigh(const PairRegion& region, PairLeaf& leaf) const;
  double log_prior(const PairStart& start) const;
  bool is_negligible(const PairScore& score) const {
    return (score.log_likelihood() - best_) / heat_ < -kNegligiblePair;
  }

  const PairModel& model_;
  const std::vector<PairNode>& nodes_;
  double heat_;  // widened^2: log-likelihoods are divided by it
  std::array<double, 2> corner_length_;
  double best_;  // log-likelihood of the likeliest peak
  const std::vector<PairPeak>& peaks_;
  std::vector<Known> known_;     // in the region that spreads
  std::size_t most_hypotheses_;  // in all
  std::size_t many_squares_;     // of one region, before it begins again with larger ones
  PairDensity& density_;
  std::size_t hypotheses_ = 0;  // pairs that were scored so far
  std::size_t limit_ = 0;       // of them, with this region
  double total_ = 0;            // mass of all regions
  double unresolved_ = 0;       // mass that is not known well; infinite: it may be any
};

/// The logarithm of ds dt by (w_a, w_b): ds/dw of each finger, in a corner its r.
double Spreading::log_prior(const PairStart& start) const {
  double sum = 0;
  for (const std::size_t finger : {0U, 1U}) {
    const double slope = start.arc[finger]->at(start.w[finger]).slope;
    sum += std::log(slope > 0 ? slope : corner_length_[finger]);
  }
  return sum;
}

void Spreading::weigh(const PairRegion& region, PairLeaf& leaf) const {
  const Eigen::Vector2d step = leaf.size / kGrainsAcross;
  // Of a grain, in (w_a, w_b).
  const double area = step.prod() * std::abs(region.frame.determinant());
  const double base = (leaf.score.log_likelihood() - best_) / heat_;
  for (int i = 0; i < kGrainsAcross; ++i) {
    for (int j = 0; j < kGrainsAcross; ++j) {
      const Eigen::Vector2d off(step[0] * (i - 0.5 * (kGrainsAcross - 1)), step[1] * (j - 0.5 * (kGrainsAcross - 1)));
      const Eigen::Vector2d by = region.frame * (leaf.centre + off);
      if (!is_within(region.origin, by)) continue;
      const Eigen::Vector2d from_centre = region.frame * off;
      // log L by the quadratic of the leaf's centre: g d - d^T F d / 2.
      const double gain =
          leaf.score.slope.dot(from_centre) - 0.5 * from_centre.dot(leaf.score.information * from_centre);
      PairGrain grain;
      grain.share = area * std::exp(base + gain / heat_);
      for (const std::size_t finger : {0U, 1U}) {
        const TiltedArc& arc = *region.origin.arc[finger];
        const double w = region.origin.w[finger] + by[static_cast<Eigen::Index>(finger)];
        const TiltedPlace place = arc.at(w);
        // The prior at the grain itself.
        grain.share *= place.slope > 0 ? place.slope : corner_length_[finger];
        grain.s[finger] = place.s;
        grain.angle[finger] = w - model_.boundary[finger]->tilt() * place.s;
      }
      leaf.share += grain.share;
      leaf.grains.push_back(grain);
    }
  }
}

std::vector<Spreading::Known> Spreading::known_in(const PairRegion& region) const {
  std::vector<Known> known;
  for (const PairPeak& peak : peaks_) {
    if (is_negligible(peak.score)) continue;
    if (const auto by = region.off_origin(peak.start)) {
      known.push_back({region.back * *by, peak.score.log_likelihood()});
    }
  }
  return known;
}

bool Spreading::foretells_peaks(const PairRegion& region, const PairLeaf& leaf) const {
  return std::all_of(known_.begin(), known_.end(), [&](const Known& peak) {
    const Eigen::Vector2d off = peak.at - leaf.centre;
    // A peak outside of the square.
    if ((off.cwiseAbs() - 0.5 * leaf.size).maxCoeff() > 0) return true;
    const Eigen::Vector2d by = region.frame * off;
    const double foretold =
        leaf.score.log_likelihood() + leaf.score.slope.dot(by) - 0.5 * by.dot(leaf.score.information * by);
    return (peak.log_likelihood - foretold) / heat_ < kForetold;
  });
}

/// Are there passings within a square that is wide beside them?
bool Spreading::has_passings(const PairRegion& region, const PairLeaf& leaf) const {
  for (const std::size_t finger : {0U, 1U}) {
    if (model_.passings[finger] == nullptr) continue;
    const TiltedPlace place = leaf.start.arc[finger]->at(leaf.start.w[finger]);
    const Eigen::RowVector2d along = region.frame.row(static_cast<Eigen::Index>(finger)) * place.slope;
    // How far the square goes to either side along the boundary, to first order.
    const double reach = 0.5 * along.cwiseAbs().dot(leaf.size);
    if (reach > kPassingWidth * model_.passings[finger]->sharpest(place.s, kInside * reach)) return true;
  }
  return false;
}

/// True where the density of a square, or of some part of it, is not negligible.
bool Spreading::look_into(PairRegion& region, const Task& task, std::vector<std::size_t>& leaves) {
  const Eigen::Vector2d by = region.frame * task.centre;
  PairLeaf leaf;
  leaf.centre = task.centre;
  leaf.size = task.size;
  leaf.start = moved(region.origin, by);
  // A good guess saves passes.
  const PairShared guess = task.guess + task.by_start * (by - task.guess_at);
  leaf.score = score_of(model_, leaf.start, nodes_, guess, kPasses);
  ++hypotheses_;
  // No more than this can be in the square: the distance can't fall faster than it changes. To a corner it changes by
  // the root of h^T F h at most, h being half a diagonal.
  const Eigen::Matrix2d information = region.frame.transpose() * leaf.score.information * region.frame;
  const Eigen::Matrix2d across = leaf.size.asDiagonal() * information * leaf.size.asDiagonal();
  const double to_corner = std::sqrt(std::max(0.0, across.trace() + 2 * std::abs(across(0, 1)))) / 2;
  const double reach = kPairRateSafety * to_corner;
  const double distance = std::max(0.0, std::sqrt(leaf.score.cost) - reach);
  const double most = -0.5 * (std::min(leaf.score.cost, distance * distance) + leaf.score.log_volume);
  const bool foretells = foretells_peaks(region, leaf);
  if (foretells && (most - best_) / heat_ < -kNegligiblePair) return false;
  // At passings it may change by any amount, which the middle does not see.
  const bool has_jump =
      task.size.maxCoeff() > kLeastAtPassings && !is_negligible(leaf.score) && has_passings(region, leaf);
  // From side to side, by either of the region's coordinates.
  const Eigen::Vector2d change = across.diagonal().cwiseMax(0).cwiseSqrt();
  const bool is_even = change.maxCoeff() <= kFinePairStep * std::sqrt(heat_);
  // Halves, across where it changes most, or quarters; unless the effort or the depth is used up. Then the square is a
  // leaf as it is, and unresolved.
  std::array<bool, 2> is_cut{};
  for (const Eigen::Index i : {0, 1}) {
    const bool is_worst = !foretells || has_jump || change[i] > kWorthHalving * change.maxCoeff();
    is_cut[static_cast<std::size_t>(i)] = is_worst && task.size[i] > kLeastPairSize;
  }
  const bool is_fine = foretells && !has_jump && is_even;
  if (!is_fine && (is_cut[0] || is_cut[1]) && hypotheses_ < limit_) {
    Eigen::Vector2d size = task.size;
    for (const std::size_t i : {0U, 1U}) size[static_cast<Eigen::Index>(i)] *= is_cut[i] ? 0.5 : 1;
    const auto part_at = [&](const Eigen::Vector2d& centre) {
      return Task{centre, size, leaf.score.errors, by, leaf.score.errors_by_start};
    };
    bool matters = false;
    for (const int x : {-1, 1}) {
      if (x > 0 && !is_cut[0]) break;
      for (const int y : {-1, 1}) {
        if (y > 0 && !is_cut[1]) break;
        const Eigen::Vector2d off(is_cut[0] ? 0.5 * x * size[0] : 0, is_cut[1] ? 0.5 * y * size[1] : 0);
        matters = look_into(region, part_at(task.centre + off), leaves) || matters;
      }
    }
    if (matters || is_negligible(leaf.score)) return matters;
    // A peak so sharp that no part's middle is on it.
    return look_into(region, part_at(task.centre), leaves);
  }
  leaf.log_density = (leaf.score.log_likelihood() - best_) / heat_ + log_prior(leaf.start);
  weigh(region, leaf);
  if (!is_fine) unresolved_ += leaf.share;
  leaves.push_back(region.leaves.size());
  region.leaves.push_back(std::move(leaf));
  return true;
}

/// False where there are too many squares.
bool Spreading::spread(PairRegion& region, const PairPeak& peak, std::size_t most_squares) {
  known_ = known_in(region);
  // Breadth first: squares in the order of their distance from the peak. `seen` has every square that was considered.
  std::deque<Task> tasks;
  std::unordered_map<std::uint64_t, bool> seen;
  tasks.push_back({Eigen::Vector2d::Zero(), Eigen::Vector2d::Ones(), peak.score.errors, Eigen::Vector2d::Zero(),
                   peak.score.errors_by_start});
  seen[square_key(tasks.back().centre)] = true;
  while (!tasks.empty()) {
    const Task task = tasks.front();
    tasks.pop_front();
    // As much again as was found may be missing.
    if (hypotheses_ >= limit_) {
      unresolved_ += region.leaves.empty() ? std::numeric_limits<double>::infinity() : mass_of(region);
      return true;
    }
    std::vector<std::size_t> leaves;
    const bool matters = look_into(region, task, leaves);
    if (leaves.empty() || !matters) continue;
    // Too small squares: the caller begins again with larger ones.
    if (region.leaves_of.size() >= most_squares) return false;
    // Neighbours guess x from this square.
    const PairScore& score = region.leaves[leaves.front()].score;
    const Eigen::Vector2d at = region.frame * region.leaves[leaves.front()].centre;
    region.leaves_of[square_key(task.centre)] = std::move(leaves);
    for (const Eigen::Vector2d& side :
         {Eigen::Vector2d(1, 0), Eigen::Vector2d(-1, 0), Eigen::Vector2d(0, 1), Eigen::Vector2d(0, -1)}) {
      const Eigen::Vector2d next = task.centre + side;
      if (!seen.emplace(square_key(next), true).second) continue;
      const Eigen::Vector2d by = region.frame * next;
      if (!is_within(region.origin, by)) {
        // The squares at the edge reach over it; what is further belongs to another region, round the loop.
        if (!is_within(region.origin, region.frame * task.centre)) {
          region.beyond.push_back(moved(region.origin, region.frame * task.centre));
          continue;
        }
      }
      const PairStart start = moved(region.origin, by);
      if (!is_taken(start)) tasks.push_back({next, Eigen::Vector2d::Ones(), score.errors, at, score.errors_by_start});
    }
  }
  return true;
}

std::vector<PairPeak> Spreading::widest_first() const {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t k = 0; k < peaks_.size(); ++k) {
    // The area of a square beside the density of its peak: wide and likely ones first.
    const double log_area = std::log(std::abs(frame_of(model_, peaks_[k], heat_).determinant()));
    const double log_density = (peaks_[k].score.log_likelihood() - best_) / heat_;
    order.emplace_back(-log_area - kShareOfDensity * log_density, k);
  }
  std::sort(order.begin(), order.end());
  std::vector<PairPeak> sorted;
  for (const auto& [rank, k] : order) sorted.push_back(peaks_[k]);
  return sorted;
}

bool Spreading::is_taken(const PairStart& start) const {
  return std::any_of(density_.regions.begin(), density_.regions.end(),
                     [&](const PairRegion& region) { return region.covers(start); });
}

void Spreading::from(const PairStart& start) {
  if (!is_taken(start)) from({start, score_of(model_, start, nodes_, PairShared::Zero(), kPasses)});
}

void Spreading::from(const PairPeak& peak) {
  // One that is off its hill's top may still lead to it.
  if ((peak.score.log_likelihood() - best_) / heat_ < -kOffTop * kNegligiblePair || is_taken(peak.start)) return;
  const PairPeak middle = between_passings(model_, peak, nodes_, heat_);
  // A middle that another region has does not serve.
  const PairPeak& begin = is_taken(middle.start) ? peak : middle;
  // No region takes what others need.
  limit_ = hypotheses_ + (most_hypotheses_ - std::min(hypotheses_, most_hypotheses_)) / 2;
  double factor = 1;
  for (int beginning = 0; beginning < kMostBeginnings; ++beginning, factor *= kLargerSquares) {
    PairRegion region;
    region.origin = begin.start;
    region.frame = frame_of(model_, begin, heat_, factor);
    region.back = region.frame.inverse();
    if (!region.back.allFinite()) {  // rows far off the noise: its width can't be computed
      unresolved_ = std::numeric_limits<double>::infinity();
      return;
    }
    for (const std::size_t finger : {0U, 1U}) {
      region.origin_s[finger] = region.origin.arc[finger]->at(region.origin.w[finger]).s;
    }
    const double unresolved = unresolved_;
    const bool is_last = beginning + 1 == kMostBeginnings;
    // Too many squares: begun again, and what was not resolved is forgotten.
    if (!spread(region, begin, is_last ? most_hypotheses_ : many_squares_)) {
      unresolved_ = unresolved;
      continue;
    }
    // Nothing that counts, even at the peak.
    if (region.leaves.empty()) return;
    total_ += mass_of(region);
    density_.regions.push_back(std::move(region));
    return;
  }
}

}  // namespace

/// The leaves of a whole square lie side by side: one of them has y, unless it is negligible there.
std::size_t PairRegion::leaf_at(const Eigen::Vector2d& y) const {
  const auto found = leaves_of.find(square_key(y));
  if (found == leaves_of.end()) return leaves.size();
  for (const std::size_t k : found->second) {
    if (((leaves[k].centre - y).cwiseAbs() - 0.5 * leaves[k].size).maxCoeff() <= 0) return k;
  }
  return leaves.size();
}

/// Around a loop the shorter way. Nothing on another arc, or further than half a loop or an arc's end.
std::optional<Eigen::Vector2d> PairRegion::off_origin(const PairStart& start) const {
  if (start.arc != origin.arc) return std::nullopt;
  Eigen::Vector2d by;
  for (const std::size_t finger : {0U, 1U}) {
    const auto i = static_cast<Eigen::Index>(finger);
    by[i] = start.w[finger] - origin.w[finger];
    if (origin.arc[finger]->loop()) by[i] = std::remainder(by[i], span(*origin.arc[finger]));
  }
  if (!is_within(origin, by)) return std::nullopt;
  return by;
}

/// Whether the start is in one of the region's whole squares that hold anything.
bool PairRegion::covers(const PairStart& start) const {
  const auto by = off_origin(start);
  return by && leaves_of.count(square_key(back * *by)) > 0;
}

/// Regions from the peaks, the widest first, then those that go on beyond half a loop; at the end shares add up to 1.
PairDensity pair_density(const PairModel& model, const std::vector<PairPeak>& peaks, const std::vector<PairNode>& nodes,
                         double excess, const std::array<double, 2>& corner_length) {
  PairDensity density;
  if (peaks.empty()) return density;
  Spreading spreading(model, nodes, excess, corner_length, peaks, density);
  for (const PairPeak& peak : spreading.widest_first()) spreading.from(peak);
  // What goes on round the loop makes more regions.
  std::size_t next = 0;
  while (next < density.regions.size()) {
    const std::vector<PairStart> beyond = density.regions[next++].beyond;
    for (const PairStart& start : beyond) spreading.from(start);
  }
  const double total = spreading.total();
  // No mass about any peak, as where rows are far off the noise: nothing is known then.
  if (!(total > 0)) {
    density.regions.clear();
    density.rest = 1;
    return density;
  }
  density.total = total;
  for (PairRegion& region : density.regions) {
    for (PairLeaf& leaf : region.leaves) {
      leaf.share /= total;
      for (PairGrain& grain : leaf.grains) grain.share /= total;
    }
  }
  density.rest = std::min(1.0, spreading.unresolved() / total);
  return density;
}

}  // namespace rollfix::belief
