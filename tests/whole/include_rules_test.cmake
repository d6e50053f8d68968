# Each third-party library is included in its own folder only, and project headers point one way.
#   cmake -DROOT=<source folder> -P include_rules_test.cmake

set(failures "")

# library pattern -> folders that may include it
set(libraries
  "tbb/=src/core"
  "openssl/=src/core"
  "toml\\+\\+/=src/scene"
  "OpenMesh/=motion"
  "opensubdiv/=motion"
  "embree3/=src/geometry"
  "OpenEXR/|Imath/|Imf=src/output"
  "opencv2/(videoio|imgcodecs)=src/output"
  "opencv2/=src/signal,src/output,src/compare"
  "dcmtk/=src/compare"
  "(libav|libswscale)=src/output,src/compare"
  "CLI/=src/cli")

# folder -> first parts of the project includes it may use. A header may use core, scene and the stage just
# before it; a source file any earlier stage.
# study and compare stand at the end and draw on several stages.
set(order core scene motion geometry trace signal output study compare)

file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/src/*.h ${ROOT}/src/*.cpp ${ROOT}/motion/*.h ${ROOT}/motion/*.cpp)
foreach(file IN LISTS files)
  string(REGEX REPLACE "^src/" "" stage ${file})
  string(REGEX REPLACE "/.*$" "" stage ${stage})
  list(FIND order "${stage}" position)
  file(STRINGS ${ROOT}/${file} includes REGEX "^#include ")
  foreach(include IN LISTS includes)
    string(REGEX REPLACE "^#include [<\"]([^>\"]+)[>\"].*$" "\\1" path "${include}")
    foreach(rule IN LISTS libraries)
      string(REGEX REPLACE "=.*$" "" pattern "${rule}")
      string(REGEX REPLACE "^.*=" "" folders "${rule}")
      string(REPLACE "," "|" folders "${folders}")
      if("${path}" MATCHES "^(oneapi/)?(${pattern})" AND NOT "${file}" MATCHES "^(${folders})/")
        string(APPEND failures "${file}: includes ${path}, which belongs to ${folders}\n")
      endif()
    endforeach()
    string(REGEX REPLACE "/.*$" "" target "${path}")
    list(FIND order "${target}" target_position)
    if(stage STREQUAL "page" AND target_position GREATER 0)
      string(APPEND failures "${file}: includes ${path}, but pages stand on core alone\n")
    endif()
    if(position GREATER -1 AND target_position GREATER -1)
      if(target_position GREATER position)
        string(APPEND failures "${file}: includes ${path}, which stands to the right of it\n")
      elseif(file MATCHES "\\.h$" AND target_position GREATER 1 AND NOT stage MATCHES "^(study|compare)$")
        math(EXPR before "${position} - 1")
        if(target_position LESS before)
          string(APPEND failures "${file}: a header that includes ${path}, not of the stage just before it\n")
        endif()
      endif()
    endif()
  endforeach()
endforeach()

if(failures)
  message(FATAL_ERROR "\n${failures}")
endif()
