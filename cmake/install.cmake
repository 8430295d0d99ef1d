# cmake --install: headers, library, the shader files that hosts include, and the package find_package(gnomon) finds.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(shaders_destination ${CMAKE_INSTALL_DATADIR}/gnomon/shaders)
set(package_destination ${CMAKE_INSTALL_LIBDIR}/cmake/gnomon)

install(TARGETS gnomon EXPORT gnomon INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY include/gnomon DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

# The files that a host's shader may name, phase 4 for those with a visibility provider of their own, and whatever these
# include. gnomon_host_provider.glsl is the host's, and is found nowhere here.
file(GLOB shaders RELATIVE ${GNOMON_SHADER_INCLUDE_DIR} CONFIGURE_DEPENDS
    src/shading/*.glsl src/visibility/*.glsl src/gpu_interface/*.glsl src/gpu_interface/*.h)
list(APPEND shaders generate_shadows/filter_pairs.comp)
set(to_follow ${shaders})
while(to_follow)
    list(POP_FRONT to_follow shader)
    file(STRINGS src/${shader} includes REGEX "^#include \"")
    foreach(include ${includes})
        string(REGEX REPLACE "^#include \"([^\"]*)\".*" "\\1" include "${include}")
        if(NOT include IN_LIST shaders AND EXISTS ${GNOMON_SHADER_INCLUDE_DIR}/${include})
            list(APPEND shaders ${include})
            list(APPEND to_follow ${include})
        endif()
    endforeach()
endwhile()
foreach(shader ${shaders})
    get_filename_component(folder ${shader} DIRECTORY)
    install(FILES src/${shader} DESTINATION ${shaders_destination}/${folder})
endforeach()

install(EXPORT gnomon NAMESPACE gnomon:: FILE gnomonTargets.cmake DESTINATION ${package_destination})
configure_package_config_file(cmake/gnomonConfig.cmake.in ${PROJECT_BINARY_DIR}/gnomonConfig.cmake
    INSTALL_DESTINATION ${package_destination} PATH_VARS shaders_destination)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/gnomonConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/shaders.cmake
    ${PROJECT_BINARY_DIR}/gnomonConfig.cmake ${PROJECT_BINARY_DIR}/gnomonConfigVersion.cmake
    DESTINATION ${package_destination})
