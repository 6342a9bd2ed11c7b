#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <regex>
#include <string>
#include <utility>
#include <vector>

// What a message of the program offers to type: found, and typed.

namespace cli {

/// Options with their values, as the words of a command line.
using Cure = std::vector<std::string>;

namespace cures {

/// The words of a shell's line, as far as messages quote: 'a b' is one.
inline std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  const std::regex word("'([^']*)'|([^ ]+)");
  for (std::sregex_iterator at(line.begin(), line.end(), word), end; at != end; ++at) {
    words.push_back((*at)[1].matched ? (*at)[1].str() : (*at)[2].str());
  }
  return words;
}

/// Of a diagnosis, a line by itself: "  --finger disk,r=0.2 --noise contact=0.003; then unique: ...".
inline std::vector<Cure> of_diagnoses(const std::string& text) {
  std::vector<Cure> found;
  const std::regex line("(?:^|\n)  (--[^;\n]+)");
  for (std::sregex_iterator at(text.begin(), text.end(), line), end; at != end; ++at) {
    found.push_back(words_of((*at)[1].str()));
  }
  return found;
}

/// Of an error: what follows "as in", "say", "with" and their like, and has a value that is no placeholder, or none.
inline std::vector<Cure> of_errors(const std::string& text) {
  static const std::array<std::string, 7> kSwitches = {"--skip-bad", "--robust",      "--allow-crossing", "--outer",
                                                       "--mirror",   "--may-overlap", "--bridge"};
  std::vector<Cure> found;
  const std::regex offer(
      "(?:as in|such as|say|written|perhaps|with|which|;|, or) (--[a-z-]+)(?: ('[^']*'|[^ ;)\n]*[^ ;)\n,:.]|,))?");
  for (std::sregex_iterator at(text.begin(), text.end(), offer), end; at != end; ++at) {
    const std::string option = (*at)[1].str();
    const std::string value = (*at)[2].str();
    const bool is_switch = std::find(kSwitches.begin(), kSwitches.end(), option) != kSwitches.end();
    const bool is_value = std::regex_match(value, std::regex(",|yes|no|jaw|mm|'.*'|.*[0-9=].*"));
    if (is_switch) {
      found.push_back({option});
    } else if (is_value) {
      found.push_back(words_of(option + " " + value));
    }
  }
  return found;
}

/// The command line with the cure: what was said by the same options goes, and nothing is written.
inline std::vector<std::string> with(const std::vector<std::string>& arguments, const Cure& cure) {
  std::vector<std::string> result;
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const std::string name = arguments[k].substr(0, arguments[k].find('='));
    const bool is_replaced = name == "-o" || name == "--certify" ||
                             (name.substr(0, 2) == "--" && std::find(cure.begin(), cure.end(), name) != cure.end());
    if (!is_replaced) {
      result.push_back(arguments[k]);
    } else if (name == arguments[k] && k + 1 < arguments.size()) {
      while (k + 1 < arguments.size() && arguments[k + 1].substr(0, 2) != "--") ++k;
    }
  }
  result.insert(result.end(), cure.begin(), cure.end());
  return result;
}

/// What is read only once, or goes on for ever.
inline bool can_be_run_again(const std::vector<std::string>& arguments) {
  const auto has = [&](const char* word) {
    return std::find(arguments.begin(), arguments.end(), word) != arguments.end();
  };
  return !arguments.empty() && !has("-") && (arguments[0] != "watch" || has("--once")) && arguments[0] != "demo";
}

}  // namespace cures

/// Types each cure that the run of these arguments offered: it must be understood, and the same must not be said again.
/// `run`: its exit code and what it says on stderr.
inline void expect_cures_can_be_typed(
    const std::vector<std::string>& arguments, const std::string& out, const std::string& err,
    const std::function<std::pair<int, std::string>(const std::vector<std::string>&)>& run) {
  static bool is_typing = false;
  if (is_typing || !cures::can_be_run_again(arguments)) return;
  std::vector<Cure> all = cures::of_errors(err);
  const std::vector<Cure> more = cures::of_diagnoses(out);
  all.insert(all.end(), more.begin(), more.end());
  is_typing = true;
  for (const Cure& cure : all) {
    const auto [code, said] = run(cures::with(arguments, cure));
    const std::string typed = testing::PrintToString(cures::with(arguments, cure));
    EXPECT_FALSE(code == 2 && (said == err || said.find("rollfix: " + cure[0] + ":") == 0 ||
                               said.find("has no option") != std::string::npos))
        << "the cure of:\n"
        << err << out.substr(0, 300) << "\nis refused: " << typed << "\n"
        << said;
    EXPECT_NE(code, 4) << typed;
  }
  is_typing = false;
}

}  // namespace cli
