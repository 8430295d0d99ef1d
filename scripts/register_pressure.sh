#!/usr/bin/env bash
# Prints registers, shared memory and occupancy of every compute pipeline on an AMD RDNA2 GPU that need not be there:
# Mesa's RADV compiles for its null device. Needs a build: cmake --preset release && cmake --build --preset release
#   scripts/register_pressure.sh [FAMILY]    as Mesa names them: navi21 (the default), navi10 ...
#   scripts/register_pressure.sh --write     puts the tables into docs/register-pressure.md
set -euo pipefail
cd "$(dirname "$0")/.."
family=navi21
write=
case "${1:-}" in
    --write) write=1 ;;
    ?*) family=$1 ;;
esac
manifest=$(ls /usr/share/vulkan/icd.d/radeon_icd*.json /etc/vulkan/icd.d/radeon_icd*.json 2>/dev/null | head -n 1 || true)
if [ -z "$manifest" ]; then
    echo "RADV is not installed: apt-get install mesa-vulkan-drivers." >&2
    exit 1
fi
if [ ! -x build/release/bin/pipeline_report ]; then
    echo "build/release/bin/pipeline_report is missing: cmake --preset release && cmake --build --preset release." >&2
    exit 1
fi
report() {
    RADV_FORCE_FAMILY="$family" VK_DRIVER_FILES="$manifest" VK_ICD_FILENAMES="$manifest" build/release/bin/pipeline_report
}
if [ -z "$write" ]; then
    report
    exit
fi
tables=$(report)
page=docs/register-pressure.md
text=$(sed '/^## The tables$/q' "$page")
printf '%s\n\n%s\n' "$text" "$tables" >"$page"
