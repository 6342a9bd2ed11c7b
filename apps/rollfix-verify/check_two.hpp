#pragma once

#include "check.hpp"
#include "document.hpp"

namespace rollfix_verify {

/// Proves what a certificate of two fingers claims. Throws std::domain_error: it is refused; std::runtime_error: it is
/// none.
Verdict check_two_fingers(const Document& document);

}  // namespace rollfix_verify
