#pragma once
// The layout of EchoXFlow (github.com/Ahus-AIM/EchoXFlow, commit b782e0a4): a catalogue and a zarr
// store per recording.

#include <filesystem>
#include <string>

#include "archive/beam_loop.h"

namespace echocine {

// Throws SceneError for what writeEchoXFlow() refuses, before a loop is rendered, and JobError if
// the root takes no files. An empty name is one that follows from the loop.
void checkEchoXFlow(const Scene& scene, const std::filesystem::path& root, const std::string& exam,
                    const std::string& recording);

// Writes ROOT/EXAM/RECORDING.zarr and its row in ROOT/croissant.json, in which rows of other
// recordings stay. An existing recording of the same names is replaced. Names consist of letters,
// digits, "-" and "_". Throws SceneError for other names, a linear or curvilinear probe, and a
// catalogue that is not one; JobError for a failed write.
void writeEchoXFlow(const BeamLoop& loop, const std::filesystem::path& root,
                    const std::string& exam, const std::string& recording);

}  // namespace echocine
