// The live page as a server beside the interpreter.

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <future>
#include <thread>

#include "live/live.h"
#include "python/bindings.h"
#include "python/fork_guard.h"
#include "python/meshes.h"
#include "python/unlocked.h"

namespace echocine::python {

namespace {

// Its thread uses no Python object.
class LiveServer {
 public:
  // Returns once the page is served. Throws what serveLive() throws.
  LiveServer(const std::string& text, const std::filesystem::path& file, const Meshes* meshes,
             const std::filesystem::path& record, int port, int threads) {
    beginWork();
    live::LiveOptions options{.scene = file,
                              .text = text,
                              .meshes = {},
                              .heart_truth = {},
                              .record = record,
                              .port = port,
                              .threads = threads,
                              .framed = true};
    if (meshes) {
      options.meshes = meshes->named;
      options.heart_truth = meshes->heart_truth;
    }
    std::promise<std::string> listening;
    std::future<std::string> heard = listening.get_future();
    thread_ = std::thread([this, options, &listening] { serve(options, listening); });
    while (!waitFor(heard))
      if (PyErr_CheckSignals() != 0) {
        close();
        throw py::error_already_set();
      }
    try {
      link_ = heard.get();
    } catch (...) {
      close();
      throw;
    }
  }
  ~LiveServer() { close(); }

  const std::string& link() const { return link_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  bool running() const { return !ended_; }

  void close() {
    stop_ = true;
    if (!thread_.joinable()) return;
    const Unlocked released;
    thread_.join();
  }

 private:
  // Without the interpreter's lock; false after a while.
  static bool waitFor(const std::future<std::string>& heard) {
    const Unlocked released;
    return heard.wait_for(std::chrono::milliseconds(50)) == std::future_status::ready;
  }

  // `listening` lives until it has its value.
  void serve(const live::LiveOptions& options, std::promise<std::string>& listening) {
    bool listens = false;
    try {
      live::serveLive(
          options,
          [&](const std::string& link) {
            listens = true;
            listening.set_value(link);
          },
          [this](const std::string& line) { warnings_.push_back(line); },
          [this] { return stop_ || isEnding(); });
    } catch (...) {
      if (!listens) listening.set_exception(std::current_exception());
    }
    ended_ = true;
  }

  std::thread thread_;
  std::string link_;
  std::vector<std::string> warnings_;  // complete before the link is known
  std::atomic<bool> stop_{false}, ended_{false};
};

}  // namespace

void bindLive(py::module_& module) {
  py::class_<LiveServer>(module, "LiveServer", "The page of `echocine live`, served by a thread.")
      .def(py::init<const std::string&, const std::filesystem::path&, const Meshes*,
                    const std::filesystem::path&, int, int>(),
           py::arg("text"), py::arg("file"), py::arg("meshes"), py::arg("record"), py::arg("port"),
           py::arg("threads"))
      .def_property_readonly("link", &LiveServer::link)
      .def_property_readonly("warnings", &LiveServer::warnings)
      .def_property_readonly("running", &LiveServer::running)
      .def("close", &LiveServer::close);
}

}  // namespace echocine::python
