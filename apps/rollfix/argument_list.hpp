#pragma once

#include <string>
#include <vector>

namespace rollfix::app {

/// Makes of an option followed by a negative number one argument: --reading -0.5,1 becomes --reading=-0.5,1, which
/// can't be taken for another option.
std::vector<std::string> with_negative_values_attached(const std::vector<std::string>& arguments);

}  // namespace rollfix::app
