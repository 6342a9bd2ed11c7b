#include "steps.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "belief/posterior.hpp"
#include "held_rows.hpp"
#include "hold_fit.hpp"
#include "locate/remaining.hpp"

// Notation:
//   set             boxes of first contacts that hang together; optimum: where a fit from within ends
//   few, fit        least squares with the rows that were searched with, and with all rows
// Follows docs/two_fingers.md, "Three and more fingers".
namespace rollfix::hold {
namespace {

constexpr std::size_t kLooks = 1200;        // at places of all sets, to choose from where to start
constexpr std::size_t kAllStarts = 64;      // as many of them at least, the best ones: of 16 a true place got lost, ...
constexpr double kCloseStarts = 0.04;       // ... and no two of a set that are closer than this share of it
constexpr std::size_t kGlanceLooks = 96;    // the same at a glance, ...
constexpr std::size_t kGlanceStarts = 2;    // ... of each set from where to start, ...
constexpr std::size_t kGlanceOptima = 4;    // ... and the best of all that are looked at by all rows
constexpr int kNudges = 4;                  // to both sides, of a contact's error each, ...
constexpr double kFitsNowhere = 1e-6;       // ... where all rows are less probable
constexpr std::size_t kMostToCorners = 24;  // so many optima are looked at, the best ones, ...
constexpr int kCornerRounds = 8;            // ... moving a finger to where one of its rows is at a corner, ...
constexpr double kCornerSteps = 2;          // ... no more than so many steps from row to row away
constexpr double kHopeless = 60;   // an optimum that costs so much more than the best is about exp(-30) as likely
constexpr double kWideHold = 0.1;  // of the perimeter: a place that is known no better is a continuum

/// One run: optima of all sets, the posterior's modes about them, and placements of the probable ones.
class HoldWeighing {
 public:
  HoldWeighing(const HoldProblem& problem, const HeldRows& rows, const HeldRows& searched, HoldBoxSearch& search,
               const WheelPaths& wheels, Care care, HoldAnswer& answer)
      : problem_(problem),
        at_a_glance_(care == Care::glance),
        boundary_(problem.part.boundary()),
        rows_(rows),
        searched_(searched),
        search_(search),
        wheels_(wheels),
        answer_(answer) {}

  /// Fills the answer's placements, fit, evidence and what was not listed. `found`: sets, of which placements have
  /// the extents.
  void run(const std::vector<FoundSet>& found) {
    const HeldRows all = averaged(rows_);
    // Fits by the rows searched with are quick; those by all rows, averaged, decide.
    const HoldFit few(problem_.part, searched_, wheels_);
    const HoldFit fit(problem_.part, all, wheels_);
    std::vector<HeldSet> known;
    for (const FoundSet& one : found) known.push_back(one.set);
    const std::vector<Optimum> optima = best_of(found, few, fit);
    if (at_a_glance_) {
      if (!optima.empty()) add_at_a_glance(fit, optima.front(), known);
      return;
    }
    std::vector<HoldMode> modes = modes_about(fit, problem_.part, optima, known);
    // A set may have several modes, or none: it is improbable unless one of them is listed, or can't be for an overlap.
    std::vector<bool> is_told(found.size());
    answer_.improbable = found.size();
    const auto tell = [&](std::size_t set) {
      if (!is_told[set]) --answer_.improbable;
      is_told[set] = true;
    };
    drop_overlaps(modes, all, tell);
    modes = by_poses(fit, modes);
    if (modes.empty()) return;
    // Weights over their sum, the largest taken out against underflow.
    double most = modes.front().log_weight;
    for (const HoldMode& mode : modes) most = std::max(most, mode.log_weight);
    double sum = 0;
    for (const HoldMode& mode : modes) sum += std::exp(mode.log_weight - most);
    answer_.log_evidence = most + std::log(sum);
    for (const HoldMode& mode : modes) {
      const double probability = std::exp(mode.log_weight - most) / sum;
      if (probability < kLeastListed) {
        answer_.rest += probability;
        continue;
      }
      tell(mode.set);
      HoldPlacement placement = posterior_of(mode, mode.best, fit, known[mode.set]);
      // On a ridge that is flat the best place is anywhere.
      if (!are_within(placement)) placement = posterior_of(mode, middle_of(mode, placement), fit, known[mode.set]);
      placement.probability = probability;
      TouchFit one = fit_of(fit, mode.best);
      // The placement that fits best speaks for all: one that fits is no contradiction.
      one.p = std::min(one.p, fit.p_of_oddest(mode.best));
      if (!answer_.fit || one.p > answer_.fit->p) answer_.fit = one;
      answer_.placements.push_back(std::move(placement));
    }
    std::stable_sort(answer_.placements.begin(), answer_.placements.end(),
                     [](const HoldPlacement& a, const HoldPlacement& b) { return a.probability > b.probability; });
    const HeldState& best = std::max_element(modes.begin(), modes.end(), [](const HoldMode& a, const HoldMode& b) {
                              return a.log_weight < b.log_weight;
                            })->best;
    if (problem_.robust) answer_.strays = static_cast<std::size_t>(std::lround(best.strays));
    answer_.prior_p = prior_p(best);
  }

 private:
  /// The place that fits best, and how well.
  void add_at_a_glance(const HoldFit& fit, const Optimum& best, const std::vector<HeldSet>& sets) {
    answer_.placements.push_back(described(fit, problem_.part, best.state, sets[best.set]));
    answer_.fit = fit_of(fit, best.state);
    // Without volumes: at a glance fits are compared by their squares.
    answer_.log_evidence = -0.5 * best.state.square;
    if (!fit.has_stretches() && fit.wheels() == 0) return;
    // Only the scales of lengths get a standard deviation, for hold_mistakes.cpp.
    UnknownsMatrix information = fit.reduced(best.state).matrix;
    information.diagonal().array() +=
        1 / (boundary_.perimeter * boundary_.perimeter);  // keeps it invertible where a place is not determined
    const UnknownsMatrix covariance = information.inverse();
    for (std::size_t k = 0; k < fit.fingers() + fit.wheels(); ++k) {
      HoldContact& contact = answer_.placements.back().contacts[k];
      if (const auto i = fit.scale_unknown(k)) {
        std::tie(contact.length_scale, contact.length_scale_sd) =
            fit.scale_of_lengths(k, best.state.unknowns(*i), std::sqrt(covariance(*i, *i)));
      }
    }
  }

  /// Drops nodes at which fingers must enter each other, and modes without any other node, which are counted.
  template <class Tell>
  void drop_overlaps(std::vector<HoldMode>& modes, const HeldRows& rows, const Tell& tell) {
    const FingersApart apart(problem_, rows);
    const auto is_possible = [&](const HoldNode& node) {
      std::vector<Interval> arcs;
      for (std::size_t k = 0; k < rows.fingers(); ++k) {
        const auto i = static_cast<Eigen::Index>(k);
        // Only what overlaps all over the node's range is impossible.
        const double off = kPossibleSigmas * std::sqrt(node.covariance(i, i));
        arcs.push_back({node.state.unknowns(i) - off, node.state.unknowns(i) + off});
      }
      return !apart.must_overlap(arcs);
    };
    answer_.overlap += std::erase_if(modes, [&](HoldMode& mode) {
      const bool is_dropped = !keep_nodes(mode, is_possible);
      if (is_dropped) tell(mode.set);
      return is_dropped;
    });
  }

  /// Each mode once for each way the part may lie at the ends.
  static std::vector<HoldMode> by_poses(const HoldFit& fit, const std::vector<HoldMode>& modes) {
    std::vector<HoldMode> result;
    for (const HoldMode& mode : modes) {
      for (HoldMode& one : split_by_poses(fit, mode)) result.push_back(std::move(one));
    }
    return result;
  }

  /// Probability that a placement is as far from what was known of the first contact and of the pose; 1 without such.
  double prior_p(const HeldState& state) const {
    const bool has_place = rows_.any_place && problem_.pose && std::isfinite(problem_.pose->place_sd);
    // As many numbers were known beforehand: their squares together are a chi-square.
    const int numbers = (problem_.prior ? 1 : 0) + (problem_.pose ? 1 : 0) + (has_place ? 2 : 0);
    return numbers == 0 ? 1 : belief::p_of_chi_square(state.prior_square, numbers);
  }

  HoldPlacement posterior_of(const HoldMode& mode, const HeldState& shown, const HoldFit& fit,
                             const HeldSet& set) const {
    HoldPlacement placement = described(fit, problem_.part, shown, set);
    add_posterior(placement, fit, problem_.part, mode);
    for (const HoldContact& contact : placement.contacts) {
      // A 95 % interval longer than a tenth of the perimeter is no place.
      placement.continuum = placement.continuum || contact.interval.width() > kWideHold * boundary_.perimeter;
    }
    return placement;
  }

  /// Each first contact in its own interval.
  bool are_within(const HoldPlacement& placement) const {
    return std::all_of(placement.contacts.begin(), placement.contacts.end(),
                       [&](const HoldContact& contact) { return boundary_.contains(contact.interval, contact.start); });
  }

  /// The node that is nearest to all means.
  const HeldState& middle_of(const HoldMode& mode, const HoldPlacement& placement) const {
    const auto off = [&](const HoldNode& node) {
      // In standard deviations of each first contact.
      double square = 0;
      for (std::size_t k = 0; k < problem_.logs.size(); ++k) {
        const HoldContact& contact = placement.contacts[k];
        const double away = boundary_.offset(contact.mean, node.state.unknowns(static_cast<Eigen::Index>(k)));
        square += std::pow(away / std::max(contact.sd, 1e-12 * boundary_.perimeter), 2);
      }
      return square;
    };
    return std::min_element(mode.nodes.begin(), mode.nodes.end(),
                            [&](const HoldNode& a, const HoldNode& b) { return off(a) < off(b); })
        ->state;
  }

  /// The best first contacts near some places of each set, by all rows. Few rows come first: all of them fit no better.
  std::vector<Optimum> best_of(const std::vector<FoundSet>& found, const HoldFit& few, const HoldFit& fit) {
    std::vector<Optimum> rough;
    for (std::size_t k = 0; k < found.size(); ++k) {
      for (const HeldState& start : starts_in(found[k], found.size(), few)) {
        rough.push_back({few.fit(few.wheels() > 0 ? few.afresh(start.unknowns) : start), k});
      }
    }
    // The most promising first, so that the first one that costs too much ends the loop below.
    std::stable_sort(rough.begin(), rough.end(),
                     [](const Optimum& a, const Optimum& b) { return a.state.cost < b.state.cost; });
    if (at_a_glance_ && rough.size() > kGlanceOptima) rough.resize(kGlanceOptima);
    std::vector<Optimum> optima;
    std::vector<const Optimum*> tried;
    std::size_t to_corners = 0;  // so many were tried with a row at a corner
    double least = std::numeric_limits<double>::infinity();
    for (const Optimum& one : rough) {
      // The costs are by few rows, and by all rows they are larger, but for averages of rows. Neither this optimum nor
      // those behind it come near the best.
      if (one.state.cost > least + kHopeless) break;
      // The same place, before or after the fit by all rows, is fitted once.
      const auto is_known = [&](const Optimum& other) {
        return other.set == one.set && are_alike(other.state, one.state, fit);
      };
      if (std::ranges::any_of(tried, is_known, [](const Optimum* other) -> const Optimum& { return *other; })) continue;
      if (std::ranges::any_of(optima, is_known)) continue;
      tried.push_back(&one);
      HeldState state = fit.fit(fit.afresh(one.state.unknowns));
      // Nudges are only for a set in which no place fits yet.
      const bool is_found = std::ranges::any_of(
          optima, [&](const Optimum& other) { return other.set == one.set && fits(fit, other.state); });
      if (fit.wheels() > 0 && !is_found && fits(few, one.state) && !fits(fit, state)) {
        // Few rows fit here, and all rows don't.
        state = nudged(fit, one.state.unknowns, state);
      }
      const bool has_corners = fit.wheels() == 0 && !problem_.part.corners().empty();
      if (has_corners && to_corners < kMostToCorners && !fits(fit, state)) {
        state = at_corners(fit, std::move(state));
        ++to_corners;
      }
      const std::size_t set = set_with(found, state, one.set);
      // The fit has left all sets: its place was excluded by the search.
      if (set == found.size()) continue;
      least = std::min(least, state.cost);
      optima.push_back({std::move(state), set});
    }
    const double hopeless = at_a_glance_ ? 0 : kHopeless;
    std::erase_if(optima, [&](const Optimum& one) { return one.state.cost > least + hopeless; });
    return optima;
  }

  static bool fits(const HoldFit& fit, const HeldState& state) { return fit_of(fit, state).p > kFitsNowhere; }

  /// Where few rows fit and all of them don't, some may have turned to a wrong side of a corner: from about there
  /// again.
  static HeldState nudged(const HoldFit& fit, const Unknowns& unknowns, const HeldState& state) {
    std::vector<HeldState> starts;
    for (int k = -kNudges; k <= kNudges; ++k) {
      Unknowns about = unknowns;
      // Unknown 0: the only finger's first contact.
      about(0) += k * fit.rows().errors[0].travel;
      starts.push_back(fit.afresh(about));
    }
    HeldState other = fit.fit(*std::ranges::min_element(starts, {}, &HeldState::cost));
    return other.cost < state.cost ? other : state;
  }

  /// On a straight side nothing draws a row to the corner beside it that it pivots at, or was past already. So in turn
  /// each finger is moved to where such a row would be at the corner, as long as that fits better.
  HeldState at_corners(const HoldFit& fit, HeldState state) const {
    for (int round = 0; round < kCornerRounds; ++round) {
      HeldState best = state;
      for (std::size_t finger = 0; finger < fit.fingers(); ++finger) {
        const auto k = static_cast<Eigen::Index>(finger);
        for (const double by : ways_to_corners(fit, state, finger)) {
          Unknowns moved = state.unknowns;
          moved(k) += by;
          HeldState other = fit.at(moved, state);
          if (other.cost < best.cost) best = std::move(other);
        }
      }
      best = fit.fit(std::move(best));
      if (best.cost >= state.cost - 1) break;
      state = std::move(best);
    }
    return state;
  }

  /// How far it is from each of a finger's rows to the corners that are no farther than the longest step from row to
  /// row.
  std::vector<double> ways_to_corners(const HoldFit& fit, const HeldState& state, std::size_t finger) const {
    const std::size_t rows = fit.rows().rows.size();
    double step = 0;
    for (std::size_t row = 1; row < rows; ++row) {
      step = std::max(step, std::abs(fit.place_of(state, row, finger) - fit.place_of(state, row - 1, finger)));
    }
    std::vector<double> ways;
    for (std::size_t row = 0; row < rows; ++row) {
      for (const Corner& corner : problem_.part.corners()) {
        const double way = boundary_.offset(boundary_.canonical(fit.place_of(state, row, finger)), corner.s);
        if (std::abs(way) <= kCornerSteps * step) ways.push_back(way);
      }
    }
    // Rows of one pivot are at one place but for their errors.
    std::ranges::sort(ways);
    const auto is_same = [&](double one, double other) { return other - one < fit.rows().errors[finger].travel; };
    ways.erase(std::unique(ways.begin(), ways.end(), is_same), ways.end());
    return ways;
  }

  /// Of many places all over a set those that fit best as they are, no two of them close together, and some that are
  /// spread evenly.
  std::vector<HeldState> starts_in(const FoundSet& found, std::size_t sets, const HoldFit& few) {
    // Looks and starts are shared out over the sets. With full care each set gets kStarts of both at least, as far as
    // it has boxes.
    const std::size_t looks = std::min(found.boxes.size(), at_a_glance_ ? std::max<std::size_t>(1, kGlanceLooks / sets)
                                                                        : std::max(kStarts, kLooks / sets));
    const std::size_t most = at_a_glance_ ? kGlanceStarts : std::max(kStarts, kAllStarts / sets);
    const std::size_t stride = std::max<std::size_t>(1, looks / kStarts);
    std::vector<HeldState> states;
    std::vector<HeldState> starts;
    for (std::size_t look = 0; look < looks; ++look) {
      states.push_back(few.at(middle_of_box(search_, found, look, looks)));
      // Evenly spread ones, whatever they cost.
      if (look % stride == 0 && !at_a_glance_) starts.push_back(states.back());
    }
    std::ranges::stable_sort(states, {}, &HeldState::cost);
    std::vector<HeldState> best;
    for (HeldState& state : states) {
      if (best.size() == most) break;
      const bool is_new =
          std::ranges::none_of(best, [&](const HeldState& better) { return are_close(better, state, found.set); });
      if (is_new) best.push_back(std::move(state));
    }
    starts.insert(starts.end(), best.begin(), best.end());
    return starts;
  }

  /// Two states that differ by a small share of the set's width in every first contact.
  bool are_close(const HeldState& one, const HeldState& other, const HeldSet& set) const {
    for (std::size_t k = 0; k < set.extent.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const double off = std::abs(boundary_.offset(one.unknowns(i), other.unknowns(i)));
      if (off > kCloseStarts * set.extent[k].width()) return false;
    }
    return true;
  }

  /// Two states that differ by less than contacts are measured to: one optimum.
  bool are_alike(const HeldState& one, const HeldState& other, const HoldFit& fit) const {
    for (std::size_t k = 0; k < fit.fingers(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const double off = std::abs(boundary_.offset(one.unknowns(i), other.unknowns(i)));
      if (off > 0.1 * fit.rows().errors[k].travel + 1e-9 * boundary_.perimeter) return false;
    }
    return true;
  }

  /// The number of a set that holds a state, `first` if it does; found.size() if none does.
  std::size_t set_with(const std::vector<FoundSet>& found, const HeldState& state, std::size_t first) const {
    double slack = 0;
    for (const HeldErrors& errors : rows_.errors) slack = std::max(slack, errors.travel);
    if (is_within(found[first].set, state, boundary_, slack)) return first;
    for (std::size_t k = 0; k < found.size(); ++k) {
      if (is_within(found[k].set, state, boundary_, slack)) return k;
    }
    return found.size();
  }

  const HoldProblem& problem_;
  bool at_a_glance_;
  Boundary boundary_;
  const HeldRows& rows_;
  const HeldRows& searched_;
  HoldBoxSearch& search_;
  const WheelPaths& wheels_;
  HoldAnswer& answer_;
};

}  // namespace

std::vector<double> middle_of_box(HoldBoxSearch& search, const FoundSet& found, std::size_t look, std::size_t looks) {
  // In the middle of its share of the boxes.
  const Box& box = found.boxes[(2 * look + 1) * found.boxes.size() / (2 * looks)];
  std::vector<double> start;
  for (std::size_t k = 0; k < search.fingers(); ++k) start.push_back(search.tree(k).arc(box[k]).middle());
  return start;
}

void weigh(const HoldProblem& problem, const HeldRows& rows, const HeldRows& searched,
           const std::vector<FoundSet>& found, HoldBoxSearch& search, const WheelPaths& wheels, Care care,
           HoldAnswer& answer) {
  HoldWeighing(problem, rows, searched, search, wheels, care, answer).run(found);
}

}  // namespace rollfix::hold
