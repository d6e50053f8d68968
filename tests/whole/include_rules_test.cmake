# Which room may use which, and which room is the door to which library. A room or a library that is not
# listed here fails, and so does a permission that no include needs, or a file that outgrows one idea.
#   cmake -DROOT=<source folder> -P include_rules_test.cmake

cmake_minimum_required(VERSION 3.24)
set(failures "")

# library pattern = rooms that may include it. Of OpenCV the pixel kernels (core, imgproc) serve whoever works
# on pictures; its files and windows serve nobody.
set(libraries
  "(oneapi/)?tbb/=core"
  "openssl/=core"
  "toml\\+\\+/=scene"
  "OpenMesh/=mesh"
  "opensubdiv/=subdivision"
  "embree3/=geometry"
  "(OpenEXR/|Imath/|Imf.*\\.h$|half\\.h$)=output"
  "opencv2/(core|imgproc)=metrics,output,doppler,echo,export,fit,compare"
  "(dcmtk/|libav|libswscale|turbojpeg\\.h$|png\\.h$)=video"
  "zlib\\.h$=core,video,output,zarr,dataset"
  "zstd\\.h$=zarr"
  "hdf5\\.h$=hdf"
  "CLI/=cli"
  "nlohmann/=scene,zarr,heart,output,mmode,doppler,archive,page,view,echo,fit,compare,render,study,dataset,live,cli,python"
  "(pybind11/|Python\\.h$)=python"
  "fmt/=*"
  "[a-z_0-9]+(\\.h)?$=*"
  "(netinet|arpa)/=live"
  "sys/=core,video,render,live")

# room = rooms that all of it may use | and its sources alone. Everybody may use core, and all but page and
# core scene. Arrows run from right to left only: a room stands below those that it uses.
set(rooms
  "core="
  "scene="
  "plan="
  "page="
  "hdf="
  "zarr="
  "mesh="
  "repair=mesh"
  "subdivision="
  "cycle="
  "keyframes=cycle,mesh"
  "interior=keyframes"
  "views="
  "heart=cycle,views|mesh,keyframes,subdivision"
  "surfaces=mesh,keyframes,interior,subdivision,views|plan,repair,cycle"
  "geometry=surfaces"
  "truth=geometry,surfaces,interior,views|plan"
  "trace=plan,geometry"
  "speckle=plan,trace,interior,surfaces"
  "signal=plan,trace,speckle"
  "frame=plan,surfaces,cycle,geometry,trace,speckle,signal,truth"
  "loop=frame,cycle,surfaces,trace|plan,truth"
  "metrics=signal,trace"
  "video=signal"
  "output=plan,trace,signal,surfaces,heart,truth|video"
  "mmode=frame,cycle,truth,signal|surfaces,output,video"
  "doppler=frame,cycle,signal,mmode,output,video|surfaces,truth"
  "view=frame,mesh,surfaces|plan,cycle,geometry,signal,video,page"
  "echo=video|hdf,zarr,signal,metrics,output"
  "export=video,signal|echo"
  "archive=loop|hdf,zarr,surfaces,cycle,truth,output"
  "fit=echo,heart,surfaces,geometry,truth,signal,page|interior,frame,video,output,view"
  "compare=echo,fit,metrics,signal,truth,page|surfaces,video"
  "render=loop,frame,cycle,output,page,video,truth|plan,signal,trace,surfaces,view"
  "study=plan,frame,cycle,output,video,metrics|loop,surfaces,keyframes,trace,signal,render,page"
  "echocine=render,loop,frame,heart"
  "dataset=output,surfaces,cycle,heart,truth,signal|hdf,frame,loop,views,video,page,metrics,echo"
  "live=frame,surfaces,output,plan,truth,heart,view,signal,video|cycle,mesh,page,export"
  "python=frame,echo|plan,loop,mmode,doppler,render,export,fit,compare,study,dataset,heart,cycle,output,video,surfaces,live"
  "cli=render,fit,compare,study,output,view,plan,mmode,doppler,export,live|archive,dataset,video,frame,surfaces,keyframes,cycle,heart")

function(room_of path out)
  string(REGEX REPLACE "^src/" "" path "${path}")
  if(path MATCHES "^motion/[^/]+/")
    string(REGEX REPLACE "^motion/([^/]+)/.*$" "\\1" path "${path}")
  else()
    string(REGEX REPLACE "/.*$" "" path "${path}")
  endif()
  set(${out} "${path}" PARENT_SCOPE)
endfunction()

# Earlier rooms only, so that no arrow in the table itself runs back.
set(known "")
foreach(entry IN LISTS rooms)
  string(REGEX REPLACE "=.*$" "" room "${entry}")
  string(REGEX REPLACE "^[^=]*=" "" uses "${entry}")
  string(REGEX REPLACE "\\|.*$" "" everywhere "${uses}")
  string(REPLACE "|" "," uses "${uses}")
  string(REPLACE "," ";" uses_${room} "${uses}")
  string(REPLACE "," ";" header_uses_${room} "${everywhere}")
  set(listed_${room} ${uses_${room}})
  if(NOT room STREQUAL "core")
    list(APPEND uses_${room} core)
    list(APPEND header_uses_${room} core)
  endif()
  if(NOT room MATCHES "^(core|scene|page)$")
    list(APPEND uses_${room} scene)
    list(APPEND header_uses_${room} scene)
  endif()
  foreach(used IN LISTS uses_${room})
    if(NOT used IN_LIST known)
      string(APPEND failures "the table lets ${room} use ${used}, which does not stand before it\n")
    endif()
  endforeach()
  list(APPEND known ${room})
endforeach()

file(GLOB loose RELATIVE ${ROOT} ${ROOT}/src/*.h ${ROOT}/src/*.cpp)
foreach(file IN LISTS loose)
  string(APPEND failures "${file}: of which room is it?\n")
endforeach()

file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/src/*.h ${ROOT}/src/*.cpp ${ROOT}/motion/*.h ${ROOT}/motion/*.cpp)
foreach(file IN LISTS files)
  room_of(${file} room)
  if(NOT room IN_LIST known)
    string(APPEND failures "${file}: room ${room} is not in the table\n")
    continue()
  endif()
  file(STRINGS ${ROOT}/${file} includes REGEX "^#include ")
  foreach(include IN LISTS includes)
    string(REGEX REPLACE "^#include [<\"]([^>\"]+)[>\"].*$" "\\1" path "${include}")
    if(include MATCHES "^#include <")
      set(doors "")
      foreach(rule IN LISTS libraries)
        string(REGEX REPLACE "=[^=]*$" "" pattern "${rule}")
        if(NOT doors AND "${path}" MATCHES "^${pattern}")
          string(REGEX REPLACE "^.*=" "" doors "${rule}")
          list(APPEND used_rules "${rule}:${room}")
        endif()
      endforeach()
      string(REPLACE "," ";" door_list "${doors}")
      if(NOT doors)
        string(APPEND failures "${file}: includes <${path}>, a library that has no door\n")
      elseif(NOT doors STREQUAL "*" AND NOT room IN_LIST door_list)
        string(APPEND failures "${file}: includes <${path}>, which belongs to ${doors}\n")
      endif()
      continue()
    endif()
    room_of("${path}" target)
    if(target STREQUAL room)
      continue()
    endif()
    list(APPEND used_${room} ${target})
    if(file MATCHES "\\.h$")
      list(APPEND header_used_${room} ${target})
    endif()
    if(NOT target IN_LIST known)
      string(APPEND failures "${file}: includes ${path}, of no known room\n")
    elseif(NOT target IN_LIST uses_${room})
      string(APPEND failures "${file}: includes ${path}, but ${room} does not stand on ${target}\n")
    elseif(file MATCHES "\\.h$" AND NOT target IN_LIST header_uses_${room})
      string(APPEND failures "${file}: a header that includes ${path}; in ${room} only sources use ${target}\n")
    endif()
  endforeach()
endforeach()

# A row says what a room uses, no more. Core and scene are for all.
foreach(room IN LISTS known)
  foreach(target IN LISTS listed_${room})
    if(NOT target IN_LIST used_${room})
      string(APPEND failures "the table lets ${room} use ${target}, which it does not include\n")
    elseif(target IN_LIST header_uses_${room} AND NOT target IN_LIST header_used_${room})
      string(APPEND failures "the table lets headers of ${room} use ${target}, which only its sources include\n")
    endif()
  endforeach()
endforeach()
# src/README.md shows the same rows.
file(READ ${ROOT}/src/README.md page)
string(REPLACE ";" "," page "${page}")
string(REGEX MATCHALL "\n\\| \\[[^\n]*" rows "${page}")
set(shown "")
foreach(row IN LISTS rows)
  string(REGEX REPLACE "^\n\\| \\[([a-z/]+)\\].*$" "\\1" room "${row}")
  string(REGEX REPLACE "^.*/" "" room "${room}")
  string(REGEX REPLACE "^\n\\|[^|]*\\|[^|]*\\|([^|]*)\\|.*$" "\\1" uses "${row}")
  string(REPLACE " " "" uses "${uses}")
  string(REPLACE "," ";" uses "${uses}")
  set(needed ${listed_${room}})
  list(SORT uses)
  list(SORT needed)
  if(NOT "${uses}" STREQUAL "${needed}")
    string(APPEND failures "src/README.md: ${room} uses ${needed}, the table shows ${uses}\n")
  endif()
  list(APPEND shown ${room})
endforeach()
foreach(room IN LISTS known)
  if(NOT room IN_LIST shown)
    string(APPEND failures "src/README.md: ${room} is not in the table\n")
  endif()
endforeach()

foreach(rule IN LISTS libraries)
  string(REGEX REPLACE "^.*=" "" doors "${rule}")
  string(REPLACE "," ";" door_list "${doors}")
  foreach(room IN LISTS door_list)
    if(NOT room STREQUAL "*" AND NOT "${rule}:${room}" IN_LIST used_rules)
      string(APPEND failures "the table lets ${room} include ${rule}, which it does not\n")
    endif()
  endforeach()
endforeach()

# One idea a file: what is longer holds two.
set(most_lines 300)
file(GLOB_RECURSE sources RELATIVE ${ROOT} ${ROOT}/src/*.h ${ROOT}/src/*.cpp ${ROOT}/motion/*.h ${ROOT}/motion/*.cpp
     ${ROOT}/tests/*.h ${ROOT}/tests/*.cpp)
foreach(file IN LISTS sources)
  file(READ ${ROOT}/${file} text)
  string(REGEX REPLACE "[^\n]+" "" lines "${text}")
  string(LENGTH "${lines}" count)
  if(count GREATER_EQUAL most_lines)
    string(APPEND failures "${file}: ${count} lines, under ${most_lines} are accepted: split it by its ideas\n")
  endif()
endforeach()

if(failures)
  message(FATAL_ERROR "\n${failures}")
endif()
