#include "part_record.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "files/byte_stream.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline.hpp"

namespace rollfix {

namespace {

using Json = nlohmann::ordered_json;

/// The kinds of the curves with how many of each stand in a row, and their numbers.
Json curves_json(const Outline& outline, ByteWriter& numbers) {
  Json runs = Json::array();
  std::string last;
  for (std::size_t k = 0; k < outline.curves.size(); ++k) {
    const std::optional<CurveRecord> record = outline.curves[k].record();
    if (!record) {
      throw InputError(
          fmt::format("{}: curve {} is of a type that can't be saved: give the type a record(), see rollfix/curve.hpp",
                      outline.name, k + 1));
    }
    const std::string kind = fmt::format("{} {}", record->numbers.size(), record->kind);
    if (kind == last) {
      runs.back()[1] = runs.back()[1].get<std::size_t>() + 1;
    } else {
      runs.push_back({kind, 1});
    }
    last = kind;
    for (const double value : record->numbers) numbers.number(value);
  }
  return runs;
}

std::vector<Curve> curves_from(const Json& runs, ByteReader& numbers) {
  std::vector<Curve> curves;
  for (const Json& run : runs) {
    const auto& text = run.at(0).get_ref<const std::string&>();
    const std::size_t blank = text.find(' ');
    const std::size_t each = std::stoul(text);
    CurveRecord record{text.substr(blank + 1), std::vector<double>(each)};
    const auto count = run.at(1).get<std::size_t>();
    for (std::size_t k = 0; k < count && numbers.ok(); ++k) {
      for (double& value : record.numbers) value = numbers.number();
      curves.push_back(curve_from(record));
    }
  }
  return curves;
}

Json accuracy_json(const Accuracy& accuracy) {
  return {{"length", accuracy.length}, {"turn", accuracy.turn}, {"alike", accuracy.alike}, {"walk", accuracy.walk}};
}

/// Files from before parts had one have none: exact.
Accuracy accuracy_from(const Json& json) {
  return {json.at("length").get<double>(), json.at("turn").get<double>(), json.at("alike").get<double>(),
          json.at("walk").get<double>()};
}

/// What JSON and numbers say of the outline.
Outline outline_from(const Json& json, ByteReader& numbers, const std::string& name) {
  Outline outline;
  if (json.contains("gallery")) {
    outline = gallery(json.at("gallery").get<std::string>());
  } else {
    outline.curves = curves_from(json.at("curves"), numbers);
  }
  outline.name = name;
  outline.closed = json.at("closed").get<bool>();
  outline.reversed = json.at("reversed").get<bool>();
  outline.hole = json.at("hole").get<bool>();
  if (json.contains("unit")) outline.unit = json.at("unit").get<std::string>();
  if (json.contains("accuracy")) outline.accuracy = accuracy_from(json.at("accuracy"));
  outline.gap = numbers.number();
  return outline;
}

}  // namespace

PartRecord record_of(const Part& part) {
  const Outline& outline = part.outline();
  Json json;
  json["name"] = outline.name;
  json["perimeter"] = part.perimeter();
  json["closed"] = outline.closed;
  json["reversed"] = outline.reversed;
  json["hole"] = outline.hole;
  if (!outline.unit.empty()) json["unit"] = outline.unit;
  if (!outline.accuracy.is_exact()) json["accuracy"] = accuracy_json(outline.accuracy);
  ByteWriter numbers;
  if (outline.gallery.empty() || outline.reversed) {
    json["curves"] = curves_json(outline, numbers);
  } else {
    json["gallery"] = outline.gallery;
  }
  numbers.number(outline.gap);
  return {json.dump(0, ' ', false, Json::error_handler_t::replace), numbers.bytes()};
}

Part part_of(std::string_view outline, std::string_view numbers, const std::string& name, TrailingNumbers rest) {
  const Json json = Json::parse(outline);
  ByteReader reading(numbers);
  const PartOptions as_it_is{true};  // whoever saved it allowed what there is
  Part part(outline_from(json, reading, name), as_it_is);
  if (!reading.ok() || (rest == TrailingNumbers::refused && !reading.at_end()))
    throw std::invalid_argument("its contents contradict each other");
  return part;
}

}  // namespace rollfix
