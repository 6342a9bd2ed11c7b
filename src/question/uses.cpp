#include "uses.hpp"

#include <fmt/format.h>

#include <array>

#include "rollfix/error.hpp"

// Why an option does not go with some contacts, in one sentence each.
// Idea: two tables of reasons, one for each kind of search; an option without an entry has a general reason.
namespace rollfix::question {
namespace {

struct Reason {
  std::string_view name;  // of the Question's field
  const char* text;       // {}: what contacts of this kind are called
};

// Of several rolls on a part at rest.
constexpr std::array<Reason, 6> kOfRollsAtRest = {{
    {"reading", "`at_rest` takes the rolls of a log"},
    {"facing", "rolls with u and psi have it themselves"},
    {"at", "`at_rest` takes rows all along every roll"},
    {"prior", "it is of the start of one roll"},
    {"direction", "rolls with u and psi say the direction themselves"},
    {"may_overlap", "it is of two fingers"},
}};

// Of several fingers on a part that moves.
constexpr std::array<Reason, 9> kOfMoving = {{
    {"reading", "{} are taken from logs"},
    {"facing", "logs of u and psi contain it"},
    {"prior", "it is not taken with {}"},
    {"heading", "{} tell how the part lies themselves"},
    {"pose", "{} tell how the part lies themselves"},
    {"direction", "logs of u and psi contain it"},
    {"robust", "outliers are not looked for with {}"},
    {"may_overlap", "overlapping fingers are not looked for with {}"},
    {"clear", "it is about touches"},
}};

/// `contacts`: what to call contacts of this kind in the message.
template <class Reasons>
std::string reason_for(std::string_view name, const Reasons& reasons, const char* contacts) {
  // Reasons name the contacts with {} where that reads better.
  for (const Reason& one : reasons) {
    if (one.name == name) return fmt::format(fmt::runtime(one.text), contacts);
  }
  return fmt::format("it is not taken with {}", contacts);
}

}  // namespace

Uses::Uses(const Question& question)
    : question_(question), kind_(kind_of(question)), has_rolls_(!question.measured.rolls.empty()) {}

/// The field, the reason, and what to do instead.
std::string Uses::why_not(std::string_view name) const {
  // Here the advice is to give other contacts.
  if (name == "clear" && kind_ == QuestionKind::roll) {
    return "`clear` is about touches and several rolls: give `touch`, or rolls with `at_rest`, or leave `clear` out";
  }
  // Touches alone.
  if (kind_ == QuestionKind::at_rest && !has_rolls_) {
    return fmt::format("`{}`: touches do not roll and have no use for it; leave it out", name);
  }
  // Rolls on a part at rest, with or without touches.
  if (kind_ == QuestionKind::at_rest) {
    return fmt::format("`{}`: {}; leave it out, or choose one roll with `roll` N", name,
                       reason_for(name, kOfRollsAtRest, "several rolls"));
  }
  // Fingers on a part that moves.
  const bool has_wheel = !question_.measured.wheels.empty();
  const char* const contacts = has_wheel ? "fingers beside a wheel" : "three and more fingers";
  return fmt::format("`{}`: {}; leave it out", name, reason_for(name, kOfMoving, contacts));
}

void Uses::refuse(bool is_given, std::string_view name) const {
  if (is_given) throw InputError(why_not(name));
}

/// After this the kind of the question has all contacts that it needs, and none of another kind.
void require_contacts(const Question& question) {
  const Measurements& measured = question.measured;
  const QuestionKind kind = kind_of(question);
  // Wheels turn a part that moves.
  if (kind == QuestionKind::at_rest && !measured.wheels.empty()) {
    throw InputError(
        "`at_rest`: a wheel without skin says something beside a finger, of a part that both of them touch at once; "
        "leave it out, or the wheels");
  }
  // Touches are all of one pose, which a moving part does not have.
  if (kind != QuestionKind::at_rest && !measured.touches.empty()) {
    throw InputError("`touch` and a `log` of rolls share a pose with `at_rest`: add it");
  }
  // A part is squeezed between a finger and a wheel.
  if (question.squeezed && measured.wheels.empty()) {
    throw InputError(
        "`squeezed`: it is about a finger with skin and a wheel without that squeeze a part, such as a jaw and "
        "wheel,r=0.4; leave it out");
  }
  // Readings are of one roll alone.
  if (kind != QuestionKind::roll) return Uses(question).refuse(!measured.readings.empty(), "reading");
  // The kind is a roll, for want of anything else.
  if (measured.readings.empty() && measured.rolls.empty()) {
    throw InputError("expected readings, a log or touches, found none");
  }
  if (!measured.readings.empty() && !measured.rolls.empty()) {
    throw InputError("expected readings or a log, found both: they can't be of the same roll");
  }
}

}  // namespace rollfix::question
