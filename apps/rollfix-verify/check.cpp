#include "check.hpp"

#include <cstdio>
#include <stdexcept>

#include "budget.hpp"
#include "document.hpp"

namespace rollfix_verify {
namespace {

// Some seconds to a minute. What the tests' certificates take is a tenth of it at most.
constexpr double kMostWork = 1e6;

/// Text or numbers as they stand in the certificate, with nothing that a terminal would obey.
std::string plain(const Json& value) { return value.dump(-1, ' ', true, Json::error_handler_t::replace); }

std::string question_of(const Json& json, bool is_one) {
  std::string text = "part " + plain(json.at("part")) + (json.at("closed").get<bool>() ? ", closed" : ", open") +
                     ", perimeter " + plain(json.at("perimeter")) + "\n";
  for (const Json& reading : json.at("readings")) {
    const Json& length = reading.at("length");
    text += is_one ? "reading length " + plain(length)
                   : "reading lengths " + plain(length.at(0)) + " and " + plain(length.at(1));
    text += ", turn " + plain(reading.at("turn")) + " rad\n";
  }
  if (!is_one) text += "facing " + (json.at("facing").is_null() ? "unknown" : plain(json.at("facing")) + " rad") + "\n";
  return text + "tolerance " + plain(json.at("tolerance")) + " rad\n";
}

std::string counted(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string percent_of(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", 100 * share);
  return text;
}

}  // namespace

Verdict check(const std::string& text) {
  Verdict refused;
  if (text.size() > kMostBytes) {
    refused.refusal = "not decided: the certificate is too long";
    return refused;
  }
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) throw std::runtime_error("is no JSON document, expected one that locate --certify wrote");
  const Json schema = json.is_object() && json.contains("schema") ? json["schema"] : Json();
  const bool is_one = schema == "rollfix/certificate/1";
  if (!is_one && schema != "rollfix/pair-certificate/1") {
    throw std::runtime_error("it is no certificate of version rollfix/certificate/1 or rollfix/pair-certificate/1");
  }
  const std::string question = question_of(json, is_one);
  try {
    const Budget budget(kMostWork);
    const Document document(json);
    document.check();
    Verdict verdict = is_one ? check_one_finger(document) : check_two_fingers(document);
    verdict.question = question;
    return verdict;
  } catch (const std::domain_error& error) {
    refused.refusal = error.what();
  } catch (const OutOfBudget& error) {
    refused.refusal = error.what();
  }
  return refused;
}

std::string described(const Verdict& verdict) {
  if (!verdict.refusal.empty()) return "refused: " + verdict.refusal + "\n";
  std::string found = counted(verdict.placements, "placement");
  if (verdict.families == 1) found += ", 1 of them a family";
  if (verdict.families > 1) found += ", " + std::to_string(verdict.families) + " of them families";
  found += ", " + counted(verdict.cells, "cell");
  if (verdict.is_complete()) return "proved: " + found + ", nothing else\n" + verdict.question;
  std::string text = "proved but for " + counted(verdict.open, "cell") + " that " +
                     (verdict.open == 1 ? "excludes" : "exclude") + " nothing (" + percent_of(verdict.share) +
                     " % of all starts)";
  if (verdict.unproved > 0) text += " and " + counted(verdict.unproved, "placement") + " of unproved kind";
  return text + ": " + found + "\n" + verdict.question;
}

}  // namespace rollfix_verify
