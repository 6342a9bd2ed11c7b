#include "check.hpp"

#include <cstdio>
#include <stdexcept>

#include "document.hpp"

// From the text of a certificate to the verdict's text.
// Idea: the question is repeated in the certificate's own numbers, so that the user can compare it with his. The schema
// says who checks; each check spends from one budget of work and refuses by an exception.
namespace rollfix_verify {
namespace {

// Some seconds to a minute. What the tests' certificates take is a tenth of it at most.
constexpr double kMostWork = 1e6;

/// Text or numbers as they stand in the certificate, with nothing that a terminal would obey.
std::string plain(const Json& value) { return value.dump(-1, ' ', true, Json::error_handler_t::replace); }

constexpr const char* kOneFinger = "rollfix/certificate/1";
constexpr const char* kTwoFingers = "rollfix/pair-certificate/1";
constexpr const char* kTouches = "rollfix/touch-certificate/1";
constexpr const char* kHolds = "rollfix/hold-certificate/1";

/// Name, kind and length of the outline; the name is checked by nothing.
std::string part_of(const Json& json) {
  return "part " + plain(json.at("part")) + (json.at("closed").get<bool>() ? ", closed" : ", open") + ", perimeter " +
         plain(json.at("perimeter")) + "\n";
}

/// Both ends of an interval.
std::string between(const Json& limits) { return plain(limits.at(0)) + " to " + plain(limits.at(1)); }

/// Of a touch, or of a roll's first contact.
std::string contact_text(const Json& touch) {
  std::string text = "an unknown place";
  if (touch.contains("at")) {
    text = plain(touch.at("at").at(0)) + ", " + plain(touch.at("at").at(1)) + " within " +
           plain(touch.at("tolerance").at(0));
  }
  if (touch.contains("normal")) {
    text += ", normal " + plain(touch.at("normal")) + " within " + plain(touch.at("tolerance").at(1)) + " rad";
  }
  return text;
}

/// The readings of a roll, and at the end their common tolerance.
std::string readings_text(const Json& roll) {
  std::string text;
  for (const Json& reading : roll.at("readings")) {
    text += ", by " + plain(reading.at("length")) + " turned " + plain(reading.at("turn"));
  }
  return text + " rad within " + plain(roll.at("within"));
}

/// Of touches and rolls: what was measured, and each stated set of poses.
std::string touches_question(const Json& json) {
  std::string text = part_of(json);
  if (json.at("mirrored").get<bool>()) text += "face down\n";
  text += json.at("radius").get<double>() == 0 ? "finger point\n"
                                               : "finger disk, radius " + plain(json.at("radius")) + "\n";
  if (json.contains("rolls")) {
    for (const Json& roll : json.at("rolls")) text += "roll from " + contact_text(roll) + readings_text(roll) + "\n";
  }
  for (const Json& touch : json.at("touches")) text += "touch at " + contact_text(touch) + "\n";
  for (const Json& one : json.at("poses")) {
    text += one.at("listed").get<bool>() ? "pose " : "left out: pose ";
    // A set may have a pose that fits, an extent, or both.
    const bool fits = one.contains("pose");
    if (fits) {
      const Json& pose = one.at("pose");
      text += plain(pose.at(0)) + ", " + plain(pose.at(1)) + ", heading " + plain(pose.at(2)) + " rad fits";
    }
    if (one.contains("extent")) {
      const Json& extent = one.at("extent");
      text += std::string(fits ? ", all of its set is" : "that may fit") + " in x " + between(extent.at(0)) + ", y " +
              between(extent.at(1)) + ", heading " + between(extent.at(2)) + " rad";
    }
    text += "\n";
  }
  return text;
}

/// A tolerance that may be missing.
std::string or_nothing(const Json& tolerance, const std::string& what, const std::string& unit) {
  return tolerance.is_null() ? "" : ", " + what + " " + plain(tolerance) + unit;
}

/// Of a hold: fingers, wheels, what was measured at each instant, and each set of first contacts.
std::string holds_question(const Json& json) {
  std::string text = part_of(json);
  if (json.at("mirrored").get<bool>()) text += "face down\n";
  for (const Json& finger : json.at("fingers")) {
    const Json& tolerance = finger.at("tolerance");
    text += "finger " + plain(finger.at("kind"));
    if (finger.contains("radius")) text += ", radius " + plain(finger.at("radius"));
    text += ": within travel " + plain(tolerance.at("travel")) + ", angle " + plain(tolerance.at("angle")) + " rad" +
            or_nothing(tolerance.at("place"), "place", "") + "\n";
  }
  for (const Json& wheel : json.at("wheels")) {
    const Json& tolerance = wheel.at("tolerance");
    text += "wheel, radius " + plain(wheel.at("radius")) + ": within place " + plain(tolerance.at("place")) +
            or_nothing(tolerance.at("spin"), "encoder", " rad") + or_nothing(tolerance.at("line"), "squeezed", " rad") +
            "\n";
  }
  for (const Json& instant : json.at("instants")) {
    text += "at " + plain(instant.at("time")) + ":";
    for (const Json& contact : instant.at("contacts")) {
      text += " travelled " + plain(contact.at("travelled")) + ", tangent " + plain(contact.at("tangent")) + " rad";
      if (contact.contains("at")) text += ", at " + plain(contact.at("at").at(0)) + " " + plain(contact.at("at").at(1));
      text += ";";
    }
    for (const Json& pin : instant.at("pins")) {
      text += " pin " + plain(pin.at("at").at(0)) + " " + plain(pin.at("at").at(1));
      if (pin.contains("spin")) text += ", turned " + plain(pin.at("spin")) + " rad";
      text += ";";
    }
    // The last separator becomes the end of the line.
    text.back() = '\n';
  }
  for (const Json& set : json.at("sets")) {
    text += set.at("listed").get<bool>() ? "first contacts in" : "left out: first contacts in";
    for (const Json& arc : set.at("extent")) text += " s " + between(arc) + ",";
    text.back() = '\n';
  }
  return text;
}

/// By the schema; for one finger and two: readings, facing and tolerance.
std::string question_of(const Json& json, const std::string& schema) {
  if (schema == kTouches) return touches_question(json);
  if (schema == kHolds) return holds_question(json);
  const bool is_one = schema == kOneFinger;
  std::string text = part_of(json);
  for (const Json& reading : json.at("readings")) {
    const Json& length = reading.at("length");
    text += is_one ? "reading length " + plain(length)
                   : "reading lengths " + plain(length.at(0)) + " and " + plain(length.at(1));
    text += ", turn " + plain(reading.at("turn")) + " rad\n";
  }
  if (!is_one) text += "facing " + (json.at("facing").is_null() ? "unknown" : plain(json.at("facing")) + " rad") + "\n";
  return text + "tolerance " + plain(json.at("tolerance")) + " rad\n";
}

/// "1 cell", "2 cells".
std::string counted(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

/// Three digits.
std::string percent_of(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", 100 * share);
  return text;
}

/// Of touches.
std::string described_poses(const Verdict& verdict) {
  std::string found = std::to_string(verdict.placements) + (verdict.placements == 1 ? " set" : " sets") + " of poses";
  if (verdict.left_out > 0) found += " and " + std::to_string(verdict.left_out) + " that the answer leaves out";
  if (verdict.inside > 0) found += ", " + counted(verdict.inside, "more pose") + " in them";
  // What is not proved stands first, before what was found.
  if (verdict.is_complete()) return "proved: " + found + ", nothing else\n" + verdict.question;
  std::string but;
  // Left open by the certificate itself.
  if (verdict.open > 0) {
    but = "poses with " + verdict.open_contact + " on " + percent_of(verdict.share) + " % of the boundary";
  }
  // Looked at down to the smallest size.
  if (verdict.unproved > 0) {
    but += std::string(but.empty() ? "" : " and ") + std::to_string(verdict.unproved) +
           (verdict.unproved == 1 ? " box" : " boxes") + " of poses within rounding of the tolerance";
  }
  return "proved but for " + but + ": " + found + "\n" + verdict.question;
}

/// Of a hold.
std::string described_holds(const Verdict& verdict) {
  std::string found =
      std::to_string(verdict.placements) + (verdict.placements == 1 ? " set" : " sets") + " of first contacts";
  if (verdict.left_out > 0) found += " and " + std::to_string(verdict.left_out) + " that the answer leaves out";
  if (verdict.is_complete()) return "proved: " + found + ", nothing else\n" + verdict.question;
  std::string but;
  const auto add = [&](const std::string& what) { but += (but.empty() ? "" : " and ") + what; };
  if (verdict.open > 0) add("first contacts on " + percent_of(verdict.share) + " % of all");
  if (verdict.unproved > 0) {
    add(std::to_string(verdict.unproved) + (verdict.unproved == 1 ? " box" : " boxes") +
        " of first contacts within rounding of the tolerance");
  }
  if (verdict.unwitnessed > 0) add(counted(verdict.unwitnessed, "set") + " in which nothing is shown to fit");
  return "proved but for " + but + ": " + found + "\n" + verdict.question;
}

/// What a field lacks, for whoever wrote or changed the file by hand: "/readings/0/turn: expected number, found string"
/// rather than the library's own words, "[json.exception.type_error.302] (/readings/0/turn) type must be ...".
std::string in_words(const Json::exception& error) {
  std::string text = error.what();
  text.erase(0, text.find("] ") + 2);
  // JSON_DIAGNOSTICS puts the path in front.
  std::string path = "the document";
  const std::size_t end = text.find(") ");
  if (text.starts_with('(') && end != std::string::npos) {
    path = text.substr(1, end - 1);
    text.erase(0, end + 2);
  }
  const auto replace = [&text](const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    if (at != std::string::npos) text.replace(at, from.size(), to);
  };
  replace("type must be ", "expected ");
  replace(", but is ", ", found ");
  replace("cannot use at() with ", "expected more in it, found ");
  replace("key ", "expected a field ");
  replace(" not found", ", found none");
  return path + ": " + text;
}

/// Refused in the verdict; throws where it is no certificate of a known schema.
Verdict verdict_of(const Json& json) {
  const Json schema = json.is_object() && json.contains("schema") ? json["schema"] : Json();
  if (schema != kOneFinger && schema != kTwoFingers && schema != kTouches && schema != kHolds) {
    throw std::runtime_error(std::string("/schema: expected ") + kOneFinger + ", " + kTwoFingers + ", " + kTouches +
                             " or " + kHolds + ", found " + (schema.is_null() ? "none" : plain(schema)));
  }
  // Before the budget: a certificate that lacks a field of the question throws, which is bad input and no refusal.
  const std::string question = question_of(json, schema);
  Verdict refused;
  try {
    // All that follows spends from it.
    const Budget budget(kMostWork);
    const Document document(json);
    // The others check their outline by themselves, for they have no tolerance in the document.
    if (schema == kOneFinger || schema == kTwoFingers) document.check();
    Verdict verdict = schema == kOneFinger    ? check_one_finger(document)
                      : schema == kTwoFingers ? check_two_fingers(document)
                      : schema == kTouches    ? check_touches(document)
                                              : check_holds(document);
    verdict.question = question;
    return verdict;
  } catch (const std::domain_error& error) {
    refused.refusal = error.what();
  } catch (const OutOfBudget& error) {
    refused.refusal = error.what();
  }
  return refused;
}

}  // namespace

/// A text that is no certificate of a known schema throws; a certificate that is wrong, or that costs too much, is
/// refused in the verdict.
Verdict check(const std::string& text) {
  Verdict refused;
  // Before anything is parsed: the budget of work begins only behind that.
  if (text.size() > kMostBytes) {
    refused.refusal = "not decided: the certificate is too long";
    return refused;
  }
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) throw std::runtime_error("is no JSON document, expected one that locate --certify wrote");
  try {
    return verdict_of(json);
  } catch (const Json::exception& error) {
    throw std::runtime_error(in_words(error));
  }
}

/// The first line has the verdict, the others the question.
std::string described(const Verdict& verdict) {
  if (!verdict.refusal.empty()) return "refused: " + verdict.refusal + "\n";
  if (verdict.of_touches) return described_poses(verdict);
  if (verdict.of_holds) return described_holds(verdict);
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
