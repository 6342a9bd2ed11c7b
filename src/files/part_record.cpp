#include "part_record.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "files/byte_stream.hpp"
#include "part/part_data.hpp"
#include "rollfix/error.hpp"
#include "rollfix/outline/gallery.hpp"

namespace rollfix {

/// The insides of a turning function, to be written and read.
struct TurningFunctionAccess {
  template <class Pass, class Turning>
  static void pass(Pass& pass, Turning& turning) {
    pass(turning.perimeter_, turning.period_turn_, turning.most_curvature_);
    pass.list(turning.panels_, 6, [&](auto& panel) {
      pass(panel.lo, panel.hi, panel.middle, panel.inverse_half, panel.offset, panel.count);
    });
    pass.list(turning.coefficients_, 2, [&](auto& pair) { pass(pair[0], pair[1]); });
    pass.list(turning.spirals_, 9, [&](auto& spiral) {
      pass(spiral.lo, spiral.hi, spiral.start.angle, spiral.start.curvature, spiral.end.angle, spiral.end.curvature,
           spiral.trend, spiral.first_panel, spiral.last_panel);
    });
  }
  static std::size_t coefficients(const TurningFunction& turning) { return turning.coefficients_.size(); }
  static void set_closed(TurningFunction& turning, bool closed) { turning.closed_ = closed; }
};

namespace {

using Json = nlohmann::ordered_json;
using Access = TurningFunctionAccess;

/// Writes what a part holds or reads it, in the same order: numbers, and lists of entries of so many numbers each.
struct PartWriter {
  ByteWriter bytes;

  void one(double value) { bytes.number(value); }
  void one(std::uint32_t value) { bytes.whole(value); }
  void one(int value) { bytes.whole(static_cast<std::uint64_t>(static_cast<std::int64_t>(value))); }
  template <class... Numbers>
  void operator()(const Numbers&... numbers) {
    (one(numbers), ...);
  }
  template <class List, class Entry>
  void list(const List& list, std::size_t /*numbers_each*/, const Entry& entry) {
    bytes.whole(list.size());
    for (const auto& each : list) entry(each);
  }
};

struct PartReader {
  ByteReader bytes;

  void one(double& value) { value = bytes.number(); }
  void one(std::uint32_t& value) { value = static_cast<std::uint32_t>(bytes.whole()); }
  void one(int& value) { value = static_cast<int>(static_cast<std::int64_t>(bytes.whole())); }
  template <class... Numbers>
  void operator()(Numbers&... numbers) {
    (one(numbers), ...);
  }
  template <class List, class Entry>
  void list(List& list, std::size_t numbers_each, const Entry& entry) {
    list.resize(bytes.count(8 * numbers_each));
    for (auto& each : list) entry(each);
  }
};

template <class Pass, class Data>
void pass_part(Pass& pass, Data& data) {
  const auto number = [&](auto& value) { pass(value); };
  Access::pass(pass, data.turning);
  pass.list(data.parametrization.pieces, 3, [&](auto& piece) { pass(piece.curve, piece.offset, piece.count); });
  pass.list(data.parametrization.coefficients, 1, number);
  pass.list(data.corners, 2, [&](auto& corner) { pass(corner.s, corner.turn); });
  pass.list(data.inflections, 1, number);
  pass.list(data.vertices, 1, number);
}

/// What the search relies on. A file with the right checksum that fails here was not written by format_part.
bool is_sound(const PartAccess::Data& data) {
  const auto& panels = data.turning.panels();
  const std::size_t coefficients = Access::coefficients(data.turning);
  const auto& spirals = data.turning.spirals();
  const auto& pieces = data.parametrization.pieces;
  if (panels.empty() || spirals.empty() || pieces.size() != panels.size()) return false;
  const auto fits = [](std::size_t offset, std::size_t count, std::size_t size) {
    return count > 0 && offset <= size && count <= size - offset;
  };
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const Panel& panel = panels[k];
    if (!fits(panel.offset, panel.count, coefficients) || panel.count % kPanelBlock != 0) return false;
    if (panel.count > kMostPowers || !(panel.lo < panel.hi)) return false;
    if (k > 0 && panel.lo != panels[k - 1].hi) return false;
    if (pieces[k].curve >= data.outline.curves.size()) return false;
    if (!fits(pieces[k].offset, pieces[k].count, data.parametrization.coefficients.size())) return false;
  }
  for (std::size_t k = 0; k < spirals.size(); ++k) {
    const Spiral& spiral = spirals[k];
    if (spiral.first_panel > spiral.last_panel || spiral.last_panel >= panels.size()) return false;
    if (!(spiral.lo < spiral.hi) || (k > 0 && spiral.lo != spirals[k - 1].hi)) return false;
  }
  const double perimeter = data.turning.perimeter();
  return panels.front().lo == 0 && spirals.front().lo == 0 && spirals.back().hi == perimeter && perimeter > 0;
}

/// The kinds of the curves with how many of each stand in a row, and their numbers.
Json curves_json(const Outline& outline, ByteWriter& numbers) {
  Json runs = Json::array();
  std::string last;
  for (std::size_t k = 0; k < outline.curves.size(); ++k) {
    const std::optional<CurveRecord> record = outline.curves[k].record();
    if (!record) {
      throw InputError(fmt::format(
          "{}: curve {} is of a type that can't be saved: give the type a record(), see rollfix/outline/curve.hpp",
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
  const PartAccess::Data& data = PartAccess::data(part);
  const Outline& outline = data.outline;
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
  PartWriter computed;
  pass_part(computed, data);
  return {json.dump(0, ' ', false, Json::error_handler_t::replace), numbers.bytes(), computed.bytes.bytes()};
}

Part part_of(std::string_view outline, std::string_view numbers_and_computed, const std::string& name) {
  const Json json = Json::parse(outline);
  PartReader reading{ByteReader(numbers_and_computed)};
  PartAccess::Data data;
  data.outline = outline_from(json, reading.bytes, name);
  pass_part(reading, data);
  Access::set_closed(data.turning, data.outline.closed);
  if (!reading.bytes.ok() || !reading.bytes.at_end() || !is_sound(data)) {
    throw std::invalid_argument("its contents contradict each other");
  }
  return PartAccess::part(std::move(data));
}

Part rebuilt_part(std::string_view outline, std::string_view numbers, const std::string& name) {
  const Json json = Json::parse(outline);
  ByteReader reading(numbers);
  const PartOptions as_it_is{true};  // whoever saved it allowed what there is
  Part part(outline_from(json, reading, name), as_it_is);
  if (!reading.ok() || !reading.at_end()) throw std::invalid_argument("its contents contradict each other");
  return part;
}

}  // namespace rollfix
