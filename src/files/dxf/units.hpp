#pragma once

#include "files/dxf/model.hpp"
#include "rollfix/outline/loops.hpp"

namespace rollfix::dxf {

/// Sets the drawing's unit from $INSUNITS, or where that says nothing from $MEASUREMENT, and notes the latter.
void set_unit(const Model& model, Drawing& drawing);

}  // namespace rollfix::dxf
