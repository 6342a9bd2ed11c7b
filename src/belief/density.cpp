#include <algorithm>
#include <cmath>
#include <vector>

#include "belief/one/grid.hpp"
#include "belief/posterior.hpp"

// The density along the boundary, constant on each piece.
// Notation: share, of the mass: in a cell, in a small piece of a mode (MassPiece), or in a DensityPiece.
// Idea: cells are cut into parts of about the same mass (one finger), or little pieces are counted by steps (two).
namespace rollfix::belief {
namespace {

// A piece of one finger's density changes by no more than this within it, of a logarithm.
constexpr double kRiseOfPart = 0.05;
// Of two fingers the density along one boundary is told by steps of this many standard deviations of a mode ...
constexpr double kDensityStep = 1.0 / 3;
// ... which are no more than this many.
constexpr double kMostDensitySteps = 300;

// The pieces stand for little squares on a lattice that lies askew to the boundary: counted as points they would make
// ripples with the steps. So each is spread over so many steps on both sides; of too few steps none is.
constexpr double kSpread = 2;
constexpr double kFewestSmoothed = 6;

/// What is held by steps from `lo` on, `inner` of them and those that the spread reaches.
std::vector<double> spread_out(const std::vector<MassPiece>& pieces, std::size_t finger, double lo, double step,
                               std::size_t inner) {
  std::vector<double> held(inner + 2 * static_cast<std::size_t>(kSpread), 0.0);
  // The hat's integral up to x, 0 to 1. A step's share of a piece is the difference between its ends.
  const auto below = [](double x) {  // of a hat over kSpread steps on both sides of 0
    const double at = std::clamp(x / kSpread, -1.0, 1.0);
    return at < 0 ? 0.5 * (1 + at) * (1 + at) : 1 - 0.5 * (1 - at) * (1 - at);
  };
  for (const MassPiece& piece : pieces) {
    const double at = (piece.s[finger] - lo) / step;
    const auto begin = static_cast<std::size_t>(std::max(0.0, std::floor(at - kSpread)));
    for (std::size_t k = begin; k < held.size() && static_cast<double>(k) < at + kSpread; ++k) {
      const double left = static_cast<double>(k) - at;
      held[k] += piece.share * (below(left + 1) - below(left));
    }
  }
  return held;
}

/// With its lower end on the first lap.
DensityPiece piece_on(const Boundary& places, double lo, double hi, double probability) {
  const double at = places.on_first_lap(lo);
  return {{at, at + (hi - lo)}, probability};
}

void sort_by_place(Density& density) {
  std::stable_sort(density.begin(), density.end(),
                   [](const DensityPiece& a, const DensityPiece& b) { return a.s.lo < b.s.lo; });
}

}  // namespace

/// Resolved cells, cut into parts of equal mass: as many as keep the density even within each.
Density density_of(const Grid& grid, const Boundary& places) {
  Density density;
  for (const GridCell& cell : grid.cells()) {
    if (!(cell.share > kLeastShare)) continue;
    // The density changes within a cell: parts of the same mass are even enough.
    const auto parts = static_cast<int>(std::ceil(std::max(1.0, std::abs(cell.rise) / kRiseOfPart)));
    double lo = cell.s.lo;
    for (int k = 1; k <= parts; ++k) {
      const double hi =
          k < parts ? cell.s.lo + cell.s.width() * cell.quantile(static_cast<double>(k) / parts) : cell.s.hi;
      density.push_back(piece_on(places, lo, hi, cell.share / parts));
      lo = hi;
    }
  }
  sort_by_place(density);
  return density;
}

/// Steps of equal width over the range of the pieces, with what each step holds. A range of width 0 is one step.
void add_density(const std::vector<MassPiece>& pieces, const Mode& mode, std::size_t finger, const Boundary& places,
                 Density& density) {
  if (pieces.empty()) return;
  const auto [first, last] = std::minmax_element(
      pieces.begin(), pieces.end(), [&](const MassPiece& a, const MassPiece& b) { return a.s[finger] < b.s[finger]; });
  Interval range{first->s[finger], last->s[finger]};
  const double wanted = range.width() / std::max(kDensityStep * mode.sd[finger], 1e-300);
  const double inner = range.width() > 0 ? std::clamp(std::ceil(wanted), 1.0, kMostDensitySteps) : 1;
  const double step = range.width() / inner;
  std::vector<double> held(static_cast<std::size_t>(inner), 0.0);
  if (step > 0 && inner >= kFewestSmoothed) {
    // The hats of the outermost pieces reach over both ends of the range.
    range.lo -= kSpread * step;
    held = spread_out(pieces, finger, range.lo, step, held.size());
  } else {
    for (const MassPiece& piece : pieces) {
      const double at = step > 0 ? std::floor((piece.s[finger] - range.lo) / step) : 0;
      held[static_cast<std::size_t>(std::clamp(at, 0.0, inner - 1))] += piece.share;
    }
  }
  for (std::size_t k = 0; k < held.size(); ++k) {
    const double lo = range.lo + static_cast<double>(k) * step;
    if (held[k] > 0) density.push_back(piece_on(places, lo, lo + step, held[k]));
  }
  sort_by_place(density);
}

}  // namespace rollfix::belief
