#pragma once

namespace echocine {

extern const char* const kBuiltInMedia;  // the text of data/media.toml

}  // namespace echocine
