// rollfix-verify CERTIFICATE: proves again what a certificate of `rollfix locate --certify` claims, with none of the
// search's code.
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>

#include "check.hpp"

namespace {

enum ExitCode { proved = 0, refused = 1, bad_input = 2, incomplete = 3 };

std::string read(const std::string& path) {
  if (path == "-") return {std::istreambuf_iterator<char>(std::cin), {}};
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("can't be read");
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

int main(int count, char** arguments) {
  const std::string argument = count == 2 ? arguments[1] : "--help";
  if (argument == "--help" || argument == "-h") {
    (count == 2 ? std::cout : std::cerr)
        << "Usage: rollfix-verify CERTIFICATE\n"
           "Proves again what a certificate of `rollfix locate --certify` claims; -: from stdin.\n"
           "Exit codes: 0 proved, 1 refused, 2 bad usage or input, 3 proved but for cells that claim nothing.\n";
    return count == 2 ? proved : bad_input;
  }
  try {
    const rollfix_verify::Verdict verdict = rollfix_verify::check(read(argument));
    if (!verdict.refusal.empty()) {
      std::cout << "refused: " << verdict.refusal << "\n";
      return refused;
    }
    std::cout << "proved: " << verdict.placements << (verdict.placements == 1 ? " placement, " : " placements, ")
              << verdict.cells << (verdict.cells == 1 ? " cell" : " cells");
    if (verdict.unproved > 0) {
      std::cout << ", of which " << verdict.unproved << " claim nothing\n";
      return incomplete;
    }
    std::cout << ", nothing else";
    if (verdict.open > 0) {
      std::cout << "; of " << 100 * verdict.open << " % of all pairs only whose they are if they fit";
    }
    std::cout << "\n";
    return proved;
  } catch (const std::exception& error) {
    std::cerr << "rollfix-verify: " << argument << ": " << error.what() << "\n";
    return bad_input;
  }
}
