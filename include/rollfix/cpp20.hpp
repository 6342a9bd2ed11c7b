#pragma once

// Every header reaches this one first, so that an older compiler says one sentence and stops: only a file that is not
// there stops it at once, after an #error it would go on with a page of others.
#if defined(_MSVC_LANG) ? _MSVC_LANG <= 201703L : __cplusplus <= 201703L
#include "rollfix needs C++20, found an older standard: compile with -std=c++20"
#endif
