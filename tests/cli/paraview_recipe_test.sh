#!/usr/bin/env bash
# Usage: paraview_recipe_test.sh RICOCHET PROJECT FOLDER PVPYTHON
# Makes a run. Draws it with the lines of docs/output-files.md and with the script beside them. Exit code 77 if
# ParaView, or a virtual screen for it, is not installed.
set -euo pipefail
ricochet="$1" project="$2" folder="$3" pvpython="$4"
if [[ ! -x "$pvpython" ]] || ! command -v xvfb-run >/dev/null || ! command -v xauth >/dev/null; then
    echo "skipped: ParaView's pvpython, or xvfb, is not installed (Debian: paraview, python3-paraview, xvfb, xauth)"
    exit 77
fi
# All programs share one screen. With -noreset it does not restart when a program exits, which could break the start of
# the next program.
if [[ -z "${RICOCHET_TEST_SCREEN:-}" ]]; then
    RICOCHET_TEST_SCREEN=1 exec xvfb-run -a -s '-screen 0 1280x1024x24 -noreset' bash "$0" "$@"
fi
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"
"$ricochet" run "$project/scenes/marbles.json" --output run --quiet --set simulation.duration=1.5

# Extracts the indented lines from "from paraview.simple" to the first empty one.
sed -n '/^    from paraview.simple/,/^$/p' "$project/docs/output-files.md" | sed 's/^    //; s/DIR/run/' > recipe.py
[[ $(wc -l < recipe.py) -gt 10 ]] || { echo "no recipe in docs/output-files.md"; exit 1; }
"$pvpython" recipe.py
script() { "$pvpython" "$project/python/paraview/run_picture.py" "$@"; }
script run script.png
script run empty.png --time 0 2> empty.txt
grep -q 'no particles at 0' empty.txt
if script run wrong.png --color blub 2> wrong.txt; then echo "a wrong array was taken"; exit 1; fi
grep -q 'no array blub in the frames; there are: age,' wrong.txt
"$pvpython" "$project/tests/cli/paraview_pictures_test.py" picture.png script.png empty.png
