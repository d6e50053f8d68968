#pragma once
// Compression by zlib, with deterministic bytes.

#include <cstddef>
#include <span>
#include <vector>

#include "output/npy.h"

namespace echocine::dataset {

// A gzip file (RFC 1952) without a name and with time 0.
std::vector<std::byte> gzipped(std::span<const std::byte> bytes);

// The format of numpy.savez_compressed: a zip with deflated arrays. Throws JobError from 4 GiB on.
std::vector<std::byte> compressedNpz(std::span<const NamedArray> arrays);

}  // namespace echocine::dataset
