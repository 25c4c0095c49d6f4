#!/usr/bin/env bash
# A run that is interrupted, and one that is killed, leave a folder that VTK's own readers open.
# interrupted_run_test.sh RICOCHET FOLDER [PYTHON READER_TEST]
set -euo pipefail
ricochet="$1"
folder="$2"
reader=("${@:3}")

fail() {
    echo "FAILED: $1"
    exit 1
}

# Starts a run that would go on for hours, waits for its third frame, sends the signal, sets `code`.
run_and_signal() {
    "$ricochet" run "$folder/scene.json" --output "$folder/$1" >"$folder/$1.out" 2>"$folder/$1.err" &
    local run=$!
    until [[ -f "$folder/$1/particles_000002.vtp" ]]; do
        kill -0 "$run" 2>/dev/null || fail "the run ended early: $(cat "$folder/$1.err")"
        sleep 0.05
    done
    kill "-$2" "$run"
    code=0
    wait "$run" || code=$?
}

# open_with_vtk FOLDER [--killed]
open_with_vtk() {
    ((${#reader[@]} > 0)) || return 0
    local code=0
    "${reader[@]}" "$folder/$1" "${@:2}" || code=$?
    if ((code == 77)); then return 0; fi
    ((code == 0)) || fail "VTK does not open $1"
}

rm -rf "$folder"
mkdir -p "$folder"
cat >"$folder/scene.json" <<'SCENE'
{
  "ricochet": 1,
  "simulation": {"time_step": 0.001, "duration": 1e6},
  "materials": {"plain": {"restitution": 1}},
  "colliders": [{"name": "floor", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "material": "plain"}],
  "particles": [{"position": [0, 0, 1], "velocity": [0, 0, -1]}],
  "output": {"every": 1, "contacts": true}
}
SCENE

run_and_signal interrupted INT
((code == 130)) || fail "exit code $code after an interrupt: $(cat "$folder/interrupted.err")"
grep -q '"interrupted": true' "$folder/interrupted/summary.json" || fail "the summary does not say it was interrupted"
grep -q '(interrupted)' "$folder/interrupted.out" || fail "the report does not say it was interrupted"
[[ ! -s "$folder/interrupted.err" ]] || fail "something on stderr: $(cat "$folder/interrupted.err")"
if compgen -G "$folder/interrupted/*.partial" >/dev/null; then fail "half-written files are left"; fi
steps="$(sed -nE 's/^ *"steps": ([0-9]+),$/\1/p' "$folder/interrupted/summary.json")"
[[ -f "$folder/interrupted/particles_$(printf '%06d' "$steps").vtp" ]] || fail "the final state is no frame"
open_with_vtk interrupted

run_and_signal terminated TERM
((code == 143)) || fail "exit code $code after SIGTERM"
open_with_vtk terminated

run_and_signal killed KILL
((code == 137)) || fail "exit code $code after SIGKILL"
open_with_vtk killed --killed
"$ricochet" render "$folder/killed" --output "$folder/killed.png" --frame 2 --size 32x32 --samples 1 >/dev/null ||
    fail "the killed run cannot be drawn"
# The folder is free again.
"$ricochet" run "$folder/scene.json" --set simulation.duration=0.01 --output "$folder/killed" --quiet ||
    fail "the killed run's folder cannot be used again"
open_with_vtk killed
echo "interrupted, terminated and killed runs can be opened"
