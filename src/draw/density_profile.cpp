#include "density_profile.hpp"

#include <algorithm>
#include <cmath>

namespace rollfix::draw {
namespace {

constexpr double kTail = 4;  // standard deviations; beyond is nothing

/// Adds so much, evenly spread from lo to hi, which are in bins.
void spread(double lo, double hi, double amount, std::vector<double>& bins) {
  const auto end = static_cast<double>(bins.size());
  if (hi < 0 || lo > end) return;
  if (hi - lo < 1e-9) {
    bins[static_cast<std::size_t>(std::clamp(std::floor(lo), 0.0, end - 1))] += amount;
    return;
  }
  for (double k = std::max(0.0, std::floor(lo)); k < std::min(end, hi); ++k) {
    const double common = std::min(hi, k + 1) - std::max(lo, k);
    bins[static_cast<std::size_t>(k)] += amount * std::max(0.0, common) / (hi - lo);
  }
}

}  // namespace

std::vector<double> binned(const Density& density, const Boundary& places, const Interval& range, std::size_t count) {
  std::vector<double> bins(count, 0.0);
  const double per_length = static_cast<double>(count) / range.width();
  for (const DensityPiece& piece : density) {
    for (const double lap : {-1.0, 0.0, 1.0}) {
      if (lap != 0 && !places.closed) continue;
      const double lo = piece.s.lo + lap * places.perimeter - range.lo;
      // A point at the seam is not counted at both ends.
      if (piece.s.width() == 0 && lo >= places.perimeter) continue;
      spread(lo * per_length, (lo + piece.s.width()) * per_length, piece.probability * per_length, bins);
    }
  }
  return bins;
}

std::vector<double> highest(const Density& density, const Boundary& places, const Interval& range, std::size_t count) {
  std::vector<double> heights(count, 0.0);
  std::vector<double> points(count, 0.0);
  const double per_length = static_cast<double>(count) / range.width();
  for (const DensityPiece& piece : density) {
    for (const double lap : {-1.0, 0.0, 1.0}) {
      if (lap != 0 && !places.closed) continue;
      const double lo = piece.s.lo + lap * places.perimeter - range.lo;
      if (piece.s.width() == 0) {
        if (lo < places.perimeter) spread(lo * per_length, lo * per_length, piece.probability * per_length, points);
        continue;
      }
      const double height = piece.probability / piece.s.width();
      const double begin = std::max(0.0, std::floor(lo * per_length));
      const double end = std::min(static_cast<double>(count), std::ceil((lo + piece.s.width()) * per_length));
      for (double k = begin; k < end; ++k) {
        double& here = heights[static_cast<std::size_t>(k)];
        here = std::max(here, height);
      }
    }
  }
  for (std::size_t k = 0; k < count; ++k) heights[k] += points[k];
  return heights;
}

std::vector<double> smoothed(const std::vector<double>& bins, double sd, bool around) {
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(kTail * sd));
  const auto count = static_cast<std::ptrdiff_t>(bins.size());
  std::vector<double> weights;
  double total = 0;
  for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
    weights.push_back(std::exp(-0.5 * static_cast<double>(k * k) / (sd * sd)));
    total += weights.back();
  }
  std::vector<double> out(bins.size(), 0.0);
  for (std::ptrdiff_t at = 0; at < count; ++at) {
    if (bins[static_cast<std::size_t>(at)] <= 0) continue;
    for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
      std::ptrdiff_t to = at + k;
      if (around) to = ((to % count) + count) % count;
      if (to < 0 || to >= count) continue;
      const double weight = weights[static_cast<std::size_t>(k + reach)] / total;
      out[static_cast<std::size_t>(to)] += weight * bins[static_cast<std::size_t>(at)];
    }
  }
  return out;
}

}  // namespace rollfix::draw
