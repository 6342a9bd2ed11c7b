#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "rollfix/touch.hpp"

namespace rollfix::touch {

/// How a milling controller reports where its probe has touched.
enum class ProbeReport {
  grbl,       // lines "[PRB:12.300,4.500,-1.000:1]" among others; 1: it touched, 0: it did not
  linux_cnc,  // rows "x y z a b c u v w", between PROBEOPEN and PROBECLOSE
};

/// What of it a text is; none: something else.
std::optional<ProbeReport> probe_report(std::string_view text);

/// A touch for each place. Throws InputError, naming the line.
TouchTable parse_probe_report(ProbeReport report, std::string_view text, const std::string& name,
                              const TouchTableOptions& options);

}  // namespace rollfix::touch
