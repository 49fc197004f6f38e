# What `cmake --install` puts where. The client library is one archive of all rooms that it needs, so that neither
# our warnings nor our targets reach whoever uses it.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(rooms base math units security sensing body roster runtime wire_types bus client)
set(script "CREATE ${PROJECT_BINARY_DIR}/liblimbcast-client.a\n")
set(archives)
foreach(room IN LISTS rooms)
  get_target_property(type limbcast_${room} TYPE)
  if(type STREQUAL STATIC_LIBRARY)
    string(APPEND script "ADDLIB $<TARGET_FILE:limbcast_${room}>\n")
    list(APPEND archives limbcast_${room})
  endif()
endforeach()
string(APPEND script "SAVE\nEND\n")
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/limbcast-client.mri CONTENT "${script}")
add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/liblimbcast-client.a
  COMMAND ${CMAKE_AR} -M < ${PROJECT_BINARY_DIR}/limbcast-client.mri
  DEPENDS ${archives} ${PROJECT_BINARY_DIR}/limbcast-client.mri VERBATIM)
add_custom_target(limbcast_client_archive ALL DEPENDS ${PROJECT_BINARY_DIR}/liblimbcast-client.a)

set(LIMBCAST_CLIENT_LIBRARIES fastcdr OpenSSL::Crypto)
set(LIMBCAST_CLIENT_PACKAGES "find_dependency(fastcdr)\nfind_dependency(OpenSSL)")
set(LIMBCAST_CLIENT_FLAGS "-lfastcdr -lcrypto")
if(LIMBCAST_CYCLONE)
  list(APPEND LIMBCAST_CLIENT_LIBRARIES CycloneDDS::ddsc)
  string(APPEND LIMBCAST_CLIENT_PACKAGES "\nfind_dependency(CycloneDDS)")
  string(PREPEND LIMBCAST_CLIENT_FLAGS "-lddsc ")
endif()
if(LIMBCAST_FASTDDS)
  list(APPEND LIMBCAST_CLIENT_LIBRARIES fastrtps)
  string(APPEND LIMBCAST_CLIENT_PACKAGES "\nfind_dependency(fastrtps)")
  string(PREPEND LIMBCAST_CLIENT_FLAGS "-lfastrtps ")
endif()
set(headers ${CMAKE_INSTALL_INCLUDEDIR}/limbcast)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/limbcast)
configure_package_config_file(${PROJECT_SOURCE_DIR}/tools/cmake/limbcast-config.cmake.in
  ${PROJECT_BINARY_DIR}/limbcast-config.cmake INSTALL_DESTINATION ${package}
  PATH_VARS CMAKE_INSTALL_LIBDIR headers)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/limbcast-config-version.cmake
  COMPATIBILITY SameMinorVersion)
file(RELATIVE_PATH LIMBCAST_PC_TO_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(${PROJECT_SOURCE_DIR}/tools/cmake/limbcast.pc.in ${PROJECT_BINARY_DIR}/limbcast.pc @ONLY)

install(FILES ${PROJECT_BINARY_DIR}/liblimbcast-client.a DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT client)
install(FILES ${PROJECT_BINARY_DIR}/limbcast-config.cmake ${PROJECT_BINARY_DIR}/limbcast-config-version.cmake
  DESTINATION ${package} COMPONENT client)
install(FILES ${PROJECT_BINARY_DIR}/limbcast.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT client)
# The public headers and what they include; no room that knows of a bus or of DDS.
foreach(room base math units body roster)
  install(DIRECTORY common/${room} DESTINATION ${headers}/common COMPONENT client FILES_MATCHING PATTERN "*.hpp")
endforeach()
install(FILES common/client/client.hpp common/client/client_options.hpp common/client/session_directory.hpp
  common/client/skeleton_history.hpp DESTINATION ${headers}/common/client COMPONENT client)
install(TARGETS limbcast limbcast-gateway limbcast-fusion limbcast-posture limbcast-session
  DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT services)
