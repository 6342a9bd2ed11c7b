#pragma once

#include <string>
#include <vector>

namespace bench {

/// A folder that is there for as long as this is.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::string path(const std::string& name) const { return folder_ + "/" + name; }

 private:
  std::string folder_;
};

/// Runs a program to its end, as a user does, what it prints into a file; the seconds of processor time that it took,
/// from its start on. Throws InternalError where its exit code is not 0.
double seconds_of_child(const std::vector<std::string>& command, const std::string& output = "/dev/null");

}  // namespace bench
