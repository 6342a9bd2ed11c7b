#pragma once

#include <array>

/// Shapes of the gallery, each with a finger that gets everywhere.
struct Family {
  const char* shape;
  double radius_share;  // of the perimeter: the finger's
};
inline constexpr std::array<Family, 9> kFamilies = {{{"ellipse,a=2,b=1", 0.03},
                                                     {"cam", 0.03},
                                                     {"spline,n=9,seed=7,wobble=0.2", 0.03},
                                                     {"limacon", 0.03},
                                                     {"gear", 0.002},
                                                     {"stadium", 0.03},
                                                     {"reuleaux", 0.03},
                                                     {"superellipse", 0.03},
                                                     {"naca", 0.03}}};
