#pragma once
// The machine that was timed.

#include <string>

namespace echocine {

std::string processorName();  // "unknown" where the system does not say
int processorCores();

}  // namespace echocine
