#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "belief/posterior.hpp"
#include "belief/two/pair_density.hpp"
#include "belief/two/pair_rows.hpp"
#include "roll/noise.hpp"
#include "rollfix/error.hpp"

// Notation:
//   s, t            first contacts of a and b; w = (w_a, w_b): their tilted turnings, `PairStart::w`
//   row, node       what was felt at an instant, and neighbouring rows together: PairRows, PairNode
//   d^2, dof        squares of all nodes at the likeliest pair, `cost`, and what is expected of them, `freedom`
//   sigmas          as many standard deviations a contact may be off in the search
//   e, F            errors that all rows share, and the information on w at a peak: d e / d w is `errors_by_start`, so
//                   that the variance of e is `covariance` + (d e / d w) F^-1 (d e / d w)^T
// Follows docs/two_fingers.md, "The search".
// Idea: candidates (pair_candidates.cpp), the peaks that they lead to (pair_starts.cpp), a grid about each
// (pair_lattice.cpp), modes (pair_modes.cpp). Where the best peak fits badly it begins again with larger `sigmas`.
namespace rollfix::belief {

namespace {

// Where errors of kFarthest leave nothing good, larger ones are let pass, up to this many standard deviations.
constexpr double kFarthestOfAll = 40;
constexpr double kWider = 3;
// Squares of the search are as long as so many standard deviations of a contact's place.
constexpr double kSquareSigmas = 3;
constexpr double kLargestSquareShare = 1.0 / 128;

/// The peaks that some errors leave.
struct Peaks {
  std::vector<PairPeak> peaks;  // the likeliest first
  Fit fit;
  double missed = 1;  // the chance that the true one is not among them
};

/// How many nodes a taught part's outline is off for alike.
void let_part_be_off(std::vector<PairNode>& nodes, const PairErrors& errors) {
  double range = 0;
  for (const PairNode& node : nodes) {
    for (const double length : node.length) range = std::max(range, std::abs(length));
  }
  const double alike = errors.rows_alike(static_cast<double>(nodes.size()), range);
  for (PairNode& node : nodes) node.alike = alike;
}

/// The facade: rows are joined as they come, and the search runs over all of them when it is asked.
class TwoFingersPosterior : public Posterior {
 public:
  TwoFingersPosterior(const Part& part, LogKind kind, const BeliefOptions& options, const FingerGeometry& contacts)
      : part_(part),
        kind_(kind),
        options_(options),
        contacts_(contacts),
        errors_(options, kind, {contacts.finger_curvature[0], contacts.finger_curvature[1]},
                contacts.facing.has_value(), part.perimeter()),
        boundary_{boundary(0), boundary(1)},
        range_(part_.turning(), kRangeCells),
        rows_(options.robust) {
    // Only stated noise of the centres makes them evidence.
    if (options.noise.position > 0) path_.emplace(part_);
    // The others are a gyroscope's, beside one finger.
    require_kinds(options.noise,
                  {&Noise::contact, &Noise::angle, &Noise::slip, &Noise::radius, &Noise::position, &Noise::correlation},
                  "two fingers");
  }

  void add(const Sample& sample) override {
    question_.reset();
    const Reading& row = sample.reading;
    const std::optional<PairCentres> centres = centres_of(sample);
    if (rows_.empty() && !has_first_) keep_first(sample);
    const bool is_first = rows_.empty() && row.length[0] == 0 && row.length[1] == 0 && row.turn == 0;
    // The first contacts are what the others are measured from; their facing is a row of its own.
    if (is_first && kind_ == LogKind::contact) {
      if (!first_centres_) first_centres_ = centres;
      return;
    }
    rows_.add(row, centres);
  }

  std::size_t samples() const override { return rows_.size(); }
  bool has_begun() const override { return !rows_.empty() || contacts_.facing.has_value(); }

  /// By the peaks alone, without the density. They are kept for settle().
  std::optional<Fit> fit_alone() override {
    if (!question_) {
      question_ = std::make_unique<Question>(*this, errors_);
      peaks_ = peaks_of(*question_);
    }
    return peaks_.fit;
  }

  /// The density around the peaks and its modes. None where no pair fits at all.
  Outcome settle() override {
    Outcome outcome;
    outcome.fit = *fit_alone();
    const Question& question = *question_;
    const Peaks& found = peaks_;
    pieces_.clear();
    if (found.peaks.empty()) return outcome;
    PairModel model = question.model;
    const bool is_hopeless = found.fit.excess > kMostExcess;
    // Where rows fit badly the noise is widened and the density wide: it gets less effort.
    model.effort =
        is_hopeless ? Effort::hopeless : std::max(model.effort, found.fit.is_bad() ? Effort::trial : Effort::whole);
    const PairDensity density =
        pair_density(model, found.peaks, question.nodes, found.fit.widened, {corner(0), corner(1)});
    PairModes modes = modes_of(density, model, rows_.empty() ? Reading(0, 0, 0) : rows_.last());
    outcome.modes = std::move(modes.modes);
    pieces_ = std::move(modes.pieces);
    const PairScore& best = found.peaks.front().score;
    outcome.evidence = {best.log_likelihood(), std::log(density.total), -0.5 * best.log_gathered};
    // Where nothing fits no verdict depends on what was not resolved.
    outcome.unresolved = (is_hopeless ? 0 : density.rest) + found.missed;
    return outcome;
  }

  /// The widest: where one mode goes all the way round, no such roll can tell.
  double credible_length(const std::vector<PerFinger<Interval>>& intervals) const override {
    double most = 0;
    for (const PerFinger<Interval>& each : intervals) most = std::max({most, each[0].width(), each[1].width()});
    return most;
  }

  /// The largest variance of f over these readings and modes, and of the facing. An error n of a contact moves it, by
  /// kappa, and turns the felt normal, by 1/r: the sum of both bounds it whatever their signs. Radians^2.
  double variance_of_miss(const std::vector<Reading>& readings, const std::vector<Mode>& modes) const override {
    const TurningFunction& turning = part_.turning();
    double most = contacts_.facing ? errors_.facing_variance() : 0;
    for (const Mode& mode : modes) {
      for (const Reading& reading : readings) {
        double variance = errors_.turn_variance() + errors_.facing_variance() + errors_.part_variance();
        for (const std::size_t finger : {0U, 1U}) {
          const auto i = static_cast<Eigen::Index>(finger);
          const double length = reading.length[finger];
          const double kappa = turning.curvature(mode.start[finger] + length);
          const double gain = std::abs(kappa) + errors_.normal_turn(finger);
          variance += gain * gain * (errors_.contact_variance() + errors_.start()(i, i)) +
                      kappa * kappa * errors_.start()(2 + i, 2 + i) * length * length;
        }
        most = std::max(most, variance);
      }
    }
    return most;
  }

  /// First the likeliest piece with share 0, as the reference; then all of the mode.
  std::vector<MassPiece> pieces(std::size_t index, const Mode& /*mode*/) const override {
    std::vector<MassPiece> pieces = pieces_[index];
    const auto best = std::max_element(pieces.begin(), pieces.end(),
                                       [](const MassPiece& a, const MassPiece& b) { return a.share < b.share; });
    if (best == pieces.end()) return pieces;
    const MassPiece reference = *best;
    pieces.insert(pieces.begin(), reference);
    pieces.front().share = 0;
    return pieces;
  }

  /// Each finger's first contact by itself.
  PerFinger<Density> density(const std::vector<Mode>& modes) const override {
    PerFinger<Density> density{Density{}, Density{}};
    for (std::size_t k = 0; k < modes.size(); ++k) {
      for (const std::size_t finger : {0U, 1U}) {
        add_density(pieces_[k], modes[k], finger, part_.boundary(), density[finger]);
      }
    }
    return density;
  }

 private:
  /// All that hypotheses are held against, with some errors.
  struct Question {
    Question(const TwoFingersPosterior& of, const PairErrors& errors)
        : nodes(of.rows_.nodes(of.contacts_.facing, of.looked_at_centres(errors), errors)) {
      let_part_be_off(nodes, errors);
      model.errors = &errors;
      for (const PairNode& node : nodes) model.gathered += errors.gathered(node.gathered, node.travelled);
      model.boundary = {&of.boundary_[0], &of.boundary_[1]};
      model.outlier_share = of.options_.robust ? kOutlierShare : 0;
      model.prior = of.options_.prior;
      model.part = &of.part_;
      if (of.has_first_) model.pose = of.options_.pose;
      model.first = of.first_;
      model.path = of.path_ && errors.absolute() ? &*of.path_ : nullptr;
      model.places = of.part_.boundary();
      if (of.options_.by_rows) model.effort = Effort::trial;
      for (const std::size_t finger : {0U, 1U}) {
        passings[finger].emplace(model, finger, nodes);
        if (!passings[finger]->empty()) model.passings[finger] = &*passings[finger];
      }
    }
    Question(const Question&) = delete;
    Question& operator=(const Question&) = delete;

    std::vector<PairNode> nodes;  // all rows as few
    std::array<std::optional<Passings>, 2> passings;
    PairModel model;  // points to the tables above
  };

  /// The peaks of the likelihood with all rows, and how well the best one fits.
  Peaks peaks_of(const Question& question) const;
  /// How far the fingers roll from one node to the next; 0 where neighbours can't be said to be alike.
  double step_between(const std::vector<PairNode>& nodes) const;
  /// Of each equation, in one more pass at a peak.
  static Innovations innovations_at(const Question& question, const PairPeak& peak);

  /// Where the first contacts were felt in the world; nothing where a finger or its orientation is not known.
  void keep_first(const Sample& sample) {
    if (!sample.contact || contacts_.fingers.empty()) return;
    for (const std::size_t which : {0U, 1U}) {
      const Finger& finger = *finger_of(contacts_.fingers, which);
      const Contact& contact = (*sample.contact)[which];
      const Vec2 centre = sample.centre ? (*sample.centre)[which] : Vec2(0, 0);
      first_[which] = {centre - centre_of(finger, Vec2::Zero(), contact), normal_direction(finger, contact),
                       finger.curvature(contact.u)};
    }
    has_first_ = true;
  }

  /// Nothing where centres are not looked at.
  std::optional<PairCentres> centres_of(const Sample& sample) const {
    if (!path_ || !sample.centre || !sample.contact || contacts_.fingers.empty()) return std::nullopt;
    PerFinger<FeltCentre> felt(FeltCentre{}, FeltCentre{});
    PerFinger<double> normals(0, 0);
    for (const std::size_t which : {0U, 1U}) {
      const Finger& finger = *finger_of(contacts_.fingers, which);
      const Contact& contact = (*sample.contact)[which];
      felt[which] = {(*sample.centre)[which], arm_of(finger, contact.u)};
      normals[which] = normal_direction(finger, contact);
    }
    return PairCentres::of(felt, normals);
  }
  /// Of the first contacts; nothing where centres are not looked at, as not all rows have them.
  std::optional<PairCentres> looked_at_centres(const PairErrors& errors) const {
    return path_ && errors.absolute() && rows_.have_centres() ? first_centres_ : std::nullopt;
  }

  /// By w of this finger. Without a curvature lengths and turns count alike, as uncertain as they are.
  TiltedBoundary boundary(std::size_t finger) const {
    const double even = std::sqrt(0.5 * errors_.turn_variance() / errors_.contact_variance());
    return {part_, tilt_of(contacts_.finger_curvature[finger], even, part_), accuracy_of(errors_.contact_sd(), part_)};
  }

  double corner(std::size_t finger) const { return corner_length(contacts_.finger_curvature[finger], part_); }

  Part part_;
  LogKind kind_;
  BeliefOptions options_;
  FingerGeometry contacts_;
  PairErrors errors_;                         // of both fingers' logs
  std::array<TiltedBoundary, 2> boundary_;    // of each finger, by its own tilt
  TurningRange range_;                        // bounds of Theta, for the first step of the search
  std::optional<BoundaryPath> path_;          // where centres are evidence
  PairRows rows_;                             // all rows so far
  bool has_first_ = false;                    // first_ is known
  std::array<MeasuredContact, 2> first_;      // as felt at the first contacts
  std::optional<PairCentres> first_centres_;  // at the first contacts
  std::unique_ptr<const Question> question_;  // of all rows so far, with its peaks; none: they were not looked for yet
  Peaks peaks_;                               // of question_
  std::vector<std::vector<MassPiece>> pieces_;  // of each mode
};

Innovations TwoFingersPosterior::innovations_at(const Question& question, const PairPeak& peak) {
  Innovations kept;
  PairModel model = question.model;
  model.kept = &kept;
  score_of(model, peak.start, question.nodes, peak.score.errors, 1);
  return kept;
}

double TwoFingersPosterior::step_between(const std::vector<PairNode>& nodes) const {
  if (kind_ == LogKind::increments || options_.noise.correlation > 0 || nodes.empty()) return 0;
  double travelled = 0;
  for (const PairNode& node : nodes) travelled += std::max(std::abs(node.travelled[0]), std::abs(node.travelled[1]));
  return travelled / static_cast<double>(nodes.size());
}

/// The search begins with contacts off by kFarthest standard deviations. Where the best peak fits badly the noise may
/// be larger than stated: the search is repeated with as many as the fit asks for, up to kFarthestOfAll. If there is
/// still no peak, all squares are tried, unless a glance is asked for.
Peaks TwoFingersPosterior::peaks_of(const Question& question) const {
  const PairErrors& errors = *question.model.errors;
  double freedom = 0;
  // Centres make three equations of one; a node that is worth less than one row counts as that share.
  for (const PairNode& node : question.nodes) freedom += std::min(1.0, node.rows) * (node.centres ? 3 : 1);
  const auto fit = [&](const PairPeak& peak, const Trend& trend = {}) {
    const PairScore& best = peak.score;
    Fit of_best = options_.robust ? robust_fit_of(best.right_cost, best.right_rows, freedom, best.whiteness)
                                  : fit_of(best.cost, freedom, best.whiteness);
    add_trend(trend, step_between(question.nodes), of_best);
    of_best.widened *= errors.for_large_slip();
    if (options_.prior) {
      const double s = peak.start.arc[0]->at(peak.start.w[0]).s;
      of_best.prior_sigmas = std::abs(part_.boundary().offset(options_.prior->s, s)) / options_.prior->sd;
    }
    of_best.turn_gathered = std::sqrt(question.model.gathered[4]);
    of_best.length_scale = {1 / (1 + best.errors[2]), 1 / (1 + best.errors[3])};
    // With that of the places: another start asks for another scale.
    const Eigen::Matrix2d whole = Eigen::Matrix2d::Identity() / square(part_.perimeter());  // nothing is known less
    const Eigen::Matrix2d of_start = (best.information + whole).inverse();
    for (const std::size_t finger : {0U, 1U}) {
      const auto scale = static_cast<Eigen::Index>(2 + finger);
      const Eigen::RowVector2d by_start = best.errors_by_start.row(scale);
      of_best.length_scale_sd[finger] =
          of_best.widened * std::sqrt(best.covariance(scale, scale) + by_start.dot(by_start * of_start));
    }
    return of_best;
  };
  // Squares as long as contacts are uncertain. On trial only the largest.
  const double resolution =
      question.model.effort != Effort::whole
          ? kLargestSquareShare * part_.perimeter()
          : std::clamp(kSquareSigmas * errors.contact_sd(), 0.0, kLargestSquareShare * part_.perimeter());
  Peaks found;
  std::vector<PairPeak>& peaks = found.peaks;
  double sigmas = kFarthest;
  while (true) {
    const PairCandidates candidates = pair_candidates(question.model, range_, question.nodes, sigmas, resolution);
    const std::vector<PairPeak> again = pair_peaks(question.model, candidates, question.nodes);
    // A wider search need not have found the better peaks.
    if (!again.empty() &&
        (peaks.empty() || again.front().score.log_likelihood() >= peaks.front().score.log_likelihood())) {
      peaks = again;
    }
    found.missed = candidates.missed;
    if (options_.glance) break;
    // As far as contacts may be off with the noise that the best peak seems to have.
    const double needed = peaks.empty() ? kWider * sigmas : kFarthest * fit(peaks.front()).excess;
    if (needed <= 1.2 * sigmas || sigmas >= kFarthestOfAll) break;
    sigmas = std::min(kFarthestOfAll, std::max(needed, kWider * sigmas));
  }
  // Even wide errors leave no square: the peaks of all of them, to say how badly they fit.
  if (peaks.empty() && !options_.glance) peaks = pair_peaks(question.model, all_squares(), question.nodes);
  if (peaks.empty()) {
    found.fit.chi_square = found.fit.sigmas = found.fit.excess = std::numeric_limits<double>::infinity();
    return found;
  }
  found.fit = fit(peaks.front(), trend_of(innovations_at(question, peaks.front()), freedom));
  // A glance is not interested in what fits badly.
  if (options_.glance && found.fit.excess > 1) peaks.clear();
  return found;
}

}  // namespace

std::unique_ptr<Posterior> posterior_of_two(const Part& part, LogKind kind, const BeliefOptions& options,
                                            const FingerGeometry& contacts) {
  return std::make_unique<TwoFingersPosterior>(part, kind, options, contacts);
}

}  // namespace rollfix::belief
