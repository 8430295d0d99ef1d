#!/usr/bin/env bash
# Installs the Debian or Ubuntu packages that a build needs, where they are missing.
#   scripts/install_dependencies.sh          to build and run
#   scripts/install_dependencies.sh --test   and what the tests can use besides
set -euo pipefail

needed=(
    g++ cmake ninja-build git                                 # to build
    glslc                                                     # shaders
    libvulkan-dev libvulkan-volk-dev libvulkan1               # Vulkan
    mesa-vulkan-drivers vulkan-validationlayers               # a software device, validation
    libglm-dev libtinygltf-dev libdraco-dev nlohmann-json3-dev # scenes
    libstb-dev libtinyexr-dev libxxhash-dev                   # pictures
    libembree-dev                                             # ray-traced truth
    libcli11-dev libfmt-dev libspdlog-dev                     # the program
    libgtest-dev libgmock-dev libbenchmark-dev                # tests, benchmarks
    libspirv-cross-c-shared-dev                               # tests of the shaders' interfaces
)

is_installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

# Prints the given packages that are not installed.
missing_of() {
    local package
    for package in "$@"; do
        is_installed "$package" || printf '%s\n' "$package"
    done
}

# Installs the packages in the array `missing`; false where that fails.
install_missing() {
    local as_root=()
    if [ "$(id -u)" != 0 ]; then
        command -v sudo >/dev/null || return 1
        as_root=(sudo)
    fi
    echo "Installing: ${missing[*]}"
    "${as_root[@]}" apt-get update -qq &&
        "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
    echo "This machine has no apt; please install the counterparts of these packages: ${needed[*]}" >&2
    exit 1
fi

mapfile -t missing < <(missing_of "${needed[@]}")
if [ "${#missing[@]}" != 0 ] && ! install_missing; then
    echo "These packages could not be installed from here; please install them as root and start again: ${missing[*]}" >&2
    exit 1
fi

# A second compiler for the tests; they say so where there is none.
if [ "${1:-}" = --test ] && ! command -v clang++ >/dev/null; then
    missing=(clang)
    install_missing || echo "Clang is not available here: nothing is compiled with it."
fi

# A second Vulkan implementation for the tests: SwiftShader, which Debian ships within Chromium. Ubuntu's chromium is a
# snap that has no such file, and the tests do without.
if [ "${1:-}" = --test ] && ! is_installed chromium; then
    missing=(chromium)
    if ! grep -q '^ID=debian' /etc/os-release || ! install_missing; then
        echo "SwiftShader is not available here: the tests run on the other Vulkan devices alone."
    fi
fi
