#include "uses.hpp"

#include <fmt/format.h>

#include <array>

#include "rollfix/error.hpp"

namespace rollfix::question {
namespace {

struct Reason {
  std::string_view name;
  const char* text;  // {}: what contacts of this kind are called
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

template <class Reasons>
std::string reason_for(std::string_view name, const Reasons& reasons, const char* contacts) {
  for (const Reason& one : reasons) {
    if (one.name == name) return fmt::format(fmt::runtime(one.text), contacts);
  }
  return fmt::format("it is not taken with {}", contacts);
}

}  // namespace

Uses::Uses(const Question& question)
    : question_(question), kind_(kind_of(question)), has_rolls_(!question.measured.rolls.empty()) {}

std::string Uses::why_not(std::string_view name) const {
  if (name == "clear" && kind_ == QuestionKind::roll) {
    return "`clear` is about touches and several rolls: give `touch`, or rolls with `at_rest`, or leave `clear` out";
  }
  if (kind_ == QuestionKind::at_rest && !has_rolls_) {
    return fmt::format("`{}`: touches do not roll and have no use for it; leave it out", name);
  }
  if (kind_ == QuestionKind::at_rest) {
    return fmt::format("`{}`: {}; leave it out, or choose one roll with `roll` N", name,
                       reason_for(name, kOfRollsAtRest, "several rolls"));
  }
  const bool has_wheel = !question_.measured.wheels.empty();
  const char* const contacts = has_wheel ? "fingers beside a wheel" : "three and more fingers";
  return fmt::format("`{}`: {}; leave it out", name, reason_for(name, kOfMoving, contacts));
}

void Uses::refuse(bool is_given, std::string_view name) const {
  if (is_given) throw InputError(why_not(name));
}

void require_contacts(const Question& question) {
  const Measurements& measured = question.measured;
  const QuestionKind kind = kind_of(question);
  if (kind == QuestionKind::at_rest && !measured.wheels.empty()) {
    throw InputError(
        "`at_rest`: a wheel without skin says something beside a finger, of a part that both of them touch at once; "
        "leave it out, or the wheels");
  }
  if (kind != QuestionKind::at_rest && !measured.touches.empty()) {
    throw InputError("`touch` and a `log` of rolls share a pose with `at_rest`: add it");
  }
  if (question.squeezed && measured.wheels.empty()) {
    throw InputError(
        "`squeezed`: it is about a finger with skin and a wheel without that squeeze a part, such as a jaw and "
        "wheel,r=0.4; leave it out");
  }
  if (kind != QuestionKind::roll) return Uses(question).refuse(!measured.readings.empty(), "reading");
  if (measured.readings.empty() && measured.rolls.empty()) {
    throw InputError("expected readings, a log or touches, found none");
  }
  if (!measured.readings.empty() && !measured.rolls.empty()) {
    throw InputError("expected readings or a log, found both: they can't be of the same roll");
  }
}

}  // namespace rollfix::question
