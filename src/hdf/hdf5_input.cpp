#include "hdf/hdf5_input.h"

#include <fmt/format.h>

#include <cstring>
#include <fstream>

#include "core/error.h"
#include "core/limited_child.h"
#include "hdf/hdf5_child.h"
#include "hdf/hdf5_library.h"

namespace echocine {

namespace {

constexpr std::size_t kMemory = std::size_t{1} << 30;  // beyond the values themselves
constexpr double kSecondsPerByte = 1 / 20e6, kSeconds = 10;

// The parent's part: what the child says is checked like any input.
class Hdf5Answers {
 public:
  Hdf5Answers(const std::string& name, std::span<const std::byte> bytes)
      : name_(name), rest_(bytes) {}

  Hdf5Values next(const Hdf5Query& query) {
    Hdf5Sign sign{};
    take(&sign, 1);
    Hdf5Values out;
    if (sign == Hdf5Sign::absent) return out;
    out.found = true;
    if (sign == Hdf5Sign::refused)
      throw SceneError(fmt::format("{}: {}", name_, takeText(kMostHdf5Reason)));
    if (sign == Hdf5Sign::text) {
      out.values = takeText(query.most_values);
    } else if (sign == Hdf5Sign::bytes || sign == Hdf5Sign::floats) {
      const std::size_t count = takeShape(query, out.shape);
      if (sign == Hdf5Sign::bytes)
        takeValues(out.values.emplace<std::vector<std::uint8_t>>(), count);
      else
        takeValues(out.values.emplace<std::vector<float>>(), count);
    } else {
      fail();
    }
    return out;
  }

 private:
  [[noreturn]] void fail() const {
    throw SceneError(fmt::format("{}: is damaged: HDF5 could not read it", name_));
  }
  void take(void* to, std::size_t size) {
    if (rest_.size() < size) fail();
    std::memcpy(to, rest_.data(), size);
    rest_ = rest_.subspan(size);
  }
  std::size_t takeShape(const Hdf5Query& query, std::vector<std::size_t>& shape) {
    std::size_t rank = 0, count = 1;
    take(&rank, sizeof rank);
    if (rank > kMostHdf5Rank) fail();
    shape.resize(rank);
    for (std::size_t& side : shape) {
      take(&side, sizeof side);
      if (side == 0 || side > query.most_values / count) fail();
      count *= side;
    }
    return count;
  }
  template <typename T>
  void takeValues(std::vector<T>& values, std::size_t count) {
    if (rest_.size() / sizeof(T) < count) fail();
    values.resize(count);
    take(values.data(), count * sizeof(T));
  }
  std::string takeText(std::size_t most) {
    std::size_t size = 0;
    take(&size, sizeof size);
    if (size > most || size > rest_.size()) fail();
    std::string text(size, '\0');
    take(text.data(), size);
    return text;
  }

  std::string name_;
  std::span<const std::byte> rest_;
};

const char* faultOf(ChildEnd end) {
  switch (end) {
    case ChildEnd::out_of_time:
      return "HDF5 finds no end in it";
    case ChildEnd::out_of_memory:
      return "HDF5 needs too much memory for it";
    case ChildEnd::too_long:
    case ChildEnd::crashed:
    case ChildEnd::done:
      break;
  }
  return "HDF5 could not read it";
}

}  // namespace

bool looksLikeHdf5(const std::filesystem::path& file) {
  constexpr char kSignature[] = "\x89HDF\r\n\x1a\n";
  char start[8] = {};
  std::error_code failed;
  return std::filesystem::is_regular_file(file, failed) &&
         std::ifstream(file, std::ios::binary).read(start, sizeof start) &&
         std::memcmp(start, kSignature, sizeof start) == 0;
}

std::vector<Hdf5Values> readHdf5(const std::filesystem::path& file,
                                 std::span<const Hdf5Query> queries) {
  std::error_code failed;
  const std::uintmax_t size = std::filesystem::file_size(file, failed);
  if (failed || !std::filesystem::is_regular_file(file, failed))
    throw SceneError(fmt::format("{}: cannot be read", file.string()));
  if (size > kMostHdf5Bytes)
    throw SceneError(fmt::format("{}: larger than {} bytes; give a shorter part of it",
                                 file.string(), kMostHdf5Bytes));
  std::size_t values = 0;
  for (const Hdf5Query& query : queries) values += query.most_values;
  ChildLimits limits;
  limits.cpu_s = kSeconds + kSecondsPerByte * static_cast<double>(size);
  limits.answer_bytes = sizeof(float) * values + (std::size_t{1} << 16);
  limits.memory_bytes = kMemory + sizeof(float) * values;
  ChildAnswer answer;
  {
    const std::lock_guard lock(hdf5Mutex());  // so that the child does not inherit it half-way
    answer =
        runInChild(limits, [&](const ChildWriter& write) { answerHdf5(file, queries, write); });
  }
  if (answer.end != ChildEnd::done)
    throw SceneError(fmt::format("{}: is damaged: {}", file.string(), faultOf(answer.end)));
  Hdf5Answers answers(file.string(), answer.bytes);
  std::vector<Hdf5Values> out;
  for (const Hdf5Query& query : queries) out.push_back(answers.next(query));
  return out;
}

}  // namespace echocine
