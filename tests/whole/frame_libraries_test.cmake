# A program that links the frame's library alone makes a frame and loads no library for files of pictures.
#   cmake -DPROGRAM=<frame_program> -DSCENE=<scene.toml> -P frame_libraries_test.cmake
cmake_minimum_required(VERSION 3.24)

execute_process(COMMAND ${PROGRAM} ${SCENE} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} ended with ${code}:\n${out}")
endif()
execute_process(COMMAND ldd ${PROGRAM} RESULT_VARIABLE code OUTPUT_VARIABLE loaded ERROR_VARIABLE loaded)
if(NOT code EQUAL 0 OR NOT loaded MATCHES "libembree")
  message(FATAL_ERROR "ldd ${PROGRAM} ended with ${code}:\n${loaded}")
endif()
string(REGEX MATCHALL "lib(av|sw)[a-z]+\\.[^\n]*|lib(dcm|oflog|ofstd|OpenEXR|Imath|Iex|IlmThread|hdf5|turbojpeg|jpeg|png|opencv_imgcodecs)[^\n]*"
       unwanted "${loaded}")
if(unwanted)
  list(JOIN unwanted "\n  " unwanted)
  message(FATAL_ERROR "${PROGRAM} loads\n  ${unwanted}")
endif()
string(REGEX MATCHALL "\n" lines "${loaded}")
list(LENGTH lines count)
message("${count} shared libraries")
