#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace rollfix::draw {

/// Colours that the colour-blind can tell apart as well: Okabe and Ito's without the pale ones first, then darker
/// ones from Paul Tol's muted scheme.
constexpr std::array<std::string_view, 12> kPalette = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                       "#E69F00", "#56B4E9", "#882255", "#332288",
                                                       "#999933", "#117733", "#AA4499", "#7f7f7f"};

inline std::string_view colour(std::size_t number) { return kPalette[number % kPalette.size()]; }

constexpr std::string_view kInk = "#222222";       // text and the boundary
constexpr std::string_view kSoftInk = "#666666";   // text of less weight
constexpr std::string_view kPale = "#c4c4c4";      // lines of less weight
constexpr std::string_view kBlocked = "#b2182b";   // where a finger can't go
constexpr std::string_view kMaterial = "#f3efe6";  // the part's inside

}  // namespace rollfix::draw
