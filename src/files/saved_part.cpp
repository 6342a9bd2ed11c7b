#include "rollfix/files.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "files/byte_stream.hpp"
#include "part_record.hpp"
#include "rollfix/error.hpp"

namespace rollfix {
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
