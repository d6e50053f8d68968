#pragma once
// The HDF5 layout of zea (github.com/tue-bmd/zea, layout of 2026 with tracks; zea/data/spec.py).

#include <filesystem>
#include <string>

#include "archive/beam_loop.h"

namespace echocine {

// Throws SceneError for what writeZea() refuses, before a loop is rendered, and JobError if the
// file cannot be written. An empty subject is one that follows from the loop.
void checkZea(const std::filesystem::path& file, const std::string& subject);

// Writes one file; an existing one is replaced.
//   tracks/track_0/data/image            values uint8 [T, z, x], coordinates [z, x, 3] m,
//                                        timestamps [T] s, start_time_offset s
//   tracks/track_0/data/tissue_doppler   values float32 m/s, positive towards the probe; the same
//   metadata/ecg, metadata/subject/id, metadata/longitudinal_strain
// Attributes of the root: zea_version "0.1.0", probe_name, description.
// subject: not empty. Throws SceneError, JobError.
void writeZea(const BeamLoop& loop, const std::filesystem::path& file, const std::string& subject);

}  // namespace echocine
