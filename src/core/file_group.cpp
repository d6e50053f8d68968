#include "core/file_group.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <set>
#include <utility>

#include "core/file.h"
#include "core/file_target.h"

namespace echocine {

namespace {

// Our choices: the frames that a kill may cost, and how long they may wait for each other.
constexpr std::size_t kMostFiles = 32;
constexpr std::chrono::seconds kLongestWait{2};
// Up to this number, files are flushed one by one: a flush of the file system also writes the data
// of other programs.
constexpr std::size_t kFewFiles = 2;

// A folder may be a link to another file system.
dev_t deviceOf(const std::filesystem::path& folder) {
  struct stat status {};
  return ::stat(folder.c_str(), &status) == 0 ? status.st_dev : 0;
}

void syncOne(const std::string& part, const std::filesystem::path& path) {
  const int descriptor = ::open(part.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor < 0) failWriting(path, errno);
  const int reason = syncFile(descriptor) ? 0 : errno;
  ::close(descriptor);
  if (reason != 0) failWriting(path, reason);
}

}  // namespace

PendingFile::PendingFile(std::filesystem::path path, std::span<const std::byte> bytes)
    : path_(std::move(path)), part_(writePart(path_, bytes)) {}

PendingFile::~PendingFile() {
  discard();
}

PendingFile::PendingFile(PendingFile&& other) noexcept
    : path_(std::move(other.path_)), part_(std::exchange(other.part_, {})) {}

PendingFile& PendingFile::operator=(PendingFile&& other) noexcept {
  discard();
  path_ = std::move(other.path_);
  part_ = std::exchange(other.part_, {});
  return *this;
}

void PendingFile::discard() {
  if (!part_.empty()) ::unlink(part_.c_str());
  part_.clear();
}

void FileGroup::add(PendingFile file) {
  if (file.empty()) return;
  if (files_.empty()) first_added_ = std::chrono::steady_clock::now();
  files_.push_back(std::move(file));
}

bool FileGroup::isDue() const {
  return files_.size() >= kMostFiles ||
         (!files_.empty() && std::chrono::steady_clock::now() - first_added_ >= kLongestWait);
}

void FileGroup::finish() {
  std::vector<PendingFile> files = std::exchange(files_, {});
  std::map<dev_t, std::vector<const PendingFile*>> by_device;
  std::set<std::filesystem::path> folders;
  for (const PendingFile& file : files) {
    by_device[deviceOf(folderOf(file.path_))].push_back(&file);
    folders.insert(folderOf(file.path_));
  }
  for (const auto& [device, members] : by_device)
    if (members.size() > kFewFiles)
      syncAllOf(folderOf(members.front()->path_));
    else
      for (const PendingFile* file : members) syncOne(file->part_, file->path_);
  for (PendingFile& file : files) {
    if (::rename(file.part_.c_str(), file.path_.c_str()) != 0) failWriting(file.path_, errno);
    file.part_.clear();
  }
  for (const std::filesystem::path& folder : folders) syncFolderOf(folder / "file");
}

}  // namespace echocine
