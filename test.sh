#!/usr/bin/env bash
# Builds everything with AddressSanitizer and UndefinedBehaviorSanitizer and runs all tests on every Vulkan device found.
# Those that take long are built and run without sanitizers, but with the standard library's assertions.
#   ./test.sh          what every change must pass
#   ./test.sh --full   the long tests too, and all of them with sanitizers
# Sets a fresh Debian or Ubuntu machine up first.
set -euo pipefail
cd "$(dirname "$0")"
. scripts/common.sh
full=
case "${1:-}" in
    "") export GNOMON_QUICK=1 ;;
    --full) full=1 GNOMON_FULL=1; export GNOMON_FULL ;;
    *)
        trap - EXIT
        echo "There is no option '$1': ./test.sh takes --full or nothing." >&2
        exit 2
        ;;
esac

step "Looking for packages that are missing"
scripts/install_dependencies.sh --test

# build PRESET TARGET...
build() { cmake --preset "$1" && cmake --build --preset "$1" --parallel "$(nproc)" --target "${@:2}"; }
step "Building with sanitizers (some minutes the first time; log in build/test.log)"
quietly build/test.log build sanitize all ${full:+long_tests}
if [ -z "$full" ]; then
    step "Building the long tests without sanitizers (log in build/test.log)"
    quietly build/test.log build check long_tests
fi

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
export GALLIVM_PERF=nopt  # lavapipe then compiles shaders a third faster, which is most of what the tests wait for

step "Vulkan devices"
build/sanitize/bin/gnomon devices

# Two programs at a time: software devices compile shaders on one core, and that is most of what the image tests wait for.
# run_tests PRESET CTEST_OPTION...
run_tests() {
    ctest --test-dir "build/$1" --output-on-failure --parallel 2 "${@:2}"
    local log="build/$1/Testing/Temporary/LastTest.log"
    if grep -qE '^(without validation|skipped:? validation)' "$log"; then
        echo "Some tests found no validation layer, so they prove less than they should." >&2
        exit 1
    fi
    # ctest counts a program that skipped some of its cases as passed: say which.
    grep -h '^\[  SKIPPED \]' "$log" | sort -u || true
}
if [ -n "$full" ]; then
    step "Testing"
    run_tests sanitize
else
    step "Testing with sanitizers"
    run_tests sanitize --label-exclude long
    step "Testing what takes long"
    run_tests check --label-regex long
fi
step "All tests are done"
