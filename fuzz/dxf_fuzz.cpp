// Any bytes as a DXF file: a drawing or an InputError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "files/formats.hpp"
#include "rollfix/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    rollfix::files::parse_dxf({reinterpret_cast<const char*>(data), size}, "fuzz.dxf");
  } catch (const rollfix::InputError&) {
  }
  return 0;
}
