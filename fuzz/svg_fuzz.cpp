// Whatever bytes an SVG file holds, reading it ends with a drawing or an InputError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "files/formats.hpp"
#include "rollfix/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    rollfix::files::parse_svg({reinterpret_cast<const char*>(data), size}, "fuzz.svg");
  } catch (const rollfix::InputError&) {
    // what bad input should give
  }
  return 0;
}
