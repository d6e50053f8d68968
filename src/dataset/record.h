#pragma once
// The record of a finished heart: a small file, the source of all tables.

#include "dataset/layout.h"

namespace echocine::dataset {

// Everything except files: numbers of the heart and of each loop, and all drawn values.
Json recordOf(const Spec& spec, const Heart& heart);

// Hearts that must not be separated in a cross-validation: one parametric heart, or all draws of
// one scene.
std::string groupOf(const Json& record);

// Record of a heart whose rendering failed.
Json failureOf(const Spec& spec, int heart, const std::string& reason);
bool isFailure(const Json& record);

// The ejection fraction of two volumes, percent; 0 without a volume.
double ejectedPercent(double ed_ml, double es_ml);

// As JSON.
Json jsonOf(const Values& values);
Json marksJson(const std::map<std::string, FileMark>& files);  // a record's "files"

}  // namespace echocine::dataset
