#include "paths.hpp"

const char* const kCheckout = ROLLFIX_SOURCE_DIR;
const char* const kProgram = ROLLFIX_PROGRAM;
