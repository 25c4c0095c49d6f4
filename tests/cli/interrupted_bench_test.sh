#!/usr/bin/env bash
# An interrupted measurement ends with 128 + signal and leaves no file, neither partial nor complete.
# Usage: interrupted_bench_test.sh RICOCHET FOLDER
set -euo pipefail
ricochet="$1"
folder="$2"

fail() {
    echo "FAILED: $1"
    exit 1
}

for signal in INT TERM; do
    rm -rf "$folder"
    mkdir -p "$folder/files"
    "$ricochet" bench --repeats 1000 --json "$folder/files/bench.json" --write-ratios "$folder/files/ratios.json" \
        >"$folder/out.txt" 2>"$folder/err.txt" &
    bench=$!
    until [[ -n "$(ls -A "$folder/files")" ]]; do
        kill -0 "$bench" 2>/dev/null || fail "it ended early: $(cat "$folder/err.txt")"
        sleep 0.05
    done
    kill "-$signal" "$bench"
    code=0
    wait "$bench" || code=$?
    [[ "$signal" == INT ]] && expected=130 || expected=143
    ((code == expected)) || fail "exit code $code after SIG$signal: $(cat "$folder/err.txt")"
    [[ ! -s "$folder/err.txt" ]] || fail "it complained: $(cat "$folder/err.txt")"
    [[ -z "$(ls -A "$folder/files")" ]] || fail "it left files: $(ls -A "$folder/files")"
done
echo "interrupted measurements leave nothing behind"
