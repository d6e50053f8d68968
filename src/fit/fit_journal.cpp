#include "fit/fit_journal.h"

#include <fmt/format.h>

#include <iterator>

#include "core/digest.h"
#include "core/error.h"
#include "fit/packed_bytes.h"

namespace echocine::fit {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHeadSize = 2 * Digest::kDigits;

// A record: its size, its content, the digest of its content.
std::vector<std::byte> packed(const std::string& key, const PoseFound& found) {
  PackedBytes content;
  content.putText(key);
  content.put(found.pose);
  content.put(found.terms);
  content.put(found.discrepancy);
  content.put(found.confidence);
  content.put(found.at_limit);
  content.put(static_cast<std::uint64_t>(found.rivals.size()));
  for (const auto& [pose, value] : found.rivals) {
    content.put(pose);
    content.put(value);
  }
  const std::string digest = digestOfBytes(content.all());
  PackedBytes record;
  record.putAll(std::vector<std::byte>(content.all().begin(), content.all().end()));
  for (const char c : digest) record.put(c);
  return {record.all().begin(), record.all().end()};
}

std::pair<std::string, PoseFound> unpacked(std::span<const std::byte> content) {
  UnpackedBytes in(content);
  std::pair<std::string, PoseFound> out;
  out.first = in.getText();
  PoseFound& found = out.second;
  found.pose = in.get<FitPose>();
  found.terms = in.get<FitTerms>();
  found.discrepancy = in.get<double>();
  found.confidence = in.get<double>();
  found.at_limit = in.get<bool>();
  const auto rivals = in.get<std::uint64_t>();
  for (std::uint64_t i = 0; in.good() && i < rivals; ++i) {
    const auto pose = in.get<FitPose>();
    found.rivals.emplace_back(pose, in.get<double>());
  }
  return out;
}

}  // namespace

FitJournal::FitJournal(fs::path file, const std::string& fit) : file_(std::move(file)), fit_(fit) {
  std::error_code error;
  if (fs::exists(file_, error)) read();
}

void FitJournal::read() {
  lock_.emplace(file_.parent_path() / kLock);
  std::ifstream in(file_, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) throw JobError(fmt::format("{}: cannot be read", file_.string()));
  const auto bytes = std::as_bytes(std::span(text));
  std::size_t good = 0;
  if (bytes.size() >= kHeadSize && text.substr(Digest::kDigits, Digest::kDigits) ==
                                       digestOfBytes(bytes.first(Digest::kDigits))) {
    if (text.substr(0, Digest::kDigits) != fit_)
      throw SceneError(fmt::format(
          "{}: is of a fit of other loops, options or another version; remove the folder, or give "
          "the same command to resume",
          file_.string()));
    good = kHeadSize;
  }
  while (good > 0) {
    UnpackedBytes next(bytes.subspan(good));
    const std::vector<std::byte> content = next.getAll<std::byte>();
    const std::size_t end = good + sizeof(std::uint64_t) + content.size() + Digest::kDigits;
    if (!next.good() || content.empty() || end > bytes.size() ||
        text.substr(end - Digest::kDigits, Digest::kDigits) != digestOfBytes(content))
      break;
    records_.insert(unpacked(content));
    good = end;
  }
  std::error_code error;
  fs::resize_file(file_, good, error);
  if (error)
    throw JobError(fmt::format("{}: cannot be written: {}", file_.string(), error.message()));
}

std::string FitJournal::keyOf(const std::string& stage, std::size_t view,
                              const std::vector<double>& values, const PlaneTilt& tilt,
                              const FitPose* from) {
  PackedBytes key;
  key.putText(stage);
  key.put(static_cast<std::uint64_t>(view));
  key.putAll(values);
  key.put(tilt.tilt_rad);
  key.put(tilt.rotate_rad);
  if (from != nullptr)
    for (const double number : {from->shift_x_m, from->shift_z_m, from->turn_rad, from->scale,
                                static_cast<double>(from->lag), from->systole})
      key.put(number);
  return digestOfBytes(key.all());
}

std::optional<PoseFound> FitJournal::find(const std::string& key) const {
  const std::scoped_lock locked(mutex_);
  const auto at = records_.find(key);
  return at == records_.end() ? std::nullopt : std::optional(at->second);
}

void FitJournal::append(std::span<const std::byte> bytes) {
  out_.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

void FitJournal::add(const std::string& key, const PoseFound& found) {
  const std::scoped_lock locked(mutex_);
  if (finished_ || !records_.emplace(key, found).second) return;
  if (!lock_) lock_.emplace(file_.parent_path() / kLock);
  if (!out_.is_open()) {
    out_.open(file_, std::ios::binary | std::ios::app);
    if (out_.tellp() == std::ofstream::pos_type(0)) {
      const auto fit = std::as_bytes(std::span(fit_));
      const std::string check = digestOfBytes(fit);
      append(fit);
      append(std::as_bytes(std::span(check)));
    }
  }
  append(packed(key, found));
  out_.flush();
  if (!out_) throw JobError(fmt::format("{}: cannot be written", file_.string()));
}

std::size_t FitJournal::size() const {
  const std::scoped_lock locked(mutex_);
  return records_.size();
}

void FitJournal::finish() {
  const std::scoped_lock locked(mutex_);
  finished_ = true;
  out_.close();
  std::error_code error;
  std::filesystem::remove(file_, error);
}

}  // namespace echocine::fit
