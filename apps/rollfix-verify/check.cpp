#include "check.hpp"

#include <stdexcept>

#include "check_one.hpp"
#include "check_two.hpp"

namespace rollfix_verify {

Verdict check(const std::string& text) {
  const Json json = Json::parse(text);
  const bool is_one = json.at("schema") == "rollfix/certificate/1";
  if (!is_one && json.at("schema") != "rollfix/pair-certificate/1") {
    throw std::runtime_error("it is no certificate of version rollfix/certificate/1 or rollfix/pair-certificate/1");
  }
  try {
    const Document document(json);
    return is_one ? check_one_finger(document) : check_two_fingers(document);
  } catch (const std::domain_error& error) {
    return {0, 0, 0, 0, error.what()};
  }
}

}  // namespace rollfix_verify
