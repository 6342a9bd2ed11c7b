#pragma once

#include <cstddef>
#include <string>

namespace rollfix_verify {

/// What checking a certificate came to.
struct Verdict {
  std::size_t placements = 0;
  std::size_t cells = 0;
  std::size_t unproved = 0;  // cells about which the certificate claims nothing
  double open = 0;           // of two fingers: the share of all pairs of which it is only said whose they are
  std::string refusal;       // why it is refused; empty: all that it claims is proved
};

/// Proves what a certificate claims, or says why not. Throws std::runtime_error: a text that is no certificate.
Verdict check(const std::string& text);

}  // namespace rollfix_verify
