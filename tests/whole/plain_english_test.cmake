# Phrases that a reader must decode, in documents and in comments.
#   cmake -DROOT=<source folder> -P plain_english_test.cmake

cmake_minimum_required(VERSION 3.24)
set(failures "")

# pattern = what to write instead
set(phrases
  "(is|are|was|were) told([ .,;:]|$)=is reported"
  "says? nothing([ .,;:]|$)=is uninformative, has no effect"
  "[^a-z]in sight([ .,;:]|$)=visible, overlap"
  "[^a-z]alike([ .,;:]|$)=equally, similar, both"
  "[^a-z]of which[ ,]=a sentence of its own"
  "hardly meant=valid but unlikely"
  "(^|[.] )Whom=a sentence with a subject"
  "(^|[.] )Of [a-z0-9]=the noun first, or For"
  "(^|[.] )What [a-z0-9]=the noun")

function(search file number line)
  string(STRIP "${line}" text)
  foreach(entry IN LISTS phrases)
    string(REGEX REPLACE "=[^=]*$" "" pattern "${entry}")
    if(text MATCHES "${pattern}")
      set(found "${CMAKE_MATCH_0}")
      string(REGEX REPLACE "^.*=" "" instead "${entry}")
      string(APPEND failures "${file}:${number}: '${found}': write ${instead}\n")
    endif()
  endforeach()
  set(failures "${failures}" PARENT_SCOPE)
endfunction()

# Brackets and semicolons would part CMake's lists.
function(lines_of file out)
  file(READ ${ROOT}/${file} text)
  string(REPLACE ";" "," text "${text}")
  string(REPLACE "[" "(" text "${text}")
  string(REPLACE "]" ")" text "${text}")
  string(REPLACE "\\" "/" text "${text}")
  string(REPLACE "\n" ";" text "${text}")
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

file(GLOB_RECURSE documents RELATIVE ${ROOT} ${ROOT}/src/*.md ${ROOT}/motion/*.md ${ROOT}/tests/*.md ${ROOT}/examples/*.md
     ${ROOT}/data/*.md ${ROOT}/.github/*.md)
file(GLOB_RECURSE sources RELATIVE ${ROOT} ${ROOT}/src/*.h ${ROOT}/src/*.cpp ${ROOT}/motion/*.h ${ROOT}/motion/*.cpp)
# All text of documents, the comments of sources.
foreach(file IN LISTS documents sources ITEMS README.md CHANGELOG.md)
  if(file MATCHES "/vendor/")
    continue()
  endif()
  lines_of(${file} lines)
  set(number 0)
  foreach(line IN LISTS lines)
    math(EXPR number "${number} + 1")
    if(file MATCHES "\\.md$")
      search(${file} ${number} "${line}")
    elseif(line MATCHES "//(.*)$")
      search(${file} ${number} "${CMAKE_MATCH_1}")
    endif()
  endforeach()
endforeach()

if(failures)
  message(FATAL_ERROR "\n${failures}")
endif()
