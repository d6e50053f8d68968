# Installs the build, moves it to another folder, and uses it from outside the tree: find_package() builds and runs
# a C++-only program with GCC and with Clang, where present, and the installed scene renders. Public headers stay cheap.
# add_subdirectory() is configured; with ECHOCINE_EMBED=1 in the environment it is built and run too, which compiles
# the library once more.
#   cmake -DBUILD=<build folder> -DROOT=<source folder> -DCOMPILER=<C++ compiler> -DTYPE=<build type>
#         -DSANITIZE=<flags> -P embed_test.cmake
cmake_minimum_required(VERSION 3.24)

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${ARGV} ended with ${code}:\n${out}")
  endif()
endfunction()

string(RANDOM LENGTH 12 name)
if(DEFINED ENV{TMPDIR})
  set(folder $ENV{TMPDIR}/echocine-embed-${name})
else()
  set(folder /tmp/echocine-embed-${name})
endif()
file(MAKE_DIRECTORY ${folder}/program)
file(COPY ${ROOT}/tests/embed/main.cpp ${ROOT}/tests/embed/CMakeLists.txt DESTINATION ${folder}/program)
set(common -DCMAKE_BUILD_TYPE=${TYPE} -G Ninja)

# The package must not depend on the folder of its installation.
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${folder}/installed)
file(RENAME ${folder}/installed ${folder}/prefix)
foreach(file man/man1/echocine.1 man/man1/echocine-render.1 bash-completion/completions/echocine
        zsh/site-functions/_echocine doc/echocine/echarts/LICENSE doc/echocine/echarts/NOTICE doc/echocine/three/LICENSE doc/echocine/LICENSE
        doc/echocine/README.md doc/echocine/examples/every_key/scene.toml)
  if(NOT EXISTS ${folder}/prefix/share/${file})
    message(FATAL_ERROR "share/${file} is not installed")
  endif()
endforeach()
# What the installed README links to is there.
file(READ ${folder}/prefix/share/doc/echocine/README.md readme)
string(REGEX REPLACE "[<;[]" " " readme "${readme}")
string(REPLACE "](" "<" readme "${readme}")  # brackets would hold a list together
string(REGEX MATCHALL "<[^)#]+" links "${readme}")
foreach(link IN LISTS links)
  string(SUBSTRING "${link}" 1 -1 link)
  if(NOT link MATCHES "^http" AND NOT EXISTS ${folder}/prefix/share/doc/echocine/${link})
    message(FATAL_ERROR "the installed README.md links to ${link}, which is not installed")
  endif()
endforeach()
set(heart ${folder}/prefix/share/echocine/beating_heart)
run(${folder}/prefix/bin/echocine render ${heart}/scene.toml -o ${folder}/loop --frames 0:2 --preset draft --quiet)

# A program links static libraries of the build's compiler with either compiler. The run times of sanitizers do not mix.
set(compilers ${COMPILER})
file(REAL_PATH ${COMPILER} known)
if(NOT SANITIZE)
  foreach(name g++ clang++)
    find_program(other_${name} ${name} NO_CACHE)
    if(other_${name})
      file(REAL_PATH ${other_${name}} file)
      if(NOT file IN_LIST known)
        list(APPEND compilers ${other_${name}})
        list(APPEND known ${file})
      endif()
    endif()
  endforeach()
endif()
include(${CMAKE_CURRENT_LIST_DIR}/embed_checks.cmake)
set(number 0)
foreach(compiler IN LISTS compilers)
  math(EXPR number "${number} + 1")
  set(found ${folder}/found${number})
  run(${CMAKE_COMMAND} -S ${folder}/program -B ${found} ${common} -DCMAKE_CXX_COMPILER=${compiler}
      "-DCMAKE_CXX_FLAGS=${SANITIZE} -Wall -Wextra -Werror" -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DCMAKE_PREFIX_PATH=${folder}/prefix)
  check_flags(${found} ${folder})
  check_includes(${compiler} ${found} ${folder}/prefix)
  run(${CMAKE_COMMAND} --build ${found})
  check_libraries(${found}/embed)
  run(${found}/embed)
  run(${found}/embed ${heart}/scene.toml)
endforeach()

run(${CMAKE_COMMAND} -S ${folder}/program -B ${folder}/added ${common} -DCMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CXX_FLAGS=${SANITIZE}"
    -DECHOCINE_TREE=${ROOT})
if("$ENV{ECHOCINE_EMBED}")
  run(${CMAKE_COMMAND} --build ${folder}/added --target embed)
  run(${folder}/added/embed)
endif()
file(REMOVE_RECURSE ${folder})
