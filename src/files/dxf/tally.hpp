#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace rollfix::dxf {

/// What a drawing lost on the way, counted for the user to read.
struct Tally {
  std::map<std::string, std::size_t> others;  // by the kind of entity
  std::size_t hidden = 0;                     // on layers that are off or frozen
  std::size_t invisible = 0;
  std::size_t paper = 0;
  std::size_t other_layers = 0;
  std::size_t without_length = 0;
  std::size_t wide = 0;        // polylines with widths
  std::size_t spline_fit = 0;  // polylines that stand for a spline
  std::size_t fit_points = 0;  // splines without control points
  std::size_t repeated = 0;    // points of theirs that repeat the one before
};

/// One line each. `layer` is the one that was asked for.
std::vector<std::string> notes_of(const Tally& tally, const std::string& layer);

}  // namespace rollfix::dxf
