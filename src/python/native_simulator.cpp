#include "python/native_simulator.h"

#include <fmt/format.h>

#include "frame/plan_loop.h"
#include "motion/cycle/cardiac_clock.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/frame.h"
#include "python/job.h"
#include "python/native_scene.h"

namespace echocine::python {

namespace {

// Frames on their way into a caller's memory; their own is used again.
class Scratch {
 public:
  explicit Scratch(NativeSimulator& simulator) : simulator_(simulator) {
    const std::lock_guard lock(simulator_.mutex);
    if (simulator_.scratch.empty()) return;
    frame = std::move(simulator_.scratch.back());
    simulator_.scratch.pop_back();
  }
  ~Scratch() {
    const std::lock_guard lock(simulator_.mutex);
    simulator_.scratch.push_back(std::move(frame));
  }
  std::unique_ptr<Frame> frame = std::make_unique<Frame>();

 private:
  NativeSimulator& simulator_;
};

// Marks a frame as busy while it is filled.
class Busy {
 public:
  explicit Busy(NativeFrame& native) : native_(native) {
    if (native.busy.exchange(true))
      throw py::value_error(
          "out: another thread is filling this frame, accepted: a frame of its own");
  }
  ~Busy() { native_.busy = false; }

 private:
  NativeFrame& native_;
};

std::shared_ptr<NativeFrame> newFrame(NativeSimulator& simulator, double time_s) {
  auto made = std::make_shared<NativeFrame>();
  made->width = simulator.simulator.scene().output.width;
  made->height = simulator.simulator.scene().output.height;
  made->maker = simulator.number;
  runHere([&] { simulator.simulator.frame(time_s, made->frame); });
  return made;
}

void checkMaker(const char* argument, const NativeSimulator& simulator, const NativeFrame& frame) {
  if (frame.maker != simulator.number)
    throw py::value_error(fmt::format(
        "{}: the frame is of another simulator, accepted: a frame of this one", argument));
}

void fillFrame(NativeSimulator& simulator, double time_s, NativeFrame& out) {
  checkMaker("out", simulator, out);
  const Busy busy(out);
  Scratch scratch(simulator);
  runHere([&] {
    simulator.simulator.frame(time_s, *scratch.frame);
    copyInPlace(*scratch.frame, out.frame);
  });
  moveRest(*scratch.frame, out.frame);
}

void fillArrays(NativeSimulator& simulator, double time_s, const py::dict& out) {
  const std::vector<OutArray> arrays = checkedOutArrays(out, simulator.simulator.scene());
  runHere([&] {
    Scratch scratch(simulator);
    simulator.simulator.frame(time_s, *scratch.frame);
    copyInto(*scratch.frame, arrays);
  });
}

std::shared_ptr<NativeSimulator> make(const NativeScene& scene) {
  std::shared_ptr<NativeSimulator> made;
  runJob(py::none(), [&](const Monitor& monitor) {
    made = std::make_shared<NativeSimulator>(scene.scene);
    passWarnings(made->simulator, monitor);
    if (scene.scene.accuracy.tolerance_db)
      monitor.warn("accuracy.tolerance_db: is not used by a simulator, but by render and plan");
  });
  return made;
}

py::array times(const NativeSimulator& native) {
  const CardiacClock& clock = native.simulator.cardiacClock();
  std::vector<double> times_s;
  for (int i = 0; i < clock.frameCount(); ++i) times_s.push_back(clock.at(i).time_s);
  return copyOf(times_s);
}

py::list contoursOfFrame(const NativeSimulator& native, const NativeFrame& frame) {
  checkMaker("contours: frame", native, frame);
  if (!frame.frame.truth || !native.simulator.scene().truth.contours)
    throw py::value_error(
        "contours: the scene does not request it, accepted: truth.write with \"contours\"");
  return contoursOf(frame.frame.truth->contours, native.simulator.scene());
}

}  // namespace

void bindSimulator(py::module_& module) {
  py::class_<NativeSimulator, std::shared_ptr<NativeSimulator>>(module, "Simulator",
                                                                "Renders frames of a scene.")
      .def(py::init(&make), py::arg("scene"))
      .def("frame", &newFrame, py::arg("time_s"), "A new frame at an instant of the loop, s.")
      .def("fill_frame", &fillFrame, py::arg("time_s"), py::arg("out"),
           "The same into an earlier frame.")
      .def("fill_arrays", &fillArrays, py::arg("time_s"), py::arg("out"),
           "The same into arrays by name.")
      .def("contours", &contoursOfFrame, py::arg("frame"), "A frame's contours.")
      .def_property_readonly("times_s", &times, "(T,) float64: the loop's frames, s.")
      .def_property_readonly(
          "plan", [](const NativeSimulator& n) { return planSummary(n.simulator.plan()); },
          "One line: tracer, enabled and disabled effects.")
      .def_property_readonly(
          "reference_intensity",
          [](const NativeSimulator& n) {
            double white = 0;
            runHere([&] { white = n.simulator.referenceIntensity(); });
            return white;
          },
          "White of the log compression, relative to the transmitted.");
}

}  // namespace echocine::python
