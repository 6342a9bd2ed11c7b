#pragma once

#include "draw/identify/parts_plan.hpp"

namespace rollfix::draw {

/// One part of a figure of parts as a picture of its own, as large as its place on the page.
Svg draw_panel(const PartsPlan& plan, std::size_t panel);

}  // namespace rollfix::draw
