// Whatever is typed: an exit code that the contract knows, one line on an error and nothing printed with it. The bytes
// are the arguments, a line each, in a folder of its own with a part, a roll and a catalog.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "rollfix/program.hpp"

namespace {

namespace files = std::filesystem;
using Arguments = std::vector<std::string>;

/// `demo` and `paper` compute for seconds what nobody can change; `watch` waits.
const std::set<std::string> kCommands = {"inspect", "locate", "advise", "simulate", "teach", "identify", "catalog"};
constexpr std::size_t kMostArguments = 24;

struct Outcome {
  int code;
  std::string out;
  std::string err;
};

Outcome run(const Arguments& arguments) {
  std::ostringstream out, err;
  const int code = rollfix::app::run(arguments, out, err);
  return {code, out.str(), err.str()};
}

void require(bool condition) {
  if (!condition) std::abort();
}

/// A folder to run in: what is written there is away before the next command.
class Folder {
 public:
  Folder() {
    std::string name = (files::temp_directory_path() / "rollfix-fuzz-XXXXXX").string();
    require(::mkdtemp(name.data()) != nullptr && ::chdir(name.c_str()) == 0);
    require(::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO) == STDIN_FILENO);
    require(
        run({"simulate", "gallery:cam", "--finger", "disk,r=0.2", "--start", "0.5", "--length", "1", "-o", "roll.csv"})
            .code == 0);
    require(run({"inspect", "gallery:cam", "-o", "cam.json"}).code == 0);
    require(run({"catalog", "build", "cam.json", "-o", "parts.db"}).code == 0);
    for (const auto& entry : files::directory_iterator(".")) own_.insert(entry.path().filename());
  }

  void clean() const {
    std::vector<files::path> others;
    for (const auto& entry : files::directory_iterator(".")) {
      if (own_.count(entry.path().filename()) == 0) others.push_back(entry.path());
    }
    for (const files::path& other : others) files::remove_all(other);
  }

 private:
  std::set<files::path> own_;
};

Arguments arguments_of(const std::uint8_t* data, std::size_t size) {
  Arguments arguments;
  std::istringstream lines(std::string(reinterpret_cast<const char*>(data), size));
  for (std::string line; std::getline(lines, line) && arguments.size() < kMostArguments;) arguments.push_back(line);
  return arguments;
}

/// Nothing outside of the folder is read or written, and none of what is in it changed.
bool stays_here(const Arguments& arguments) {
  const auto leads_away = [](const std::string& argument) { return argument.find('/') != std::string::npos; };
  return !arguments.empty() && kCommands.count(arguments[0]) == 1 &&
         std::none_of(arguments.begin(), arguments.end(), leads_away) &&
         std::find(arguments.begin(), arguments.end(), "--force") == arguments.end() &&
         !(arguments[0] == "catalog" && (arguments.size() < 2 || arguments[1] != "list"));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  const Arguments arguments = arguments_of(data, size);
  if (!stays_here(arguments)) return 0;
  const Outcome outcome = run(arguments);
  require(outcome.code >= 0 && outcome.code <= 3);
  if (outcome.code == 2) require(outcome.out.empty() && !outcome.err.empty() && outcome.err.back() == '\n');
  const auto says_nan = [](const std::string& text) { return text.find("nan") != std::string::npos; };
  require(!says_nan(outcome.out) || std::any_of(arguments.begin(), arguments.end(), says_nan));
  folder.clean();
  return 0;
}
