#pragma once

#include <string>
#include <vector>

namespace rollfix::app {

/// A file that is to be written.
struct OutputFile {
  std::string path;
  std::string bytes;
  bool replace = true;  // false: nothing of this name is replaced, even if it came to be meanwhile
};

/// Is there such a file already, with these very bytes?
bool holds(const OutputFile& file);

/// Throws InputError when a file of this name exists and `force` is not given, or when its folder does not exist.
/// Asked before the work starts, so that nobody waits for a refusal. Devices and pipes are always fine.
void require_writable(const std::string& path, bool force);

/// Writes all of them, each beside its final name first; only then do they take their names: whole or not at all, even
/// where the disk is full, or a signal comes.
/// Throws InputError when that is not possible, when two are one file, and when one that is not to be replaced is
/// there.
void write_files(const std::vector<OutputFile>& files);

}  // namespace rollfix::app
