#pragma once

#include <string>

#include "rollfix/certify/hold_certificate.hpp"
#include "rollfix/files/documents.hpp"
#include "rollfix/hold/hold.hpp"
#include "rollfix/hold/next_pin.hpp"

namespace rollfix {

/// "rollfix/locate/1" of three and more fingers: docs/json.md lists its fields.
std::string format_hold(const HoldAnswer& answer, Layout layout = Layout::lines);

/// "rollfix/advise/1" of how a wheel's pin moves next.
std::string format_next_pin(const HoldAnswer& held, const NextPin& next, Layout layout = Layout::lines);

/// "rollfix/hold-certificate/1".
std::string format_certificate(const HoldCertificate& certificate);

/// What is wrong, and what to give instead, in plain English.
std::string words_of(const HoldDiagnosis& diagnosis, const HoldAnswer& answer);
std::string cure_of(const HoldDiagnosis& diagnosis, const HoldAnswer& answer);

}  // namespace rollfix
