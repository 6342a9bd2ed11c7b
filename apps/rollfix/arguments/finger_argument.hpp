#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>
#include <vector>

#include "rollfix/finger.hpp"

namespace rollfix::app {

/// Adds --finger to a command. It can be typed twice: two fingers.
void add_finger_argument(CLI::App& command, std::vector<std::string>& fingers);

/// The fingers as typed, none or up to `most`: disk,r=R, jaw, or an outline. Where two are meant and one is given, both
/// are alike. `unit`: the part's, empty where it is not known; a finger's drawing in another is converted to it. Throws
/// InputError: no such finger, or too many.
std::vector<Finger> read_fingers(const std::vector<std::string>& fingers, std::size_t most, const std::string& unit);

/// Whether this means a wheel without skin: "wheel,r=0.4".
bool names_wheel(const std::string& text);

/// Its radius. Throws InputError: not of this form, not above 0.
double read_wheel(const std::string& text, const std::string& unit);

/// Whether a finger is the outline of a file or of the gallery: "pad.csv", "gallery:stadium", and not "disc,r=0.1".
bool names_outline(const std::string& text);

/// Throws InputError where one is no disk; `what` says for what it must be.
void require_disks(const std::vector<Finger>& fingers, const std::string& what);

/// Places on fingers, --contact-angle `of_disks` or --contact of others. What is typed once is of every finger that can
/// have it, what is typed twice of one each. Throws InputError where there are too few of those.
void require_owners(const std::vector<std::string>& typed, const std::vector<Finger>& fingers, bool of_disks);

/// That it is not known where such a finger can touch a part.
std::string no_reach_note(const Finger& finger);

/// Of --friction: a coefficient for each of so many fingers, typed once for all or once for each.
std::vector<double> read_coefficients(const std::string& text, std::size_t fingers);

}  // namespace rollfix::app
