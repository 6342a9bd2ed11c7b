#pragma once

namespace rollfix {

/// What the record of a reversed curve has before its kind.
inline constexpr const char* kReversedPrefix = "reversed ";

}  // namespace rollfix
