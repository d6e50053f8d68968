#include "page/assets.h"

#include <algorithm>

#include "core/check.h"

namespace echocine {

std::string_view pageAsset(std::string_view name) {
  const Asset* end = kAssets + kAssetCount;
  const Asset* found =
      std::find_if(kAssets, end, [&](const Asset& asset) { return asset.name == name; });
  CHECK_LT(found - kAssets, static_cast<std::ptrdiff_t>(kAssetCount));
  return {found->begin, static_cast<std::size_t>(found->end - found->begin)};
}

}  // namespace echocine
