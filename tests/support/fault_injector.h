#pragma once
// Where the built tests/support/fault_injector.cpp is.

namespace echocine::support {

extern const char* const kFaultInjector;

}  // namespace echocine::support
