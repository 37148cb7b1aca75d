# One precompiled header for every target: Eigen and the standard library take more than a second
# of each file's compile otherwise. A file still includes what it uses; debug builds check that.
set(CMAKE_PCH_WARN_INVALID OFF)  # GCC reads the text where a target's flags differ, as CGAL's do

if(TRANOS_PCH)
  add_library(tranos_precompiled OBJECT ${CMAKE_CURRENT_LIST_DIR}/precompiled_headers.cpp)
  target_link_libraries(tranos_precompiled PRIVATE tranos_flags)
  target_precompile_headers(tranos_precompiled PRIVATE
    <Eigen/Core> <Eigen/Geometry> <algorithm> <functional> <map> <memory> <optional> <string>
    <string_view> <unordered_map> <tl/expected.hpp> <variant> <vector>)
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
