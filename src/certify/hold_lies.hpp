#pragma once

#include "hold/hold_fit.hpp"
#include "rollfix/certify.hpp"

namespace rollfix {

/// First contacts that fit, and how the part lies at each instant, with its residuals. Nothing where they do not quite
/// fit once they are written down.
std::optional<CertifiedHoldSet> lies_of(const Part& part, const hold::HoldFit& fit, const hold::WheelPaths& paths,
                                        const hold::HeldState& state);

}  // namespace rollfix
