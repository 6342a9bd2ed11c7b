#include "files/part_record.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "rollfix/error.hpp"
#include "rollfix/files.hpp"
#include "rollfix/outline.hpp"

namespace rollfix {
namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t kNoDigit = 0xFF;

constexpr std::array<std::uint8_t, 256> digit_values() {
  std::array<std::uint8_t, 256> values{};
  for (std::uint8_t& value : values) value = kNoDigit;
  for (std::size_t k = 0; k < kDigits.size(); ++k) {
    values[static_cast<unsigned char>(kDigits[k])] = static_cast<std::uint8_t>(k);
  }
  return values;
}

constexpr std::array<std::uint8_t, 256> kValues = digit_values();

std::uint32_t byte_at(std::string_view bytes, std::size_t k) {
  return k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0U;
}

}  // namespace

std::string to_base64(std::string_view bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const std::uint32_t three = byte_at(bytes, k) << 16U | byte_at(bytes, k + 1) << 8U | byte_at(bytes, k + 2);
    for (std::uint32_t digit = 0; digit < 4; ++digit) {
      const bool is_padding = k + digit > bytes.size();
      text.push_back(is_padding ? '=' : kDigits[three >> (18 - 6 * digit) & 0x3FU]);
    }
  }
  return text;
}

std::string from_base64(std::string_view text, bool& ok) {
  ok = text.size() % 4 == 0;
  std::size_t padding = 0;
  while (padding < 2 && padding < text.size() && text[text.size() - 1 - padding] == '=') ++padding;
  std::string bytes;
  bytes.resize(text.size() / 4 * 3);
  std::size_t at = 0;
  std::uint32_t wrong = 0;
  for (std::size_t k = 0; k + 4 <= text.size(); k += 4) {
    std::uint32_t three = 0;
    for (std::size_t digit = 0; digit < 4; ++digit) {
      const bool is_padding = k + digit >= text.size() - padding;
      const std::uint32_t value = is_padding ? 0U : kValues[static_cast<unsigned char>(text[k + digit])];
      wrong |= value;
      three = three << 6U | (value & 0x3FU);
    }
    bytes[at++] = static_cast<char>(three >> 16U & 0xFFU);
    bytes[at++] = static_cast<char>(three >> 8U & 0xFFU);
    bytes[at++] = static_cast<char>(three & 0xFFU);
  }
  if (wrong > 0x3FU) ok = false;
  bytes.resize(at >= padding ? at - padding : 0);
  return bytes;
}

std::uint64_t checksum(std::string_view bytes) {
  constexpr std::uint64_t kPrime = 0x00000100000001B3U;
  std::uint64_t sum = 0xCBF29CE484222325U;
  ByteReader reader(bytes);
  for (std::size_t k = 0; k + 8 <= bytes.size(); k += 8) sum = (sum ^ reader.whole()) * kPrime;
  for (std::size_t k = bytes.size() / 8 * 8; k < bytes.size(); ++k) {
    sum = (sum ^ static_cast<unsigned char>(bytes[k])) * kPrime;
  }
  return sum;
}

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

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSchemaStart = "rollfix/part/";
constexpr const char* kSchema = "rollfix/part/2";
constexpr const char* kOlderSchema = "rollfix/part/1";  // it held what was computed, too
constexpr std::string_view kDataField = ",\n\"data\": \"";
constexpr std::string_view kChecksumField = "\",\n\"checksum\": \"";
constexpr std::string_view kEnd = "\"}\n";

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
  const PartRecord record = record_of(part);
  // The outline's fields after the schema, without the closing "\n}".
  std::string text = fmt::format("{{\n\"schema\": \"{}\",{}", kSchema, record.outline.substr(1));
  text.resize(text.size() - 2);
  text += kDataField;
  text += to_base64(record.numbers);
  const std::uint64_t sum = checksum(text);
  return text.append(kChecksumField).append(fmt::format("{:016x}", sum)).append(kEnd);
}

Part parse_part(std::string_view text, const std::string& name) {
  if (!is_saved_part(text)) throw InputError(fmt::format("{}: is not a saved part", name));
  const std::size_t data_at = find_or_refuse(text, kDataField, 0, name);
  const std::size_t end = find_or_refuse(text, kChecksumField, data_at + kDataField.size(), name);
  const std::string expected = fmt::format("{:016x}{}", checksum(text.substr(0, end)), kEnd);
  const Json json = Json::parse(std::string(text.substr(0, data_at)) + "}", nullptr, false);
  const std::string schema = json.is_object() ? json.value("schema", kSchema) : kSchema;
  if (schema != kSchema && schema != kOlderSchema) {
    refuse(name, fmt::format("is a saved part of version '{}', expected '{}'", schema, kSchema));
  }
  if (text.substr(end + kChecksumField.size()) != expected) {
    refuse(name, "is a saved part that was changed or damaged since it was written (its checksum does not fit)");
  }
  bool is_base64 = false;
  const std::string bytes =
      from_base64(text.substr(data_at + kDataField.size(), end - data_at - kDataField.size()), is_base64);
  if (!is_base64) refuse(name, "is a saved part whose contents contradict each other");
  try {
    return part_of(std::string(text.substr(0, data_at)) + "}", bytes, name,
                   schema == kOlderSchema ? TrailingNumbers::ignored : TrailingNumbers::refused);
  } catch (const InputError&) {
    throw;
  } catch (const std::invalid_argument&) {
    refuse(name, "is a saved part whose contents contradict each other");
  } catch (const std::exception&) {
    refuse(name, "is a saved part that lacks a field");
  }
}

std::string saved_name(std::string_view text) {
  const Json json = Json::parse(std::string(text.substr(0, text.find(kDataField))) + "}", nullptr, false);
  return json.is_object() ? json.value("name", "") : "";
}

void save_part(const Part& part, const std::string& path) {
  const std::string text = format_part(part);
  std::ofstream file(path, std::ios::binary);
  if (!(file << text << std::flush)) {
    throw InputError(fmt::format("{}: can't be written: {}", path, std::strerror(errno)));
  }
}

}  // namespace rollfix
