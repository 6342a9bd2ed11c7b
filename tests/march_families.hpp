#pragma once

#include <string>
#include <vector>

#include "rollfix/march/march_pairs.hpp"
#include "rollfix/outline/gallery.hpp"

namespace march_families {

/// Every closed family of the gallery that the two-finger march takes, and some more of them.
inline std::vector<std::string> smooth_closed_shapes() {
  std::vector<std::string> names;
  for (const rollfix::GalleryShape& shape : rollfix::gallery_shapes()) {
    if (!shape.closed) continue;
    try {
      const rollfix::march::PairMarch march(rollfix::gallery(shape.name));
      names.push_back(shape.name);
    } catch (const rollfix::march::Refusal&) {  // lines, arcs, corners: what the paper excludes
    }
  }
  for (const char* more :
       {"ellipse,a=3,b=1", "limacon,a=1.2,b=1", "spline,n=12,seed=5,wobble=0.3", "gear,teeth=3,depth=0.2"}) {
    names.emplace_back(more);
  }
  return names;
}

}  // namespace march_families
