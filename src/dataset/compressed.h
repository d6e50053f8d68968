#pragma once
// Bytes made smaller by zlib, the same bytes for the same input.

#include <cstddef>
#include <span>
#include <vector>

#include "output/npy.h"

namespace echocine::dataset {

// A gzip file (RFC 1952) without a name and with time 0.
std::vector<std::byte> gzipped(std::span<const std::byte> bytes);

// What numpy.savez_compressed writes: a zip whose arrays are deflated. Throws JobError from 4 GiB
// on.
std::vector<std::byte> compressedNpz(std::span<const NamedArray> arrays);

}  // namespace echocine::dataset
