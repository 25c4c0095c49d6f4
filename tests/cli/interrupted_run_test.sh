#!/usr/bin/env bash
# Interrupted and killed runs leave a folder that VTK's own readers can open.
# Usage: interrupted_run_test.sh RICOCHET FOLDER [PYTHON READER_TEST]
set -euo pipefail
ricochet="$1"
folder="$2"
reader=("${@:3}")

fail() {
    echo "FAILED: $1"
    exit 1
}

# Starts a run that would take hours, waits for its third frame, sends the signal and sets `code`.
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

# A run that was interrupted twice and killed once ends in the same bits as an uninterrupted run.
cat >"$folder/resumed.json" <<'SCENE'
{
  "ricochet": 1,
  "simulation": {"time_step": 0.001, "duration": 1.5, "seed": 5},
  "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
  "attributes": {"charge": {"default": 1.5}},
  "materials": {"plain": {"restitution": 0.8, "diffuse": 0.3}},
  "frames": {"hub": {"motions": [{"type": "spin", "axis": [0, 0, 1], "rate": 200}]}},
  "colliders": [{"name": "floor", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "material": "plain"},
                {"name": "paddle", "type": "box", "size": [0.8, 0.02, 0.2], "frame": "hub", "material": "plain",
                 "motion": [{"time": 0, "position": [0, 0, 0.1]}, {"time": 1, "position": [0.1, 0, 0.15]}]}],
  "emitters": [{"type": "box", "center": [0, 0, 0.5], "size": [1, 1, 0.4], "burst": 500, "rate": 400}],
  "output": {"every": 50, "contacts": true, "checkpoint_every": 100}
}
SCENE
"$ricochet" run "$folder/resumed.json" --output "$folder/whole" --output-state "$folder/whole.csv" --quiet
[[ ! -e "$folder/whole/checkpoint.bin" ]] || fail "a finished run leaves a checkpoint"
more=()
for signal in INT KILL INT; do
    before="$(compgen -G "$folder/resumed/particles_*.vtp" | wc -l || true)"
    "$ricochet" run "$folder/resumed.json" --output "$folder/resumed" "${more[@]}" --quiet 2>"$folder/resumed.err" &
    run=$!
    until (($(compgen -G "$folder/resumed/particles_*.vtp" | wc -l) > before + 3)) || ! kill -0 "$run" 2>/dev/null; do
        sleep 0.01
    done
    kill "-$signal" "$run" 2>/dev/null || true
    wait "$run" || true
    [[ -f "$folder/resumed/checkpoint.bin" ]] || break
    more=(--resume)
done
if [[ -f "$folder/resumed/checkpoint.bin" ]]; then
    "$ricochet" run "$folder/resumed.json" --output "$folder/resumed" --resume --output-state "$folder/resumed.csv" \
        --quiet --threads 1
    cmp "$folder/whole.csv" "$folder/resumed.csv" || fail "a resumed run ends in another state"
    cmp "$folder/whole/particles_001500.vtp" "$folder/resumed/particles_001500.vtp" || fail "the last frames differ"
    for frame in "$folder"/whole/particles_*.vtp; do
        cmp "$frame" "$folder/resumed/$(basename "$frame")" || fail "a frame of a resumed run differs"
        grep -q "$(basename "$frame")" "$folder/resumed/particles.pvd" || fail "a frame is missing in the series"
    done
    grep -q '"interrupted": false' "$folder/resumed/summary.json" || fail "the resumed run was not finished"
    for frame in "$folder"/whole/moving_*.vtp; do
        cmp "$frame" "$folder/resumed/$(basename "$frame")" || fail "a moving collider of a resumed run differs"
        grep -q "$(basename "$frame")" "$folder/resumed/moving.pvd" || fail "a moving collider is missing in the series"
    done
    for file in "$folder"/whole/collider_*.vtp; do
        cmp "$file" "$folder/resumed/$(basename "$file")" || fail "a collider's totals differ after a resume"
    done
    cmp "$folder/whole/colliders.pvd" "$folder/resumed/colliders.pvd" || fail "the series of colliders differs"
    open_with_vtk resumed --attribute charge
else
    echo "the run was too fast to be interrupted: resuming was not tried"
fi
code=0
"$ricochet" run "$folder/resumed.json" --output "$folder/interrupted" --resume 2>"$folder/other.err" || code=$?
((code == 2)) || fail "exit code $code after resuming with another scene"
grep -q 'the scene, or a file that it reads, is not the one that was interrupted' "$folder/other.err" || fail "$(cat "$folder/other.err")"

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
