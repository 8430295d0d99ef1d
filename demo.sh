#!/usr/bin/env bash
# Builds everything and renders the courtyard into out/. Sets a fresh Debian or Ubuntu machine up first.
set -euo pipefail
cd "$(dirname "$0")"
. scripts/common.sh
gnomon=build/release/bin/gnomon

step "Looking for packages that are missing"
scripts/install_dependencies.sh

step "Building (a few minutes the first time; log in build/demo.log)"
build() { cmake --preset release && cmake --build --preset release --target gnomon_program --parallel "$(nproc)"; }
quietly build/demo.log build

step "Looking for Vulkan devices"
devices=$("$gnomon" devices)
echo "$devices"
size=960x540  # a software device takes seconds for larger pictures
if grep -q ' GPU, ' <<<"$devices"; then size=1280x720; fi

mkdir -p out
step "Rendering the courtyard at $size with deferred shadows"
"$gnomon" render courtyard --size "$size" --frames 3 --list-entries 250000 -o out/courtyard.png --stats out/courtyard.json
for camera in arcade fountain; do
    step "Rendering the camera '$camera'"
    quietly "build/demo-$camera.log" "$gnomon" render courtyard --camera "$camera" --size "$size" -o "out/courtyard_$camera.png"
done

step "Rendering the same with shadows inside the lighting shader, for comparison"
quietly build/demo-inline.log "$gnomon" render courtyard --shadows inline --frames 3 --size "$size" \
    --list-entries 250000 -o out/courtyard_inline.png
step "Deferred against inline"
"$gnomon" compare out/courtyard.png out/courtyard_inline.png --tolerance 1

step "Done"
echo "The pictures are $PWD/out/courtyard.png, courtyard_arcade.png and courtyard_fountain.png, and deferred and inline shadows agree."
