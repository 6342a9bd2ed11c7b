#pragma once

#include "documents/json_output.hpp"
#include "rollfix/identify.hpp"

namespace rollfix {

/// "rollfix/identify/1".
Json identified_document(const Catalog& catalog, const Identified& found);

}  // namespace rollfix
