// DXF: whatever bytes a file has, there is a drawing or an InputError in one line, and nothing else.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "cli.hpp"
#include "dxf_text.hpp"
#include "paths.hpp"
#include "random.hpp"

namespace dxf_mutation_test {
namespace {

using rollfix::InputError;
using rollfix::files::parse_dxf;

/// Small valid files of all kinds, ASCII and binary: what the fuzzer starts from.
std::vector<std::string> valid_files() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(checked_out("fuzz/corpus/dxf"))) {
    files.push_back(cli::read(entry.path()));
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Flips, inserts, removes, repeats or cuts off some bytes.
std::string mutated(std::string bytes, std::mt19937_64& generator) {
  const auto below = [&](std::size_t end) { return std::uniform_int_distribution<std::size_t>(0, end - 1)(generator); };
  for (std::size_t left = 1 + below(4); left > 0 && !bytes.empty(); --left) {
    const std::size_t at = below(bytes.size());
    switch (below(6)) {
      case 0:
        bytes[at] = static_cast<char>(below(256));
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 2:
        bytes.insert(at, 1, "0123456789.-e\n "[below(15)]);
        break;
      case 3:
        bytes.erase(at, 1 + below(40));
        break;
      case 4:
        bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(200)));
        break;
      default:
        bytes.resize(at);
        break;
    }
  }
  return bytes;
}

TEST(DxfMutation, valid_files_are_valid) {
  const std::vector<std::string> files = valid_files();
  EXPECT_GE(files.size(), 10U);
  for (const std::string& file : files) EXPECT_GE(parse_dxf(file, "part.dxf").curves.size(), 1U);
}

TEST(DxfMutation, any_bytes_give_a_drawing_or_one_line_of_error) {
  const std::vector<std::string> files = valid_files();
  auto generator = test_generator();
  int refused = 0;
  const int count = test_count(5000);
  for (int k = 0; k < count; ++k) {
    const std::string bytes = mutated(files[static_cast<std::size_t>(k) % files.size()], generator);
    try {
      const rollfix::Drawing drawing = parse_dxf(bytes, "part.dxf");
      for (const rollfix::DrawnCurve& drawn : drawing.curves) EXPECT_TRUE(drawn.curve.front().allFinite());
    } catch (const InputError& error) {
      ++refused;
      const std::string message = error.what();
      EXPECT_EQ(message.find_first_of("\n\r\t"), std::string::npos) << message;
      EXPECT_EQ(message.substr(0, 8), "part.dxf") << message;
      EXPECT_LE(message.size(), 400U) << message;
    }
  }
  EXPECT_GT(refused, count / 10);
  EXPECT_LT(refused, count);
}

}  // namespace
}  // namespace dxf_mutation_test
