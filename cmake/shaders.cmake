# gnomon_add_shaders(TARGET shader... [INCLUDES folder...])
# Compiles each GLSL file to SPIR-V and to a header NAME.spv.h that holds it as a list of words. The headers are on
# TARGET's include path; the .spv files lie beside them for tests that reflect them.
# - A shader given as FILE:NAME:DEFINE[:DEFINE...] is compiled under another name with macros.
# - Shaders may include the library's files, and those in the given folders.
# Compiled for Vulkan 1.2, so that hosts need not enable maintenance4 (SPIR-V 1.6 writes the work group size as ids).
#
# This file is part of the installed package, too. GNOMON_SHADER_INCLUDE_DIR is set before it is included.
find_program(GLSLC glslc HINTS ENV VULKAN_SDK PATH_SUFFIXES bin)

function(gnomon_add_shaders target)
    if(NOT GLSLC)
        message(FATAL_ERROR "gnomon_add_shaders() needs glslc, which was not found. Install it (the package 'glslc' of "
                            "Debian and Ubuntu, or the Vulkan SDK), or set GLSLC to its path.")
    endif()
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "" INCLUDES)
    set(options --target-env=vulkan1.2 -O -I${GNOMON_SHADER_INCLUDE_DIR})
    foreach(folder ${arg_INCLUDES})
        get_filename_component(folder ${folder} ABSOLUTE)
        list(APPEND options -I${folder})
    endforeach()
    set(dir ${CMAKE_CURRENT_BINARY_DIR}/shaders)
    file(MAKE_DIRECTORY ${dir})
    foreach(entry ${arg_UNPARSED_ARGUMENTS})
        string(REGEX MATCH "^([A-Za-z]:[/\\])?[^:]*" source ${entry})  # C:/a.comp is a path
        string(LENGTH ${source} length)
        string(SUBSTRING ${entry} ${length} -1 parts)
        string(REGEX MATCHALL "[^:]+" defines "${parts}")
        get_filename_component(source ${source} ABSOLUTE)
        get_filename_component(name ${source} NAME_WE)
        if(defines)
            list(POP_FRONT defines name)
            list(TRANSFORM defines PREPEND -D)
        endif()
        set(spv ${dir}/${name}.spv)
        add_custom_command(
            OUTPUT ${spv} ${spv}.h
            COMMAND ${GLSLC} ${options} ${defines} -MD -MF ${spv}.d -MT ${spv} -o ${spv} ${source}
            COMMAND ${GLSLC} ${options} ${defines} -mfmt=num -o ${spv}.h ${source}
            DEPENDS ${source}
            DEPFILE ${spv}.d
            COMMENT "Shader ${name}"
            VERBATIM)
        target_sources(${target} PRIVATE ${spv}.h)
    endforeach()
    target_include_directories(${target} PRIVATE ${dir})
endfunction()
