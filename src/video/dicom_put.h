#pragma once
// Elements put into a DICOM data set. The value representation is always given, so DCMTK's
// dictionary need not be installed. All throw JobError if the library refuses a value.

#include <dcmtk/config/osconfig.h>
// DCMTK's own order of includes: osconfig.h first.
#include <dcmtk/dcmdata/dctk.h>

#include <string>

namespace echocine::dicom {

void check(const OFCondition& done);

void put(DcmItem& item, const DcmTagKey& key, DcmEVR vr, const std::string& value);
void putShort(DcmItem& item, const DcmTagKey& key, int value);      // US
void putLong(DcmItem& item, const DcmTagKey& key, int value);       // UL
void putSigned(DcmItem& item, const DcmTagKey& key, int value);     // SL
void putDouble(DcmItem& item, const DcmTagKey& key, double value);  // FD

// A new sequence of one item, which is returned.
DcmItem& addItem(DcmItem& to, const DcmTagKey& sequence);

}  // namespace echocine::dicom
