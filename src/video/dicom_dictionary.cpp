#include "video/dicom_dictionary.h"

#include <dcmtk/config/osconfig.h>
// DCMTK's own order of includes: osconfig.h first.
#include <dcmtk/dcmdata/dcdict.h>

#include <cstddef>
#include <cstdlib>
#include <mutex>
#include <new>

namespace echocine {

void loadDicomDictionary() {
  static std::once_flag once;
  std::call_once(once, [] {
    constexpr std::size_t kReserve = std::size_t{8} << 20;  // the dictionary takes 1.7 MB
    void* volatile reserve = std::malloc(kReserve);
    if (reserve == nullptr) throw std::bad_alloc();
    std::free(reserve);
    dcmDataDict.rdlock();
    dcmDataDict.rdunlock();
  });
}

}  // namespace echocine
