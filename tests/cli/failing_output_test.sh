#!/usr/bin/env bash
# A run whose frames cannot be written ends with one line and exit code 1, and leaves only complete files.
# Usage: failing_output_test.sh RICOCHET FOLDER
set -euo pipefail
ricochet="$1"
folder="$2"

fail() {
    echo "FAILED: $1"
    exit 1
}

# expect_one_line NAME WORDS
expect_one_line() {
    (($(wc -l <"$folder/$1.err") == 1)) || fail "not one line on stderr: $(cat "$folder/$1.err")"
    grep -q "$2" "$folder/$1.err" || fail "not '$2': $(cat "$folder/$1.err")"
    [[ ! -s "$folder/$1.out" ]] || fail "something on stdout: $(cat "$folder/$1.out")"
}

rm -rf "$folder"
mkdir -p "$folder"
cat >"$folder/scene.json" <<'SCENE'
{
  "ricochet": 1,
  "simulation": {"time_step": 0.001, "duration": 1e6},
  "materials": {"plain": {"restitution": 1}},
  "colliders": [{"name": "floor", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "material": "plain"}],
  "emitters": [{"type": "box", "center": [0, 0, 2], "size": [1, 1, 1], "start": 0.0105, "burst": 2000}],
  "output": {"every": 5, "contacts": true}
}
SCENE

# The frames after the burst exceed the limit of file sizes. To the program this looks like a full disk. The signal of
# this limit must not end the program.
code=0
(
    ulimit -f 64
    exec "$ricochet" run "$folder/scene.json" --output "$folder/full" --quiet
) >"$folder/full.out" 2>"$folder/full.err" || code=$?
((code == 1)) || fail "exit code $code with a full disk: $(cat "$folder/full.err")"
expect_one_line full 'particles_000015.vtp: cannot write the file'
[[ -f "$folder/full/particles_000010.vtp" ]] || fail "the frames before the full disk are missing"
grep -q 'particles_000010.vtp' "$folder/full/particles.pvd" || fail "the last good frame is not listed"
! grep -q 'particles_000015.vtp' "$folder/full/particles.pvd" || fail "a frame that was not written is listed"
[[ ! -e "$folder/full/summary.json" ]] || fail "a run that failed has a summary"
if compgen -G "$folder/full/*.partial" >/dev/null; then fail "half-written files are left"; fi

# The folder is removed during a run that would take hours.
"$ricochet" run "$folder/scene.json" --output "$folder/moved" --quiet >"$folder/moved.out" 2>"$folder/moved.err" &
run=$!
until [[ -f "$folder/moved/particles_000015.vtp" ]]; do
    kill -0 "$run" 2>/dev/null || fail "the run ended early: $(cat "$folder/moved.err")"
    sleep 0.02
done
mv "$folder/moved" "$folder/elsewhere"
code=0
wait "$run" || code=$?
((code == 1)) || fail "exit code $code after the folder has gone: $(cat "$folder/moved.err")"
expect_one_line moved 'cannot \(create\|name\) the file'
echo "runs that cannot write end with one line"
