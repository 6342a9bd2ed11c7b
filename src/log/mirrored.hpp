#pragma once

#include "rollfix/finger.hpp"
#include "rollfix/log.hpp"

// A finger as a mirror shows it, and what it feels; a pose of the part in it.
namespace rollfix {

/// The finger with its frame's y axis the other way: a disk is what it was. An outline is stored counter-clockwise
/// again, and u of the same place is -u, of an open one its length less u. A jaw keeps its body above: of its frame the
/// x axis is the other way.
Finger mirrored(const Finger& finger);

/// u of such a finger where that of `finger` itself is u, and its orientation in the mirror's image of the world, x
/// with the other sign. `finger`: nullptr where it is not known.
double mirrored_u(const Finger& finger, double u);
double mirrored_psi(const Finger* finger, double psi);

/// What such a finger feels of that image: u and psi as above; a length and a turn get the other sign.
void mirror(FingerRows& rows, const Finger* finger);

/// A pose as that image of the world has it, the part being mirrored as well: x and the heading with the other sign,
/// and so are their covariances with y. Its own inverse.
Pose mirrored(const Pose& pose);
PoseSpread mirrored(const PoseSpread& spread);

}  // namespace rollfix
