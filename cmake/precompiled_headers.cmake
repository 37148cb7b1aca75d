# One precompiled header for every target: Eigen and the standard library take more than a second
# of each file's compile otherwise. A file still includes what it uses; debug builds check that.
set(CMAKE_PCH_WARN_INVALID OFF)  # GCC reads the text where a target's flags differ, as CGAL's do

set(precompiled Eigen/Core Eigen/Geometry algorithm functional map memory optional string
  string_view tl/expected.hpp unordered_map variant vector)
list(TRANSFORM precompiled REPLACE "(.+)" "<\\1>")

if(TRANOS_PCH)
  add_library(tranos_precompiled OBJECT ${CMAKE_CURRENT_LIST_DIR}/precompiled_headers.cpp)
  target_link_libraries(tranos_precompiled PRIVATE tranos_flags)
  target_precompile_headers(tranos_precompiled PRIVATE ${precompiled})
endif()

# No two clones have the same precompiled header: Clang writes down where it lies, and GCC's differs
# by itself. So ccache is to go by the text that was read into it.
if(TRANOS_PCH)
  list(TRANSFORM precompiled PREPEND "#include " OUTPUT_VARIABLE lines)
  list(JOIN lines "\n" lines)
  set(place ${CMAKE_BINARY_DIR}/CMakeFiles/tranos_precompiled.dir/cmake_pch.hxx)
  file(WRITE ${place}.sum.cpp "${lines}\n")
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -std=c++20 -isystem /usr/include/eigen3 -E -P
    ${place}.sum.cpp OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  string(SHA256 sum "${text}")
  file(WRITE ${place}.gch.sum "${sum}\n")
  file(WRITE ${place}.pch.sum "${sum}\n")
endif()
# Of `-include` ccache knows that a name below the source folder counts without it, and Clang that
# the precompiled one lies beside it; CMake hides both behind `-Xclang`.
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  set(CMAKE_CXX_COMPILE_OPTIONS_USE_PCH -include <PCH_HEADER>)
endif()

# Lets every target below the folder use the header.
function(share_precompiled_headers folder)
  get_property(folders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(sub IN LISTS folders)
    share_precompiled_headers(${sub})
  endforeach()
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    if(type MATCHES "LIBRARY|EXECUTABLE" AND NOT type STREQUAL "INTERFACE_LIBRARY"
       AND NOT target STREQUAL "tranos_precompiled")
      target_precompile_headers(${target} REUSE_FROM tranos_precompiled)
    endif()
  endforeach()
endfunction()
