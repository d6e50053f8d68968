#pragma once
// The elements of a DICOM data set in order (PS3.5, 7), without recursion and without copies.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace echocine {

// Ultrasound files nest a few sequences; the library's parser uses a kilobyte of stack for each.
// Our choice.
inline constexpr std::size_t kMaxDicomDepth = 32;

struct DicomSyntax {
  bool explicit_vr = true, big_endian = false;
};

struct DicomElement {
  std::uint32_t tag = 0;  // group in the upper half
  std::size_t depth = 0;  // enclosing sequences
  bool sequence = false;
  std::span<const std::byte> value;  // of sequences and items: empty

  std::string text(std::size_t longest) const;  // without padding
};

class DicomElements {
 public:
  DicomElements(std::span<const std::byte> data, DicomSyntax syntax)
      : data_(data), syntax_(syntax) {}

  // None at the end, or at a break of the structure.
  std::optional<DicomElement> next();

  // The tag of the next element; none at the end.
  std::optional<std::uint32_t> nextTag() const;
  std::size_t position() const { return at_; }
  bool tooDeep() const { return too_deep_; }
  bool lost() const { return lost_; }  // an element extends beyond its container
  // An element's type (PS3.5, 6.2) is not one of the standard's: its end is a guess.
  bool unknownType() const { return unknown_type_; }

 private:
  enum class Kind { sequence, item, fragments };
  struct Level {
    Kind kind;
    std::size_t end;  // of the data, if the length is not given
    bool explicit_vr;
  };

  std::uint32_t number(std::size_t at, std::size_t size) const;
  std::uint32_t tagAt(std::size_t at) const;
  bool explicitHere() const {
    return open_.empty() ? syntax_.explicit_vr : open_.back().explicit_vr;
  }
  void closeEnded();
  bool readLength(DicomElement& e, std::uint32_t& length, bool& sequence, bool& unknown);
  bool startsWithItem(std::uint32_t length) const;
  bool open(Kind kind, std::uint32_t length, bool explicit_vr);
  std::optional<DicomElement> delimiter(DicomElement e, std::uint32_t length);
  std::optional<DicomElement> giveUp();

  std::span<const std::byte> data_;
  DicomSyntax syntax_;
  std::size_t at_ = 0;
  std::vector<Level> open_;
  bool too_deep_ = false, lost_ = false, unknown_type_ = false;
};

}  // namespace echocine
