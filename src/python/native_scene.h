#pragma once
// The scene object of Python: the result of the scene reader.

#include <map>
#include <string>

#include "scene/key_log.h"
#include "scene/scene.h"

namespace echocine::python {

struct NativeScene {
  Scene scene;
  std::map<std::string, KeyDefault> absent;  // keys that the text leaves out
};

// The view of a key. Throws SceneError naming the argument.
View viewFrom(const std::string& argument, const std::string& key);

}  // namespace echocine::python
