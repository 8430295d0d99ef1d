# Everything beyond the library itself, with the least version each needs. The library needs Vulkan headers 1.3.239 and
# glslc 2023.2 alone (src/CMakeLists.txt, cmake/shaders.cmake). scripts/install_dependencies.sh installs all of them
# from Debian packages.
find_package(Threads REQUIRED)
find_path(VOLK_DIR volk.c REQUIRED)                    # libvulkan-volk-dev 1.3.239
find_package(glm 0.9.9 REQUIRED)                       # libglm-dev 0.9.9.8
find_package(TinyGLTF REQUIRED)                        # libtinygltf-dev 2.7
find_path(DRACO_DIR draco/compression/decode.h REQUIRED)
find_library(DRACO_LIBRARY draco REQUIRED)             # libdraco-dev 1.5
find_path(STB_DIR stb/stb_image_write.h REQUIRED)      # libstb-dev
find_package(tinyexr REQUIRED)                         # libtinyexr-dev 1.0
find_package(nlohmann_json 3.11 REQUIRED)              # nlohmann-json3-dev 3.11
find_package(CLI11 2.1 REQUIRED)                       # libcli11-dev 2.1
find_package(fmt 9.1 REQUIRED)                         # libfmt-dev 9.1
find_package(spdlog 1.10 REQUIRED)                     # libspdlog-dev 1.10
find_path(XXHASH_DIR xxhash.h REQUIRED)                # libxxhash-dev 0.8
find_path(EMBREE_DIR NAMES embree3/rtcore.h embree4/rtcore.h REQUIRED)  # libembree-dev 3.13 or 4
find_library(EMBREE_LIBRARY NAMES embree3 embree4 REQUIRED)
find_package(GTest 1.12 REQUIRED)                      # libgtest-dev 1.12
find_package(benchmark 1.7 REQUIRED)                   # libbenchmark-dev 1.7
