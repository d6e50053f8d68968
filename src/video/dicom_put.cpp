#include "video/dicom_put.h"

#include <fmt/format.h>

#include <memory>
#include <new>

#include "core/error.h"

namespace echocine::dicom {

void check(const OFCondition& done) {
  if (done == EC_MemoryExhausted) throw std::bad_alloc();
  if (done.bad()) throw JobError(fmt::format("a DICOM header cannot be made: {}", done.text()));
}

void put(DcmItem& item, const DcmTagKey& key, DcmEVR vr, const std::string& value) {
  check(item.putAndInsertString(DcmTag(key, DcmVR(vr)), value.c_str()));
}

void putShort(DcmItem& item, const DcmTagKey& key, int value) {
  check(item.putAndInsertUint16(DcmTag(key, DcmVR(EVR_US)), static_cast<Uint16>(value)));
}

void putLong(DcmItem& item, const DcmTagKey& key, int value) {
  check(item.putAndInsertUint32(DcmTag(key, DcmVR(EVR_UL)), static_cast<Uint32>(value)));
}

void putSigned(DcmItem& item, const DcmTagKey& key, int value) {
  check(item.putAndInsertSint32(DcmTag(key, DcmVR(EVR_SL)), value));
}

void putDouble(DcmItem& item, const DcmTagKey& key, double value) {
  check(item.putAndInsertFloat64(DcmTag(key, DcmVR(EVR_FD)), value));
}

DcmItem& addItem(DcmItem& to, const DcmTagKey& sequence) {
  auto whole = std::make_unique<DcmSequenceOfItems>(DcmTag(sequence, DcmVR(EVR_SQ)));
  auto item = std::make_unique<DcmItem>();
  DcmItem& added = *item;
  check(whole->append(item.get()));
  item.release();  // it is the sequence's now
  check(to.insert(whole.get(), true));
  whole.release();
  return added;
}

}  // namespace echocine::dicom
