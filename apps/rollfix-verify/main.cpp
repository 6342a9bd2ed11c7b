// rollfix-verify CERTIFICATE: proves again what a certificate of `rollfix locate --certify` claims, with none of the
// search's code.
#include <fstream>
#include <iostream>
#include <istream>
#include <string>

#include "check.hpp"

namespace {

// What scripts may rely on.
enum ExitCode { proved = 0, refused = 1, bad_input = 2, incomplete = 3 };

constexpr const char* kHelp =
    "Usage: rollfix-verify CERTIFICATE\n"
    "Proves again what a certificate of `rollfix locate --certify` claims; -: from stdin.\n"
    "Exit codes: 0 proved, 1 refused, 2 bad usage or input, 3 proved but for cells that exclude nothing.\n";

/// Throws std::runtime_error where the output can't take it: an answer that nobody gets is no success.
void print(const std::string& text) {
  std::cout << text << std::flush;
  if (!std::cout) throw std::runtime_error("standard output can't be written to");
}

/// No more than shows that it is too long.
std::string read(const std::string& path) {
  std::ifstream file;
  if (path != "-") file.open(path, std::ios::binary);
  if (!file) throw std::runtime_error("can't be read");
  std::istream& stream = path == "-" ? std::cin : file;
  std::string text(rollfix_verify::kMostBytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

}  // namespace

/// Exit codes: see docs/certificates.md. What is no certificate is bad input, like a wrong argument.
int main(int count, char** arguments) {
  if (count != 2) {
    std::cerr << kHelp;
    return bad_input;
  }
  const std::string argument = arguments[1];
  try {
    if (argument == "--help" || argument == "-h") {
      print(kHelp);
      return proved;
    }
    const rollfix_verify::Verdict verdict = rollfix_verify::check(read(argument));
    print(rollfix_verify::described(verdict));
    if (!verdict.refusal.empty()) return refused;
    // Counted cells and kinds are no refusal: the rest of the theorem is proved.
    return verdict.is_complete() ? proved : incomplete;
  } catch (const std::exception& error) {
    std::cerr << "rollfix-verify: " << argument << ": " << error.what() << "\n";
    return bad_input;
  }
}
