#pragma once

#include <memory>
#include <vector>

#include "rollfix/catalog/catalog.hpp"
#include "rollfix/catalog/identify.hpp"
#include "rollfix/watch/tracker.hpp"

namespace rollfix {

/// Which part of a catalog is it, row by row: what a Tracker tells has `parts`, as `identify` finds them, and no modes.
/// While more than 500 remain they are only counted. When a roll is over, the answer is that of `identify` for the same
/// rows. `fingers`, `noise` and `options` as of a Tracker, lengths in the catalog's unit, without what is said of the
/// start: a part has its own `s`. Throws InputError: an empty catalog, fingers with corners, and as Tracker does.
Tracker track(const std::shared_ptr<const Catalog>& catalog, std::vector<Finger> fingers, const Noise& noise,
              TrackOptions options = {});

}  // namespace rollfix
