#pragma once

#include <string>

// Where this checkout is and the program that was built of it. Only paths.cpp is compiled with these paths: what else
// is compiled is the same in every checkout, and a compiler cache finds it there.
extern const char* const kCheckout;
extern const char* const kProgram;

/// A file of this checkout: checked_out("examples/bracket.dxf").
inline std::string checked_out(const std::string& file) { return std::string(kCheckout) + "/" + file; }
