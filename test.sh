#!/usr/bin/env bash
# Builds everything with AddressSanitizer and UndefinedBehaviorSanitizer and runs all tests on every Vulkan device found.
#   ./test.sh          what every change must pass
#   ./test.sh --full   the long tests too
# Sets a fresh Debian or Ubuntu machine up first.
set -euo pipefail
cd "$(dirname "$0")"
. scripts/common.sh
case "${1:-}" in
    "") ;;
    --full) export GNOMON_FULL=1 ;;
    *)
        trap - EXIT
        echo "There is no option '$1': ./test.sh takes --full or nothing." >&2
        exit 2
        ;;
esac

step "Looking for packages that are missing"
scripts/install_dependencies.sh --test

step "Building with sanitizers (some minutes the first time; log in build/test.log)"
build() { cmake --preset sanitize && cmake --build --preset sanitize --parallel "$(nproc)"; }
quietly build/test.log build

# SwiftShader beside the installed drivers.
swiftshader=/usr/lib/chromium/vk_swiftshader_icd.json
if [ -e "$swiftshader" ]; then
    export VK_ADD_DRIVER_FILES="$swiftshader${VK_ADD_DRIVER_FILES:+:$VK_ADD_DRIVER_FILES}"
fi
cc -shared -fPIC -o build/keep_drivers.so scripts/keep_drivers.c
export ASAN_OPTIONS="detect_leaks=1:verify_asan_link_order=0:${ASAN_OPTIONS:-}"
export LSAN_OPTIONS="suppressions=$PWD/scripts/lsan.supp:print_suppressions=0:${LSAN_OPTIONS:-}"
export UBSAN_OPTIONS="print_stacktrace=1:${UBSAN_OPTIONS:-}"

export LD_PRELOAD="$PWD/build/keep_drivers.so"

step "Vulkan devices"
build/sanitize/bin/gnomon devices

step "Testing"
# Two programs at a time: software devices compile shaders on one core, and that is most of what the image tests wait for.
ctest --test-dir build/sanitize --output-on-failure --parallel 2
log=build/sanitize/Testing/Temporary/LastTest.log
if grep -qE '^(without validation|skipped:? validation)' "$log"; then
    echo "Some tests found no validation layer, so they prove less than they should." >&2
    exit 1
fi
# ctest counts a program that skipped some of its cases as passed: say which.
grep -h '^\[  SKIPPED \]' "$log" | sort -u || true
step "All tests are done"
