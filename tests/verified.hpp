#pragma once

#include <exception>
#include <nlohmann/json.hpp>
#include <string>

#include "check.hpp"

// What the program that proves certificates again says of one.
namespace verified {

using Json = nlohmann::json;
using rollfix_verify::Verdict;

inline Verdict checked(const Json& certificate) { return rollfix_verify::check(certificate.dump()); }

/// Its first line.
inline std::string words(const Json& certificate) {
  try {
    const std::string all = rollfix_verify::described(checked(certificate));
    return all.substr(0, all.find('\n'));
  } catch (const std::exception& error) {
    return std::string("no certificate: ") + error.what();
  }
}
inline bool is_proved(const Json& certificate) { return words(certificate).starts_with("proved: "); }

}  // namespace verified
