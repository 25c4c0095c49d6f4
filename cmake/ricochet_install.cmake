# Installation of the library with its public headers, the tool, the CMake package, the pkg-config file, documents, the
# scene schema and scenes with their meshes. CPack makes a .deb of it.
include(CMakePackageConfigHelpers)

set(ricochet_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/ricochet)
install(TARGETS ricochet EXPORT ricochet_targets FILE_SET HEADERS)
if(RICOCHET_BUILD_APPS)
  file(RELATIVE_PATH bin_to_lib /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
  set(run_path "$ORIGIN/${bin_to_lib}")
  if(RICOCHET_MPI)
    list(APPEND run_path "$ORIGIN/${bin_to_lib}/ricochet")
    install(TARGETS ricochet_mpi_calls DESTINATION ${CMAKE_INSTALL_LIBDIR}/ricochet)
  endif()
  set_target_properties(ricochet_cli PROPERTIES INSTALL_RPATH "${run_path}")
  install(TARGETS ricochet_cli)
endif()
install(EXPORT ricochet_targets FILE ricochet-targets.cmake NAMESPACE ricochet:: DESTINATION ${ricochet_cmake_dir})

get_target_property(ricochet_library_type ricochet TYPE)
configure_package_config_file(cmake/ricochet-config.cmake.in ricochet-config.cmake
  INSTALL_DESTINATION ${ricochet_cmake_dir})
# While the major number is 0 a new minor number may change the interface.
write_basic_package_version_file(ricochet-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/ricochet-config.cmake
  ${PROJECT_BINARY_DIR}/ricochet-config-version.cmake
  DESTINATION ${ricochet_cmake_dir})

string(REGEX MATCH "^[0-9]+" embree_major "${EMBREE_VERSION}")
set(ricochet_private_libraries "-lembree${embree_major} -ltbb -lfmt")
if(RICOCHET_ASSIMP)
  string(APPEND ricochet_private_libraries " -lassimp")
endif()
if(ricochet_library_type STREQUAL "STATIC_LIBRARY")
  set(ricochet_public_libraries "-lricochet ${ricochet_private_libraries}")
else()
  set(ricochet_public_libraries "-lricochet")
endif()
file(RELATIVE_PATH ricochet_prefix_from_pc /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/ricochet.pc.in ricochet.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/ricochet.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

install(FILES LICENSE README.md ARCHITECTURE.md CHANGELOG.md CITATION.cff CONTRIBUTING.md SECURITY.md THIRD_PARTY.md
  DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} PATTERN scene.schema.json EXCLUDE)
set(ricochet_data_dir ${CMAKE_INSTALL_DATADIR}/ricochet)
install(FILES docs/scene.schema.json DESTINATION ${ricochet_data_dir})
install(DIRECTORY scenes DESTINATION ${ricochet_data_dir})
# Documents link to these files, so they are installed beside the documents.
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES third_party/three/LICENSE third_party/three/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/third_party/three)
install(DIRECTORY bench/results DESTINATION ${CMAKE_INSTALL_DOCDIR}/bench)
# Scenes refer to meshes in a folder beside theirs.
install(DIRECTORY meshes DESTINATION ${ricochet_data_dir} FILES_MATCHING PATTERN *.obj PATTERN README.md PATTERN generators EXCLUDE)

set(CPACK_PACKAGE_VENDOR "The Ricochet authors")
set(CPACK_PACKAGE_CONTACT "The Ricochet authors")
set(CPACK_GENERATOR DEB)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libembree-dev, libtbb-dev, libfmt-dev")
set(CPACK_STRIP_FILES ON)
include(CPack)
