# Installs the library as `kind` (static or shared) into an empty folder, then builds and runs the consumer against it.
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# The prefix has a space in its name on purpose.
set(prefix "${work_dir}/installed tree")
file(REMOVE_RECURSE ${prefix} ${work_dir}/consumer)

# The current build is used for its own kind. The other kind is built beside it, without optimisation.
if((kind STREQUAL "shared" AND build_shared) OR (kind STREQUAL "static" AND NOT build_shared))
  set(library_build ${build_dir})
else()
  set(library_build ${work_dir}/library)
  if(kind STREQUAL "shared")
    set(shared ON)
  else()
    set(shared OFF)
  endif()
  run(${CMAKE_COMMAND} -S ${source_dir} -B ${library_build} -G ${generator}
    -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_BUILD_TYPE=Debug -D CMAKE_CXX_FLAGS_DEBUG=-O0
    -D BUILD_SHARED_LIBS=${shared} -D RICOCHET_BUILD_TESTS=OFF -D RICOCHET_BUILD_APPS=OFF)
  run(${CMAKE_COMMAND} --build ${library_build})
endif()
execute_process(COMMAND ${CMAKE_COMMAND} --install ${library_build} --prefix ${prefix} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)

# Check that only public headers are installed, and that documents, the schema and scenes are installed too.
file(GLOB_RECURSE header_files RELATIVE "${prefix}/include/ricochet" "${prefix}/include/*.h")
file(STRINGS ${source_dir}/src/ricochet/public_headers.txt public_headers REGEX "^[^#]")
list(SORT header_files)
list(SORT public_headers)
if(NOT header_files STREQUAL public_headers)
  message(FATAL_ERROR "installed are the headers ${header_files}, expected ${public_headers}")
endif()
foreach(file IN ITEMS doc/ricochet/docs/scene-format.md ricochet/scene.schema.json ricochet/scenes/bouncing_ball.json
        ricochet/meshes/bowl.obj)
  if(NOT EXISTS "${prefix}/share/${file}")
    message(FATAL_ERROR "share/${file} was not installed")
  endif()
endforeach()

run(${CMAKE_COMMAND} -D root=${prefix}/share/doc/ricochet -D installed=ON
  -P ${source_dir}/tests/documents/check_documents.cmake)

# Check that the consumer runs a scene.
function(check_output program)
  execute_process(COMMAND ${program} "${prefix}/share/ricochet/scenes/bouncing_ball.json"
    OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
  if(NOT output MATCHES "^[1-9][0-9]* particles after 6 s, state [0-9a-f]+\n$")
    message(FATAL_ERROR "${program} printed '${output}'")
  endif()
  message(STATUS "${program}: ${output}")
endfunction()

# Build with find_package.
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${work_dir}/consumer -G ${generator}
  -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_BUILD_TYPE=${build_type} -D CMAKE_PREFIX_PATH=${prefix})
file(STRINGS ${work_dir}/consumer/CMakeCache.txt found REGEX "^ricochet_DIR:")
string(FIND "${found}" "${prefix}" position)
if(position EQUAL -1)
  message(FATAL_ERROR "the consumer found another installation: ${found}")
endif()
run(${CMAKE_COMMAND} --build ${work_dir}/consumer)
check_output(${work_dir}/consumer/consumer)
execute_process(COMMAND ${work_dir}/consumer/walkthrough "${prefix}/share/ricochet/meshes/bowl.obj"
  OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
file(READ ${source_dir}/docs/library.md library_document)
string(STRIP "${output}" output)
string(REPLACE "\n" "\n    " shown "    ${output}")
string(FIND "${library_document}" "${shown}" position)
if(position EQUAL -1)
  message(FATAL_ERROR "the walkthrough printed '${output}', which is not what docs/library.md shows")
endif()

# Build with pkg-config.
if(NOT pkg_config)
  message(STATUS "pkg-config is not installed: not tried")
  return()
endif()
file(GLOB_RECURSE pc_file "${prefix}/*/ricochet.pc")
cmake_path(GET pc_file PARENT_PATH pkgconfig_dir)
set(ENV{PKG_CONFIG_PATH} ${pkgconfig_dir})
execute_process(COMMAND ${pkg_config} --cflags --libs ricochet
  OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags UNIX_COMMAND "${flags}")
cmake_path(GET pkgconfig_dir PARENT_PATH library_dir)
run(${compiler} -std=c++20 ${CMAKE_CURRENT_LIST_DIR}/consumer/main.cpp -o ${work_dir}/by_pkg_config ${flags}
  "-Wl,-rpath,${library_dir}")
check_output(${work_dir}/by_pkg_config)
