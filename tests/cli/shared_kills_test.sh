#!/usr/bin/env bash
# Kills processes of a shared run at random moments. No file is half-written under its name, and all files can be read.
# More or fewer other processes continue to the state of one process.
# Usage: shared_kills_test.sh RICOCHET MPIRUN SCENES FOLDER KILLS [SEED]
set -euo pipefail
ricochet="$1"
mpirun="$2"
# Open MPI 5 has no such option.
quiet=()
if "$mpirun" --quiet --version >/dev/null 2>&1; then quiet=(--quiet); fi
scene="$3/fountain.json"
folder="$4"
kills="$5"
seed="${6:-$((RANDOM * 32768 + RANDOM))}"
echo "seed: $seed"
RANDOM=$((seed % 32768))
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_btl_vader_single_copy_mechanism=none
export PRTE_ALLOW_RUN_AS_ROOT=1 PRTE_ALLOW_RUN_AS_ROOT_CONFIRM=1
cut=(--set simulation.duration=1.5 --set output.every=2 --set output.checkpoint_every=4 --set output.contacts=true)

fail() {
    echo "FAILED: $1"
    exit 1
}

# begin RANKS ARGUMENTS...: starts a run in the background; its processes write their ids to FOLDER/pid.RANK.
begin() {
    rm -f "$folder"/pid.*
    # shellcheck disable=SC2016  # the ranks fill these in
    "$mpirun" "${quiet[@]}" --map-by :OVERSUBSCRIBE -n "$1" bash -c 'echo $$ >"$0/pid.$OMPI_COMM_WORLD_RANK"; exec "$@"' \
        "$folder" "$ricochet" run "$scene" --output "$folder/run" --output-state "$folder/run.csv" "${cut[@]}" "${@:2}" \
        --threads 1 --quiet >"$folder/out" 2>&1 &
    run=$!
}

# Fails unless every file under a final name is complete.
expect_whole_files() {
    local file piece
    for file in "$folder/run"/*.vtp "$folder/run"/*.pvtp "$folder/run"/*.pvd; do
        [[ -e "$file" ]] || continue
        [[ "$(tail -c 11 "$file")" == "</VTKFile>" ]] || fail "$file is half-written"
    done
    for file in "$folder/run"/*.pvtp; do
        [[ -e "$file" ]] || continue
        grep -o 'Source="[^"]*"' "$file" | cut -d'"' -f2 | while read -r piece; do
            [[ -f "$folder/run/$piece" ]] || fail "$file lists $piece, which is not there"
        done
    done
    if compgen -G "$folder/run/particles_*.*vtp" >/dev/null && compgen -G "$folder/run/*[0-9].pvtp" >/dev/null; then
        "$ricochet" export "$folder/run" --format ply --output "$folder/ply" >"$folder/ply.out" 2>&1 ||
            fail "what is left of the run cannot be read: $(cat "$folder/ply.out")"
    fi
}

rm -rf "$folder"
mkdir -p "$folder"
"$ricochet" run "$scene" --output "$folder/alone" --output-state "$folder/alone.csv" "${cut[@]}" --quiet
killed=0
resumed=0
arguments=()
while ((killed < kills)); do
    ranks=$((2 + RANDOM % 3))
    # Most runs write pieces. Each run may continue from gathered files or from pieces.
    pieces=(--set "output.pieces=$( ((RANDOM % 4)) && echo true || echo false)")
    begin "$ranks" "${pieces[@]}" "${arguments[@]}"
    sleep "$((RANDOM % 3)).$((RANDOM % 1000 + 1000))"
    victim="$(cat "$folder/pid.$((RANDOM % ranks))" 2>/dev/null || true)"
    if [[ -n "$victim" ]] && kill -0 "$run" 2>/dev/null && kill -9 "$victim" 2>/dev/null; then
        killed=$((killed + 1))
        wait "$run" && fail "a run that lost a process ended with 0"
        expect_whole_files
        arguments=()
        if [[ -e "$folder/run/summary.json" ]]; then # it was done, and about to end
            cmp "$folder/alone.csv" "$folder/run.csv" || fail "another state than that of one process"
            continue
        fi
        if [[ -f "$folder/run/checkpoint.bin" ]]; then arguments=(--resume) && resumed=$((resumed + 1)); fi
        continue
    fi
    wait "$run" || fail "a run that nobody killed ended with $?: $(cat "$folder/out")"
    cmp "$folder/alone.csv" "$folder/run.csv" || fail "another state than that of one process"
    arguments=()
done
begin 3 --set output.pieces=true "${arguments[@]}"
wait "$run" || fail "the last run ended with $?: $(cat "$folder/out")"
cmp "$folder/alone.csv" "$folder/run.csv" || fail "another state than that of one process"
[[ -z "$(compgen -G "$folder/run/*.partial" || true)" ]] || fail "unfinished files are left"
[[ ! -e "$folder/run/checkpoint.bin" ]] || fail "a finished run has a checkpoint"
"$ricochet" export "$folder/alone" --format ply --output "$folder/alone.ply" >/dev/null
"$ricochet" export "$folder/run" --format ply --output "$folder/ply" >/dev/null
diff -r "$folder/alone.ply" "$folder/ply" >/dev/null || fail "other frames than those of one process"
echo "$killed processes killed, $resumed runs went on from a checkpoint, to the state of one process"
