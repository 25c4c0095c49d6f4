#!/usr/bin/env bash
# Runs every shipped scene on several processes, with the hash, the counters and the totals of one process. Scenes that
# cannot be shared are refused by name and listed here.
# Usage: shared_scenes_test.sh RICOCHET MPIRUN SCENES FOLDER SECONDS RANKS THREADS
# RANKS and THREADS are lists such as "1 2 3" and "1 2". SECONDS limits the simulated time of each scene. The first
# number of ranks must be at least two, because it also finds the refused scenes.
set -euo pipefail
ricochet="$1"
mpirun="$2"
# Open MPI 5 has no such option.
quiet=()
if "$mpirun" --quiet --version >/dev/null 2>&1; then quiet=(--quiet); fi
scenes="$3"
folder="$4"
seconds="$5"
read -ra counts <<<"$6"
read -ra threads <<<"$7"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_btl_vader_single_copy_mechanism=none
export PRTE_ALLOW_RUN_AS_ROOT=1 PRTE_ALLOW_RUN_AS_ROOT_CONFIRM=1
refusals='\(particle_contacts\|particle_forces\|bodies\|response\|cloud\): ranks: found [0-9]*, expected 1'

fail() {
    echo "FAILED: $1"
    exit 1
}

# Prints the summary without values that depend on run time or on the number of processes.
summary_of() {
    grep -vE '"(wall_seconds|output_seconds|processes|busiest_process|particles_moved|common_memory_bytes|threads|peak_memory_bytes)"' \
        "$folder/$1/summary.json"
}

# Prints the simulated time of a scene, in s: its own duration, but at most the requested one.
cut_of() {
    "$ricochet" check "$1" | sed -n 's/.* \([0-9]*\) steps* of \([0-9.e-]*\) s,.*/\1 \2/p' |
        awk -v most="$seconds" '{ t = $1 * $2; printf "%.9g", t < most ? t : most }'
}

rm -rf "$folder"
mkdir -p "$folder"
shared=0
refused=()
for scene in "$scenes"/*.json; do
    name="$(basename "$scene" .json)"
    options=(--quiet --set "simulation.duration=$(cut_of "$scene")" --set output.every=1000000)
    compared=0
    for count in "${counts[@]}"; do
        for each in "${threads[@]}"; do
            code=0
            "$mpirun" "${quiet[@]}" --map-by :OVERSUBSCRIBE -n "$count" "$ricochet" run "$scene" --output "$folder/shared" \
                "${options[@]}" --threads "$each" >"$folder/out" 2>&1 || code=$?
            if ((count > 1 && code == 2)) && grep -q "$refusals" "$folder/out"; then
                refused+=("$name")
                break 2
            fi
            ((code == 0)) || fail "$name, $count ranks of $each threads: exit code $code: $(cat "$folder/out")"
            if ((compared == 0)); then
                "$ricochet" run "$scene" --output "$folder/alone" "${options[@]}" >"$folder/alone.out" 2>&1 ||
                    fail "$name: $(cat "$folder/alone.out")"
            fi
            diff <(summary_of alone) <(summary_of shared) || fail "$name, $count ranks of $each threads: another outcome"
            compared=$((compared + 1))
        done
    done
    ((compared < ${#counts[@]} * ${#threads[@]})) || shared=$((shared + 1))
done
echo "$shared scenes have the outcome of one process with ${counts[*]} ranks of ${threads[*]} threads;" \
    "refused: ${refused[*]}"
((shared >= 10)) || fail "only $shared scenes were shared"
