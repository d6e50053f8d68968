#include <nlohmann/json.hpp>

#include "promises.h"
#include "targets.h"
#include "zarr/zarr_input.h"

namespace echocine::fuzz {

// Metadata, and behind a zero byte the one chunk file of a store that has it.
void zarr(std::string_view bytes) {
  const std::size_t end = bytes.find('\0');
  const std::string_view metadata = bytes.substr(0, end),
                         chunk = end == std::string_view::npos ? "" : bytes.substr(end + 1);
  constexpr std::size_t kMost = 1 << 16;
  for (const int version : {2, 3}) {
    const std::filesystem::path store = scratchFolder() / (version == 2 ? "two" : "three");
    std::filesystem::create_directories(store / "a/c");
    const auto put = [&](const char* name, std::string_view text) {
      std::ofstream(store / name, std::ios::binary)
          .write(text.data(), static_cast<std::streamsize>(text.size()));
    };
    put(version == 2 ? ".zgroup" : "zarr.json",
        version == 2 ? R"({"zarr_format": 2})" : R"({"zarr_format": 3})");
    put(version == 2 ? "a/.zarray" : "a/zarr.json", metadata);
    for (const char* const key : {"a/0", "a/0.0", "a/0.0.0", "a/c/0"}) put(key, chunk);
    accepts([&] {
      const ZarrInput input(store);
      const ZarrLayout layout = input.layout("a");
      promise(layout.shape.size() == layout.chunk.size(), "chunks of other axes");
      promise(layout.values() > 0 && layout.values() <= kMostZarrValues, "an array beyond limits");
      promise(layout.chunkValues() * layout.valueBytes() <= kMostZarrChunkBytes,
              "a chunk beyond limits");
      if (layout.chunkValues() > kMost) return;  // memory that the limits allow
      const ZarrValues<double> read = input.numbers("a", kMost);
      promise(read.values.size() == layout.values(), "values of another shape");
    });
  }
}

}  // namespace echocine::fuzz
