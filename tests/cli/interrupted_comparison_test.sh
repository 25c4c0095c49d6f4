#!/usr/bin/env bash
# An interrupted comparison ends with 128 + signal and leaves no report, neither partial nor complete.
# Usage: interrupted_comparison_test.sh RICOCHET FOLDER
set -euo pipefail
ricochet="$1"
folder="$2"

fail() {
    echo "FAILED: $1"
    exit 1
}

rm -rf "$folder"
mkdir -p "$folder"
cat >"$folder/scene.json" <<'SCENE'
{
  "ricochet": 1,
  "simulation": {"time_step": 0.001, "duration": 1e5},
  "materials": {"plain": {"restitution": 1}},
  "colliders": [{"name": "floor", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "material": "plain"}],
  "particles": [{"position": [0, 0, 1], "velocity": [0, 0, -1]}]
}
SCENE

for signal in INT TERM; do
    "$ricochet" compare "$folder/scene.json" --output "$folder/out" >"$folder/out.txt" 2>"$folder/err.txt" &
    comparison=$!
    until [[ -f "$folder/out/.ricochet-run" ]]; do
        kill -0 "$comparison" 2>/dev/null || fail "it ended early: $(cat "$folder/err.txt")"
        sleep 0.05
    done
    kill "-$signal" "$comparison"
    code=0
    wait "$comparison" || code=$?
    [[ "$signal" == INT ]] && expected=130 || expected=143
    ((code == expected)) || fail "exit code $code after SIG$signal: $(cat "$folder/err.txt")"
    [[ ! -s "$folder/err.txt" && ! -s "$folder/out.txt" ]] || fail "it printed something"
    [[ "$(ls -A "$folder/out")" == .ricochet-run ]] || fail "it left files: $(ls -A "$folder/out")"
done
echo "interrupted comparisons leave nothing behind"
