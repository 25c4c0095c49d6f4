#!/usr/bin/env bash
# Usage: blender_import_test.sh RICOCHET PROJECT FOLDER BLENDER
# Makes a run with moving colliders and opens it in Blender. Exit code 77 if Blender is not installed.
set -euo pipefail
ricochet="$1" project="$2" folder="$3" blender="$4"
if [[ ! -x "$blender" ]]; then
    echo "skipped: Blender is not installed (Debian: blender)"
    exit 77
fi
rm -rf "$folder"
mkdir -p "$folder"
"$ricochet" run "$project/scenes/sweeper.json" --output "$folder/run" --quiet --set simulation.duration=1
output="$("$blender" --background --factory-startup --python "$project/tests/cli/blender_import_test.py" -- \
    "$project/python/blender/ricochet_run.py" "$folder/run" "$folder/picture.png" 2>&1)" || true
if [[ "$output" != *RICOCHET-IMPORT-OK* ]]; then
    echo "$output"
    exit 1
fi
