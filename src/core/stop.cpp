#include "core/stop.h"

#include <utility>

namespace echocine {

namespace {

thread_local const StopQuestion* this_question = nullptr;

}  // namespace

StopScope::StopScope(const StopQuestion* question)
    : before_(std::exchange(this_question, question)) {}

StopScope::~StopScope() {
  this_question = before_;
}

const StopQuestion* stopQuestion() {
  return this_question;
}

void stoppable(const StopQuestion& wanted, const std::function<void()>& body) {
  const StopScope asked(&wanted);
  body();
}

void unstoppable(const std::function<void()>& body) {
  const StopScope unasked(nullptr);
  body();
}

void checkpoint() {
  if (this_question != nullptr && (*this_question)()) throw Stopped();
}

}  // namespace echocine
