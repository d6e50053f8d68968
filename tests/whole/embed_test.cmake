# Installs the build and uses it from a folder outside the tree: find_package() builds and runs a program, the
# installed scene renders. add_subdirectory() is configured; with ECHOCINE_EMBED=1 in the environment, as the
# gate has it, it is built and run too, which compiles the library once more.
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
set(common -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=${TYPE} -G Ninja "-DCMAKE_CXX_FLAGS=${SANITIZE}")

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${folder}/prefix)
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
run(${CMAKE_COMMAND} -S ${folder}/program -B ${folder}/found ${common} -DCMAKE_PREFIX_PATH=${folder}/prefix)
run(${CMAKE_COMMAND} --build ${folder}/found)
run(${folder}/found/embed)
set(heart ${folder}/prefix/share/echocine/beating_heart)
run(${folder}/found/embed ${heart}/scene.toml)
run(${folder}/prefix/bin/echocine render ${heart}/scene.toml -o ${folder}/loop --frames 0:2 --preset draft --quiet)

run(${CMAKE_COMMAND} -S ${folder}/program -B ${folder}/added ${common} -DECHOCINE_TREE=${ROOT})
if("$ENV{ECHOCINE_EMBED}")
  run(${CMAKE_COMMAND} --build ${folder}/added --target embed)
  run(${folder}/added/embed)
endif()
file(REMOVE_RECURSE ${folder})
