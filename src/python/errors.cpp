// What C++ throws, as the package's exceptions.

#include "core/error.h"
#include "core/out_of_memory.h"
#include "python/bindings.h"

namespace echocine::python {

namespace {

// The class of the package's Python part, which takes file, line and key out of the message.
void raise(const char* name, const char* what) {
  const py::object type = py::module_::import("echocine._errors").attr(name);
  PyErr_SetObject(type.ptr(), type(what).ptr());
}

}  // namespace

void bindErrors(py::module_&) {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const SceneError& error) {
      raise("SceneError", error.what());
    } catch (const JobError& error) {
      raise("JobError", error.what());
    }
  });
}

}  // namespace echocine::python
