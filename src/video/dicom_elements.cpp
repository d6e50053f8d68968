#include "video/dicom_elements.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace echocine {

namespace {

constexpr std::uint32_t kUndefined = 0xffffffff;
constexpr std::uint32_t kItem = 0xfffee000, kItemEnd = 0xfffee00d, kSequenceEnd = 0xfffee0dd;
constexpr std::uint32_t kPixelData = 0x7fe00010;

// PS3.5 7.1.2: these have two bytes of nothing and a length of four; the others a length of two.
bool hasLongLength(std::string_view vr) {
  constexpr std::array<std::string_view, 13> kLong{"OB", "OD", "OF", "OL", "OV", "OW", "SQ",
                                                   "SV", "UC", "UN", "UR", "UT", "UV"};
  return std::find(kLong.begin(), kLong.end(), vr) != kLong.end();
}

bool hasShortLength(std::string_view vr) {
  constexpr std::array<std::string_view, 21> kShort{"AE", "AS", "AT", "CS", "DA", "DS", "DT",
                                                    "FD", "FL", "IS", "LO", "LT", "PN", "SH",
                                                    "SL", "SS", "ST", "TM", "UI", "UL", "US"};
  return std::find(kShort.begin(), kShort.end(), vr) != kShort.end();
}

}  // namespace

std::string DicomElement::text(std::size_t longest) const {
  std::string text(reinterpret_cast<const char*>(value.data()), std::min(value.size(), longest));
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
  return text;
}

std::uint32_t DicomElements::number(std::size_t at, std::size_t size) const {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t shift = 8 * (syntax_.big_endian ? size - 1 - i : i);
    value |= static_cast<std::uint32_t>(data_[at + i]) << shift;
  }
  return value;
}

std::uint32_t DicomElements::tagAt(std::size_t at) const {
  return number(at, 2) << 16 | number(at + 2, 2);
}

std::optional<std::uint32_t> DicomElements::nextTag() const {
  if (data_.size() - at_ < 4) return std::nullopt;
  return tagAt(at_);
}

void DicomElements::closeEnded() {
  while (!open_.empty() && at_ >= open_.back().end) open_.pop_back();
}

std::optional<DicomElement> DicomElements::giveUp() {
  lost_ = true;
  at_ = data_.size();
  return std::nullopt;
}

// Without a type only the library's dictionary knows a sequence; to us it is one when it looks so.
bool DicomElements::startsWithItem(std::uint32_t length) const {
  return length >= 8 && data_.size() - at_ >= 8 && tagAt(at_) == kItem;
}

// Tag and length of the element at the place, which moves on to its value.
bool DicomElements::readLength(DicomElement& e, std::uint32_t& length, bool& sequence,
                               bool& unknown) {
  if (data_.size() - at_ < 8) return false;
  e.tag = tagAt(at_);
  if (!explicitHere() || e.tag >> 16 == 0xfffe) {
    length = number(at_ + 4, 4);
    at_ += 8;
    sequence = e.tag != kPixelData && (length == kUndefined || startsWithItem(length));
    return true;
  }
  const std::string_view vr(reinterpret_cast<const char*>(data_.data()) + at_ + 4, 2);
  sequence = vr == "SQ";
  if (hasShortLength(vr)) {
    length = number(at_ + 6, 2);
    at_ += 8;
    return true;
  }
  unknown_type_ = !hasLongLength(vr);
  if (unknown_type_ || data_.size() - at_ < 12) return false;
  length = number(at_ + 8, 4);
  at_ += 12;
  // PS3.5 6.2.2: of undefined length it is a sequence with implicit types.
  unknown = vr == "UN" && (length == kUndefined || startsWithItem(length));
  sequence = sequence || unknown;
  return true;
}

bool DicomElements::open(Kind kind, std::uint32_t length, bool explicit_vr) {
  const std::size_t around = open_.empty() ? data_.size() : open_.back().end;
  // A file that is cut short ends its sequences too; the library says what is missing.
  const std::size_t end = length == kUndefined ? around : std::min(around, at_ + length);
  open_.push_back({kind, end, explicit_vr});
  const auto sequences = std::count_if(open_.begin(), open_.end(),
                                       [](const Level& l) { return l.kind == Kind::sequence; });
  too_deep_ = too_deep_ || static_cast<std::size_t>(sequences) > kMaxDicomDepth;
  return !too_deep_;
}

// Items and the ends of what has no length.
std::optional<DicomElement> DicomElements::delimiter(DicomElement e, std::uint32_t length) {
  const bool in_fragments = !open_.empty() && open_.back().kind == Kind::fragments;
  if (e.tag == kItem && in_fragments) {
    if (length > data_.size() - at_) return giveUp();
    e.depth = open_.size() - 1;
    e.value = data_.subspan(at_, length);
    at_ += length;
    return e;
  }
  if (e.tag == kItem) {
    if (!open(Kind::item, length, explicitHere())) return std::nullopt;
    return e;
  }
  const Kind closes = e.tag == kItemEnd ? Kind::item : Kind::sequence;
  if (!open_.empty() && (open_.back().kind == closes || in_fragments)) open_.pop_back();
  return e;
}

std::optional<DicomElement> DicomElements::next() {
  closeEnded();
  if (too_deep_ || at_ >= data_.size()) return std::nullopt;
  DicomElement e;
  e.depth = open_.size();
  std::uint32_t length = 0;
  bool sequence = false, unknown = false;
  const std::size_t start = at_;
  if (!readLength(e, length, sequence, unknown)) return giveUp();
  if (e.tag == kItem || e.tag == kItemEnd || e.tag == kSequenceEnd) return delimiter(e, length);
  if (e.tag == kPixelData && length == kUndefined) {
    open_.push_back({Kind::fragments, data_.size(), explicitHere()});
    return e;
  }
  e.sequence = sequence;
  if (sequence) {
    if (!open(Kind::sequence, length, explicitHere() && !unknown)) return std::nullopt;
    return e;
  }
  if (length > data_.size() - at_) {
    // The last element may be cut short: the reader reports how much is missing.
    if (!open_.empty() || start == 0) return giveUp();
    length = static_cast<std::uint32_t>(data_.size() - at_);
  }
  e.value = data_.subspan(at_, length);
  at_ += length;
  return e;
}

}  // namespace echocine
