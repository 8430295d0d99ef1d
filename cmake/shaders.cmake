# gnomon_add_shaders(TARGET [DEFINES ...] SHADERS file ...)
# Compiles each GLSL file to SPIR-V and to a header NAME.spv.h that holds it as a list of words. The headers are on
# TARGET's include path; the .spv files lie beside them for tests that reflect them.
# A shader given as FILE:NAME:DEFINE[:DEFINE...] is compiled under another name with macros.
# Compiled for Vulkan 1.2, so that hosts need not enable maintenance4 (SPIR-V 1.6 writes the work group size as ids).
find_program(GLSLC glslc REQUIRED)
set(GNOMON_SHADER_INCLUDE_DIR ${CMAKE_SOURCE_DIR}/src)

function(gnomon_add_shaders target)
    set(outputs)
    foreach(entry ${ARGN})
        string(REPLACE ":" ";" parts ${entry})
        list(POP_FRONT parts source)
        get_filename_component(name ${source} NAME_WE)
        get_filename_component(kind ${source} LAST_EXT)
        set(flags)
        if(parts)
            list(POP_FRONT parts name)
            foreach(define ${parts})
                list(APPEND flags -D${define})
            endforeach()
        endif()
        set(source ${CMAKE_CURRENT_SOURCE_DIR}/${source})
        set(dir ${CMAKE_CURRENT_BINARY_DIR}/shaders)
        set(spv ${dir}/${name}.spv)
        set(header ${dir}/${name}.spv.h)
        file(MAKE_DIRECTORY ${dir})
        add_custom_command(
            OUTPUT ${spv} ${header}
            COMMAND ${GLSLC} --target-env=vulkan1.2 -O -I${GNOMON_SHADER_INCLUDE_DIR} -I${CMAKE_SOURCE_DIR} ${flags} -MD -MF ${spv}.d -MT ${spv} -o ${spv} ${source}
            COMMAND ${GLSLC} --target-env=vulkan1.2 -O -mfmt=num -I${GNOMON_SHADER_INCLUDE_DIR} -I${CMAKE_SOURCE_DIR} ${flags} -o ${header} ${source}
            DEPENDS ${source}
            DEPFILE ${spv}.d
            COMMENT "Shader ${name}"
            VERBATIM)
        list(APPEND outputs ${header})
    endforeach()
    target_sources(${target} PRIVATE ${outputs})
    target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/shaders)
endfunction()
