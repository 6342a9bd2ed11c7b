#include "rollfix/files/saved_part.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
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

constexpr const char* kSchemaStart = "rollfix/part/";
constexpr const char* kSchema = "rollfix/part/1";
constexpr std::string_view kDataField = ",\n\"data\": \"";
constexpr std::string_view kChecksumField = "\",\n\"checksum\": \"";
constexpr std::string_view kEnd = "\"}\n";

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

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw InputError(fmt::format("{}: {}: make it again with rollfix inspect PART -o {}", name, what, name));
}

/// Forwards: what stands between the fields does not hold a quotation mark, so that this takes no time.
std::size_t find_or_refuse(std::string_view text, std::string_view field, std::size_t from, const std::string& name) {
  const std::size_t at = text.find(field, from);
  if (at == std::string_view::npos) refuse(name, "is a saved part that is cut short or was edited");
  return at;
}

}  // namespace

bool is_saved_part(std::string_view text) {
  constexpr std::size_t kFirstField = 64;  // it ends before that
  const std::string_view head = text.substr(0, kFirstField);
  const std::size_t field = head.find("\"schema\"");
  return field < head.size() && head.find(kSchemaStart, field) < head.size();
}

std::string format_part(const Part& part) {
  const PartAccess::Data& data = PartAccess::data(part);
  const Outline& outline = data.outline;
  PartWriter writing;
  Json json;
  json["schema"] = kSchema;
  json["name"] = outline.name;
  json["perimeter"] = part.perimeter();
  json["closed"] = outline.closed;
  json["reversed"] = outline.reversed;
  json["hole"] = outline.hole;
  if (!outline.unit.empty()) json["unit"] = outline.unit;
  if (!outline.accuracy.is_exact()) json["accuracy"] = accuracy_json(outline.accuracy);
  if (outline.gallery.empty() || outline.reversed) {
    json["curves"] = curves_json(outline, writing.bytes);
  } else {
    json["gallery"] = outline.gallery;
  }
  writing(outline.gap);
  pass_part(writing, data);
  std::string text = json.dump(0, ' ', false, Json::error_handler_t::replace);
  text.resize(text.size() - 2);  // without the closing "\n}"
  text += kDataField;
  text += to_base64(writing.bytes.bytes());
  const std::uint64_t sum = checksum(text);
  return text.append(kChecksumField).append(fmt::format("{:016x}", sum)).append(kEnd);
}

Part parse_part(std::string_view text, const std::string& name) {
  if (!is_saved_part(text)) throw InputError(fmt::format("{}: is not a saved part", name));
  const std::size_t data_at = find_or_refuse(text, kDataField, 0, name);
  const std::size_t end = find_or_refuse(text, kChecksumField, data_at + kDataField.size(), name);
  const std::string expected = fmt::format("{:016x}{}", checksum(text.substr(0, end)), kEnd);
  const Json json = Json::parse(std::string(text.substr(0, data_at)) + "}", nullptr, false);
  if (json.is_object() && json.contains("schema") && json["schema"].is_string() && json["schema"] != kSchema) {
    refuse(name,
           fmt::format("is a saved part of version '{}', expected '{}'", json["schema"].get<std::string>(), kSchema));
  }
  if (text.substr(end + kChecksumField.size()) != expected) {
    refuse(name, "is a saved part that was changed or damaged since it was written (its checksum does not fit)");
  }
  bool is_base64 = false;
  const std::string bytes =
      from_base64(text.substr(data_at + kDataField.size(), end - data_at - kDataField.size()), is_base64);
  PartAccess::Data data;
  try {
    PartReader reading{ByteReader(bytes)};
    if (json.contains("gallery")) {
      data.outline = gallery(json.at("gallery").get<std::string>());
    } else {
      data.outline.curves = curves_from(json.at("curves"), reading.bytes);
    }
    data.outline.name = name;
    data.outline.closed = json.at("closed").get<bool>();
    data.outline.reversed = json.at("reversed").get<bool>();
    data.outline.hole = json.at("hole").get<bool>();
    if (json.contains("unit")) data.outline.unit = json.at("unit").get<std::string>();
    if (json.contains("accuracy")) data.outline.accuracy = accuracy_from(json.at("accuracy"));
    reading(data.outline.gap);
    pass_part(reading, data);
    Access::set_closed(data.turning, data.outline.closed);
    if (!is_base64 || !reading.bytes.ok() || !reading.bytes.at_end() || !is_sound(data)) {
      refuse(name, "is a saved part whose contents contradict each other");
    }
  } catch (const InputError&) {
    throw;
  } catch (const std::exception&) {
    refuse(name, "is a saved part that lacks a field");
  }
  return PartAccess::part(std::move(data));
}

void save_part(const Part& part, const std::string& path) {
  const std::string text = format_part(part);
  std::ofstream file(path, std::ios::binary);
  if (!(file << text << std::flush)) {
    throw InputError(fmt::format("{}: can't be written: {}", path, std::strerror(errno)));
  }
}

}  // namespace rollfix
