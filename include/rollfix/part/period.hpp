#pragma once

#include "rollfix/part/boundary.hpp"
