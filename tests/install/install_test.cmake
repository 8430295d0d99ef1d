# The library as hosts get it: installed, copied around, and found by a host outside of this tree.
#
# Problem: a package works where it was made, and lacks a file, names a folder or hides a symbol everywhere else.
# Here: the package goes to a folder of its own, examples/minimal_host is copied out of the tree and built against it,
# and its picture is compared with the one that the same program draws inside the tree.
#     FLAVOUR  package       find_package(), static, this build's compiler
#              shared_clang  find_package(), shared, the library alone and from scratch, Clang
#              subdirectory  add_subdirectory(), no package
# Variables: see tests/CMakeLists.txt. What a failure leaves lies in the folder that is printed first.
cmake_minimum_required(VERSION 3.25)
set(tmp $ENV{TMPDIR})
if(NOT tmp)
    set(tmp /tmp)
endif()
string(MD5 id ${BUILD_DIR})
string(SUBSTRING ${id} 0 8 id)
set(root ${tmp}/gnomon_install_${id}_${FLAVOUR})
set(prefix ${root}/prefix)
message("In ${root}")
file(REMOVE_RECURSE ${root})

# Runs a command; its failure is the test's.
function(run)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
    if(NOT code EQUAL 0)
        list(JOIN ARGN " " command)
        string(STRIP "${out}" out)
        message(FATAL_ERROR "'${command}' ended with ${code}:\n${out}")
    endif()
endfunction()

# Configures and builds a project; any warning is an error.
function(build source binary)
    run(${CMAKE_COMMAND} -S ${source} -B ${binary} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX}
        -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} -DCMAKE_BUILD_TYPE=Release -DCMAKE_COMPILE_WARNING_AS_ERROR=ON
        ${ARGN})
    run(${CMAKE_COMMAND} --build ${binary} --config Release --parallel 2)
endfunction()

# Every include of an installed file is of an installed file, of the C++ standard library, or of Vulkan.
function(check_includes folder)
    file(GLOB_RECURSE files ${folder}/*)
    if(NOT files)
        message(FATAL_ERROR "${folder} is empty.")
    endif()
    foreach(file ${files})
        file(STRINGS ${file} lines REGEX "^[ \t]*#[ \t]*include")
        foreach(line ${lines})
            if(line MATCHES "include[ \t]*\"([^\"]*)\"")
                if(NOT EXISTS ${folder}/${CMAKE_MATCH_1} AND NOT CMAKE_MATCH_1 STREQUAL gnomon_host_provider.glsl)
                    message(FATAL_ERROR "${file} includes '${CMAKE_MATCH_1}', which is not installed.")
                endif()
            elseif(NOT line MATCHES "include[ \t]*<([a-z_]+|vulkan/vulkan_core\\.h)>")
                message(FATAL_ERROR "${file} says '${line}': hosts may not have that.")
            endif()
        endforeach()
    endforeach()
endfunction()

# What a header declares and the library defines is marked for shared libraries.
function(check_marks)
    file(GLOB headers ${prefix}/include/gnomon/*.h)
    foreach(header ${headers})
        file(STRINGS ${header} lines REGEX "^(class [A-Z].* {|[A-Za-z].*\\) noexcept[;]?)$")
        foreach(line ${lines})
            if(NOT line MATCHES "GNOMON_API")
                message(FATAL_ERROR "${header}: '${line}' lacks GNOMON_API.")
            endif()
        endforeach()
    endforeach()
endfunction()

# A package can be moved to another machine: nothing in it names a folder of this one.
function(check_no_folder_named)
    file(GLOB_RECURSE files ${prefix}/*)
    foreach(folder ${SOURCE_DIR} ${BUILD_DIR} ${root})
        string(REGEX REPLACE "([][+.*()^$?|\\])" "\\\\\\1" pattern ${folder})
        foreach(file ${files})
            file(STRINGS ${file} found REGEX ${pattern} LIMIT_COUNT 1)
            if(found)
                message(FATAL_ERROR "${file} names ${folder}: ${found}")
            endif()
        endforeach()
    endforeach()
endfunction()

# A shared library shows the public face and nothing else.
function(check_symbols)
    file(GLOB library ${prefix}/lib*/libgnomon.so ${prefix}/lib/*/libgnomon.so)
    if(NOT NM OR NOT library)
        message(FATAL_ERROR "Found no libgnomon.so, or no nm to look at it.")
    endif()
    execute_process(COMMAND ${NM} -DC --defined-only ${library} OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
    if(NOT symbols MATCHES "gnomon::View::beginFrame")
        message(FATAL_ERROR "${library} does not show View::beginFrame().")
    endif()
    # Weak symbols are the standard library's templates.
    string(REGEX MATCHALL "[^\n]* T ([^\n(]*::State::|gnomon::gpu::|[^g][^n])[^\n(]*" inside "${symbols}")
    if(inside)
        message(FATAL_ERROR "${library} shows what is its own (GNOMON_HIDDEN is missing): ${inside}")
    endif()
endfunction()

# Phase 4 of the package, with a visibility provider of the host's own.
function(check_host_provider)
    set(shaders ${prefix}/share/gnomon/shaders)
    run(${GLSLC} --target-env=vulkan1.2 -I${shaders} -I${SOURCE_DIR}/tests/gpu/tiled_shadows/host_provider
        -DGNOMON_HOST_PROVIDER -o ${root}/phase4.spv ${shaders}/generate_shadows/filter_pairs.comp)
endfunction()

# Runs a script that must fail with a sentence.
function(check_refusal name sentence script)
    file(WRITE ${root}/${name}.cmake "${script}")
    execute_process(COMMAND ${CMAKE_COMMAND} ${ARGN} -P ${root}/${name}.cmake RESULT_VARIABLE code ERROR_VARIABLE out)
    string(REGEX REPLACE "[ \n]+" " " out "${out}")
    if(code EQUAL 0 OR NOT out MATCHES "${sentence}")
        message(FATAL_ERROR "${name}: expected '${sentence}', got ${code}: ${out}")
    endif()
endfunction()

function(check_refusals)
    file(GLOB_RECURSE helper ${prefix}/*/shaders.cmake)
    check_refusal(no_glslc "needs glslc, which was not found"
        "include(${helper})\ngnomon_add_shaders(host light.comp)"
        -DCMAKE_FIND_USE_SYSTEM_ENVIRONMENT_PATH=OFF -DCMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF)
    check_refusal(other_version "Could not find a configuration file for package \"gnomon\" that is compatible"
        "find_package(gnomon 0.999 CONFIG REQUIRED PATHS ${prefix} NO_DEFAULT_PATH)")
endfunction()

# The host draws, on the first Vulkan device, the very picture that the tree's own program drew there.
function(check_picture program)
    set(picture ${root}/picture.ppm)
    run(${program} ${picture})
    if(NOT EXISTS ${picture})
        message(FATAL_ERROR "${program} drew nothing.")
    endif()
    file(SIZE ${picture} bytes)
    file(SHA256 ${picture} here)
    file(SHA256 ${EXPECTED} there)
    if(bytes LESS 10000 OR NOT here STREQUAL there)
        message(FATAL_ERROR "${picture} (${bytes} bytes) is not the picture of the tree's own program, ${EXPECTED}.")
    endif()
endfunction()

if(FLAVOUR STREQUAL shared_clang)
    find_program(CLANG NAMES clang++ clang++-19 clang++-18 clang++-17 clang++-16 clang++-15 clang++-14)
    if(NOT CLANG)
        message("skipped: no Clang is installed")
        return()
    endif()
    set(CXX ${CLANG})
endif()

file(COPY ${SOURCE_DIR}/examples/minimal_host DESTINATION ${root})
if(FLAVOUR STREQUAL subdirectory)
    file(WRITE ${root}/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)\nproject(engine LANGUAGES CXX)\n"
        "add_subdirectory(${SOURCE_DIR} gnomon)\nadd_subdirectory(minimal_host)\n")
    build(${root} ${root}/build -DCMAKE_BUILD_TYPE=Debug)  # for a change, and quick
    check_picture(${root}/build/minimal_host/minimal_host)
else()
    set(library ${root}/library)
    if(FLAVOUR STREQUAL package AND IS_RELEASE)
        set(library ${BUILD_DIR})  # else made anew: debug information names folders, and sanitizers want sanitized hosts
    elseif(FLAVOUR STREQUAL package)
        build(${SOURCE_DIR} ${library} -DGNOMON_LIBRARY_ONLY=ON)
    else()
        build(${SOURCE_DIR} ${library} -DGNOMON_LIBRARY_ONLY=ON -DBUILD_SHARED_LIBS=ON)
        set(is_shared YES)
    endif()
    run(${CMAKE_COMMAND} --install ${library} --prefix ${prefix} --config Release)
    check_includes(${prefix}/include)
    check_includes(${prefix}/share/gnomon/shaders)
    check_marks()
    check_no_folder_named()
    check_host_provider()
    check_refusals()
    if(is_shared)
        check_symbols()
    endif()
    # Warnings in the package's headers count as well.
    build(${root}/minimal_host ${root}/build -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_NO_SYSTEM_FROM_IMPORTED=ON
        "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Wno-missing-field-initializers")
    check_picture(${root}/build/minimal_host)
endif()
file(REMOVE_RECURSE ${root})
