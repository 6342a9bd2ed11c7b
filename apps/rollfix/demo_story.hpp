#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "rollfix/contact/finger.hpp"
#include "rollfix/files.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix::app {

/// Of a log that the demo writes.
inline constexpr std::size_t kDemoRows = 201;

/// One act of the demo, the paper's Figure 7: a disk rolls from its first contact a over to b, where several
/// placements fit, and on to c, where one is left.
struct DemoStory {
  std::string title;
  std::string argument;  // what a user types for the part
  DiskFinger finger;
  std::string start;         // as typed: s of the first contact
  double first_length = 0;   // about how far b is from there
  std::string whole_length;  // as typed: how far c is
  std::string stem;          // of the files' names, with their folder
};

/// What it writes: the log and two figures.
std::vector<std::string> file_names(const DemoStory& story);

/// What it tells and writes.
struct DemoAct {
  std::string text;
  std::vector<OutputFile> files;
};

/// Simulates, reads the log back, locates and draws: everything that it tells it has found out.
DemoAct perform(const DemoStory& story, const Part& part);

}  // namespace rollfix::app
