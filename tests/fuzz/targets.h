#pragma once
// What the fuzzers call, one function per kind of input. Each takes the bytes of a file, feeds them
// to what a user's file goes through, and throws std::logic_error where the program breaks a
// promise: a refusal is a SceneError or a JobError, and what is accepted works.

#include <span>
#include <string_view>

namespace echocine::fuzz {

void scene(std::string_view bytes);  // a scene file
void obj(std::string_view bytes);    // meshes, from the reader to the traced frame
void ply(std::string_view bytes);
void off(std::string_view bytes);
void stl(std::string_view bytes);
void npz(std::string_view bytes);      // all keyframes in one NumPy file
void lid(std::string_view bytes);      // an OBJ mesh and its lid, one after the other
void exr(std::string_view bytes);      // a frame that an earlier run left behind
void video(std::string_view bytes);    // a loop to compare with
void ecg(std::string_view bytes);      // pictures with an ECG, drawn from the bytes
void folder(std::string_view bytes);   // the manifest of a render's folder
void record(std::string_view bytes);   // what a dataset notes of a heart
void spec(std::string_view bytes);     // the spec of a dataset
void request(std::string_view bytes);  // what a client sends to a live session
void zarr(std::string_view bytes);     // an array of a zarr store: metadata and a chunk

struct Target {
  const char* name;  // of its corpus too
  void (*run)(std::string_view);
};
inline constexpr Target kTargets[] = {
    {"scene", scene},   {"obj", obj},       {"ply", ply},   {"off", off},         {"stl", stl},
    {"lid", lid},       {"npz", npz},       {"exr", exr},   {"video", video},     {"ecg", ecg},
    {"folder", folder}, {"record", record}, {"spec", spec}, {"request", request}, {"zarr", zarr}};

}  // namespace echocine::fuzz
