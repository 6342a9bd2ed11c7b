// The test program: GoogleTest's own options and, for the randomised tests, --count and --seed.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include "random.hpp"

namespace {

struct RandomOptions {
  std::uint64_t seed = 20010529;
  int count = 0;      // cases in every test; 0: each test's own default ...
  double factor = 1;  // ... times this
};

RandomOptions random_options;
bool random_was_used = false;

template <class Number>
Number parse_positive(std::string_view text, std::string_view option) {
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value <= 0) {
    std::fprintf(stderr, "%.*s expects a positive %snumber, found \"%.*s\"\n", static_cast<int>(option.size()),
                 option.data(), std::is_integral_v<Number> ? "whole " : "", static_cast<int>(text.size()), text.data());
    std::exit(2);
  }
  return value;
}

/// Takes one of our own options; anything else that GoogleTest left over is an error.
void parse_option(std::string_view argument) {
  const std::string_view count = "--count=", seed = "--seed=";
  if (argument.starts_with(count)) {
    argument.remove_prefix(count.size());
    if (argument.ends_with('x')) {
      argument.remove_suffix(1);
      random_options.factor = parse_positive<double>(argument, "--count=Fx");
    } else {
      random_options.count = parse_positive<int>(argument, "--count=N");
    }
  } else if (argument.starts_with(seed)) {
    random_options.seed = parse_positive<std::uint64_t>(argument.substr(seed.size()), "--seed=N");
  } else {
    std::fprintf(stderr, "unknown option \"%.*s\"; ours are --count=N, --count=Fx, --seed=N, and see --help\n",
                 static_cast<int>(argument.size()), argument.data());
    std::exit(2);
  }
}

/// RapidCheck draws a new seed on every run unless told otherwise.
void fix_rapidcheck() {
  const std::string parameters =
      "seed=" + std::to_string(random_options.seed) + " max_success=" + std::to_string(test_count(100));
  setenv("RC_PARAMS", parameters.c_str(), /*overwrite=*/0);
}

/// After a failing randomised test: how to run it again.
class SeedPrinter : public testing::EmptyTestEventListener {
  void OnTestStart(const testing::TestInfo&) override { random_was_used = false; }

  void OnTestEnd(const testing::TestInfo& test) override {
    if (!random_was_used || !test.result()->Failed()) return;
    const std::string count =
        random_options.count > 0 ? fmt::format("{}", random_options.count) : fmt::format("{}x", random_options.factor);
    fmt::print("to repeat: rollfix_tests --gtest_filter={}.{} --seed={} --count={}\n", test.test_suite_name(),
               test.name(), random_options.seed, count);
  }
};

}  // namespace

int test_count(int default_count) {
  random_was_used = true;
  if (random_options.count > 0) return random_options.count;
  const double product = std::round(default_count * random_options.factor);
  return static_cast<int>(std::clamp<double>(product, 1, std::numeric_limits<int>::max()));
}

std::uint64_t test_seed() {
  random_was_used = true;
  return random_options.seed;
}

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  for (int i = 1; i < argc; ++i) parse_option(argv[i]);
  fix_rapidcheck();
  testing::UnitTest::GetInstance()->listeners().Append(new SeedPrinter);
  return RUN_ALL_TESTS();
}
