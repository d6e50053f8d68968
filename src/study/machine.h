#pragma once
// The machine that was timed.

#include <string>

namespace echocine {

std::string processorName();  // "unknown" if the system does not report it
int processorCores();

}  // namespace echocine
