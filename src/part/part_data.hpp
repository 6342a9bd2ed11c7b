#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "rollfix/part/part.hpp"
#include "turning_builder.hpp"

namespace rollfix {

/// All that a part holds, once it is computed.
struct Part::Data {
  Outline outline;
  TurningFunction turning;
  Parametrization parametrization;
  std::vector<Corner> corners;
  std::vector<double> inflections;
  std::vector<double> vertices;
};

/// For saving a part and making it again.
struct PartAccess {
  using Data = Part::Data;

  static const Data& data(const Part& part) { return *part.data_; }
  static Part part(Data data) { return Part(std::make_shared<const Data>(std::move(data))); }
};

}  // namespace rollfix
