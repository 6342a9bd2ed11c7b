#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"

namespace march_families {

using Names = std::vector<std::string>;

/// The gallery's families that the march takes; MarchFamilies tries all. Not tried here: each test that is run by
/// itself would wait for it.
inline const Names kOfOneFinger = {"ellipse", "limacon", "cam", "gear", "spline", "log-spiral", "exponential"};
inline const Names kOfTwoFingers = {"ellipse", "superellipse", "limacon", "cam", "gear", "spline"};

/// With some more of the same families.
inline Names with_others(Names names) {
  for (const char* more :
       {"ellipse,a=3,b=1", "limacon,a=1.2,b=1", "spline,n=12,seed=5,wobble=0.3", "gear,teeth=3,depth=0.2"}) {
    names.emplace_back(more);
  }
  return names;
}

/// Those of the gallery that `march`, called with an outline, does not refuse.
template <class March>
Names taken_by(const March& march) {
  Names names;
  for (const rollfix::GalleryShape& shape : rollfix::gallery_shapes()) {
    try {
      march(rollfix::gallery(shape.name));
      names.push_back(shape.name);
    } catch (const rollfix::Error&) {
    }
  }
  return names;
}

}  // namespace march_families
