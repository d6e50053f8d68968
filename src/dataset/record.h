#pragma once
// What is noted of a finished heart: one small file, from which the tables of all are made.

#include "dataset/layout.h"

namespace echocine::dataset {

// Everything but files: numbers of the heart and of each loop, and all that was drawn.
Json recordOf(const Spec& spec, const Heart& heart);

// Of a heart that could not be made.
Json failureOf(const Spec& spec, int heart, const std::string& reason);
bool isFailure(const Json& record);

// As JSON has it.
Json jsonOf(const Values& values);

}  // namespace echocine::dataset
