#!/usr/bin/env bash
# Every shipped scene, shared by several processes: the hash, the counters and the totals of one process. What processes
# do not share is refused by name, and named here.
# shared_scenes_test.sh RICOCHET MPIRUN SCENES FOLDER SECONDS RANKS THREADS: "1 2 3" ranks with "1 2" threads each, for
# at most so many seconds of each scene. The first number of ranks finds what is refused: two or more.
set -euo pipefail
ricochet="$1"
mpirun="$2"
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

# What does not depend on the time it took, nor on who did it.
summary_of() {
    grep -vE '"(wall_seconds|output_seconds|processes|busiest_process|particles_moved|common_memory_bytes|threads|peak_memory_bytes)"' \
        "$folder/$1/summary.json"
}

# How long to run a scene, s: as long as it says, but no longer than asked for.
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
            "$mpirun" --quiet --map-by :OVERSUBSCRIBE -n "$count" "$ricochet" run "$scene" --output "$folder/shared" \
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
