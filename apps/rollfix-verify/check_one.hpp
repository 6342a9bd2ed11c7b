#pragma once

#include "check.hpp"
#include "document.hpp"

namespace rollfix_verify {

/// Proves what a certificate of one finger claims. Throws std::domain_error: it is refused; std::runtime_error: it is
/// none.
Verdict check_one_finger(const Document& document);

}  // namespace rollfix_verify
