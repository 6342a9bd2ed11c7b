#pragma once

#include <string>
#include <vector>

#include "rollfix/contact/finger.hpp"
#include "rollfix/demo_story.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix::app {

/// An act of the demo with two fingers on a part that is free to move, the paper's Figure 8: two readings leave several
/// pairs of first contacts, a third one leaves one. Then the same fingers' log, which says more than such readings.
/// Everything that a user would type is a text.
struct DemoPairStory {
  std::string title;
  std::string argument;  // for the part
  DiskFinger finger;     // both
  std::vector<std::string> readings;
  std::vector<std::string> starts;   // s and t of the first contacts
  std::vector<std::string> lengths;  // to the last contacts
  std::string part_rotation;         // meanwhile
  std::string stem;                  // of the files' names, with their folder
};

/// What it writes: two figures, in two formats each, and the log.
std::vector<std::string> file_names(const DemoPairStory& story);

/// Locates by the readings, simulates, locates by the log, and draws: everything that it tells it has found out.
DemoAct perform(const DemoPairStory& story, const Part& part);

}  // namespace rollfix::app
