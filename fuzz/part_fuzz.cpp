// Saved parts whose checksum fits, whatever else they hold: refused, or parts that can be asked.
#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "files/part_record.hpp"
#include "rollfix/error.hpp"
#include "rollfix/files.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string text(reinterpret_cast<const char*>(data), size);
  const std::string field = "\",\n\"checksum\": \"";
  const std::size_t at = text.rfind(field);
  if (at != std::string::npos) {
    text.resize(at);
    text += field + fmt::format("{:016x}\"}}\n", rollfix::checksum(text));
  }
  try {
    const rollfix::Part part = rollfix::parse_part(text, "fuzz.json");
    part.point(0.3 * part.perimeter());
    part.turning().at(0.7 * part.perimeter());
  } catch (const rollfix::InputError&) {
  }
  return 0;
}
