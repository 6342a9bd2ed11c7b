#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cures.hpp"
#include "paths.hpp"
#include "rollfix/program.hpp"

namespace cli {

using Json = nlohmann::json;
namespace fs = std::filesystem;

/// What a run of the program left behind.
struct Ran {
  int code = 0;
  std::string out;
  std::string err;

  Json json() const { return Json::parse(out); }
};

inline Ran run_once(const std::vector<std::string>& arguments) {
  std::ostringstream out;
  std::ostringstream err;
  const int code = rollfix::app::run(arguments, out, err);
  return {code, out.str(), err.str()};
}

/// The program, run inside this process; so is what it offers as a cure, if anything.
inline Ran run_words(const std::vector<std::string>& arguments) {
  const Ran ran = run_once(arguments);
  expect_cures_can_be_typed(arguments, ran.out, ran.err, [](const std::vector<std::string>& cured) {
    const Ran again = run_once(cured);
    return std::make_pair(again.code, again.err);
  });
  return ran;
}

/// The same with the arguments in one text, separated by blanks: run("locate gallery:cam --reading 1,0.5").
inline Ran run(const std::string& command) {
  std::istringstream words(command);
  return run_words(std::vector<std::string>(std::istream_iterator<std::string>(words), {}));
}

inline std::string read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// An empty folder, removed afterwards. It is the current one as long as it lives, so that commands look like a user's.
class Folder {
 public:
  Folder() : before_(fs::current_path()) {
    std::string name = (fs::temp_directory_path() / "rollfix-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
    fs::current_path(path_);
  }
  ~Folder() {
    fs::current_path(before_);
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  void write(const std::string& name, const std::string& text) const { std::ofstream(path_ / name) << text; }

  std::vector<std::string> files(const std::string& below = "") const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path_ / below)) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

 private:
  fs::path before_;
  fs::path path_;
};

/// A shell command line in the current folder, in which `rollfix` is the program that was built.
inline Ran shell(const std::string& command) {
  const std::string folder = fs::path(kProgram).parent_path().string();
  const fs::path err = fs::temp_directory_path() / ("rollfix-stderr-" + std::to_string(getpid()));
  const std::string line = "PATH='" + folder + "':\"$PATH\"; { " + command + "\n} 2> '" + err.string() + "'";
  std::FILE* pipe = popen(line.c_str(), "r");
  Ran ran;
  char block[4096];
  while (const std::size_t count = std::fread(block, 1, sizeof block, pipe)) ran.out.append(block, count);
  const int status = pclose(pipe);
  ran.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  ran.err = read(err);
  fs::remove(err);
  return ran;
}

/// 17 significant digits: the same double when it is read back.
inline std::string exact(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

}  // namespace cli
