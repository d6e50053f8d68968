#include "scene/key_log.h"

#include <utility>

namespace echocine {

namespace {

thread_local KeyLog* innermost = nullptr;

}  // namespace

KeyLog::KeyLog() : outer_(std::exchange(innermost, this)) {}

KeyLog::~KeyLog() {
  innermost = outer_;
}

bool KeyLog::wanted() {
  return innermost != nullptr;
}

void KeyLog::note(const std::string& key, KeyDefault value) {
  if (innermost == nullptr) return;
  KeyDefault& noted = innermost->absent_[key];
  if (std::holds_alternative<std::monostate>(noted)) noted = std::move(value);
}

}  // namespace echocine
