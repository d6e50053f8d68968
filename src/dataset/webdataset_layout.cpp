// WebDataset: shards of the native layout's loops, SPLIT/shard-000000.tar. They are packed by the
// merge, from all loops in their order, so however a run was cut into tasks they are the same.

#include <fmt/format.h>

#include <fstream>
#include <memory>
#include <optional>

#include "core/digest.h"
#include "core/error.h"
#include "dataset/layout.h"
#include "dataset/ustar.h"

namespace echocine::dataset {

namespace {

// A sample's members share the name up to the first dot and are in the order of names.
constexpr std::pair<const char*, const char*> kMembers[] = {
    {"avi", "cine.avi"}, {"json", "loop.json"}, {"truth.npz", "truth.npz"}};

struct Member {
  std::string name;  // in the shard
  std::filesystem::path file;
  const Json* noted = nullptr;  // its size and digest
};

std::vector<Member> membersOf(const Json& record, const std::string& id,
                              const std::filesystem::path& folder) {
  std::vector<Member> members;
  for (const auto& [ending, file] : kMembers) {
    const std::string name = fmt::format("native/{}/{}", id, file);
    members.push_back(
        {fmt::format("{}.{}", id, ending), folder / name, &record.at("files").at(name)});
  }
  return members;
}

// A merge has checked sizes only; every byte of a shard is checked here.
std::vector<std::byte> bytesOf(const Member& member) {
  std::vector<std::byte> bytes(member.noted->at("bytes").get<std::size_t>());
  std::ifstream file(member.file, std::ios::binary);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file || digestOfBytes(bytes) != member.noted->at("digest").get<std::string>())
    throw JobError(
        fmt::format("{}: is not as it was written: run the same command again without "
                    "--merge",
                    member.file.string()));
  return bytes;
}

// The shards of one split, one after the other.
class Shards {
 public:
  Shards(Sink& sink, std::string split, std::uint64_t most_bytes)
      : sink_(sink), split_(std::move(split)), most_bytes_(most_bytes) {}

  void add(const std::vector<Member>& members) {
    std::uint64_t bytes = 0;
    for (const Member& member : members)
      bytes += ustarBytes(member.noted->at("bytes").get<std::uint64_t>());
    if (shard_ && shard_->bytes() + bytes > most_bytes_) close();
    if (!shard_) shard_ = std::make_unique<UstarFile>(sink_.place(nameOfShard(count_)));
    for (const Member& member : members) shard_->add(member.name, bytesOf(member));
  }

  // An earlier merge may have left more of them.
  void finish() {
    if (shard_) close();
    std::error_code absent;
    for (int left = count_; std::filesystem::remove(sink_.place(nameOfShard(left)), absent);
         ++left) {
    }
  }

 private:
  std::string nameOfShard(int number) const {
    return fmt::format("webdataset/{}/shard-{:06}.tar", split_, number);
  }
  void close() {
    shard_->finish();
    shard_.reset();
    ++count_;
  }

  Sink& sink_;
  std::string split_;
  std::uint64_t most_bytes_;
  std::unique_ptr<UstarFile> shard_;
  int count_ = 0;
};

void mergeWebdataset(const Spec& spec, std::span<const Json> records, Sink& sink) {
  constexpr std::uint64_t kMega = 1'000'000;
  for (const Split split : {Split::train, Split::val, Split::test}) {
    Shards shards(sink, nameOf(split), static_cast<std::uint64_t>(spec.shard_mb) * kMega);
    for (const Json& record : records) {
      if (record.at("split") != nameOf(split)) continue;
      for (const Json& loop : record.at("loops"))
        shards.add(membersOf(record, loop.at("id").get<std::string>(), sink.folder()));
    }
    shards.finish();
  }
}

}  // namespace

const Layout kWebdataset{"webdataset", nullptr, mergeWebdataset};

}  // namespace echocine::dataset
