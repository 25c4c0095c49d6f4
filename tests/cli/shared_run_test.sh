#!/usr/bin/env bash
# Tests runs shared by several processes under mpirun:
# - They have the bits of one process, also when resumed by more or fewer processes.
# - An error in one process ends all of them with one line, and leaves the files that a resumed run needs.
# - Scenes that cannot be shared are refused.
# Usage: shared_run_test.sh RICOCHET MPIRUN SCENES FOLDER KILLS [PYTHON]
# PYTHON has VTK; without it the tests of readers are skipped.
set -euo pipefail
ricochet="$1"
mpirun="$2"
# Open MPI 5 has no such option.
quiet=()
if "$mpirun" --quiet --version >/dev/null 2>&1; then quiet=(--quiet); fi
scenes="$3"
folder="$4"
kills="$5"
python="${6:-}"
# A short run, with few kills, tries one number of ranks.
rank_counts=(3)
if ((kills >= 10)); then rank_counts=(1 2 3); fi
# Open MPI runs as root, on fewer processors than ranks, and in containers, which forbid processes to read each other's
# memory. The second line is for Open MPI 5.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_btl_vader_single_copy_mechanism=none
export PRTE_ALLOW_RUN_AS_ROOT=1 PRTE_ALLOW_RUN_AS_ROOT_CONFIRM=1

fail() {
    echo "FAILED: $1"
    exit 1
}

# ranks N ARGUMENTS...: runs N processes of one thread each, which write their process ids to FOLDER/pid.RANK.
ranks() {
    # shellcheck disable=SC2016  # the ranks fill these in
    "$mpirun" "${quiet[@]}" --map-by :OVERSUBSCRIBE -n "$1" bash -c 'echo $$ >"$0/pid.$OMPI_COMM_WORLD_RANK"; exec "$@"' \
        "$folder" "$ricochet" run "${@:2}" --threads 1 --quiet
}

# two_ranks ARGUMENTS... and ARGUMENTS...: runs two processes with different arguments. They are one application for
# mpirun, because mpirun of Open MPI 5.0.7 crashes if it starts two (`mpirun -n 1 true : -n 1 true`).
two_ranks() {
    # shellcheck disable=SC2016  # the ranks fill these in
    "$mpirun" "${quiet[@]}" --map-by :OVERSUBSCRIBE -n 2 bash -c 'rank=0 own=()
        for word; do
            if [[ "$word" == and ]]; then rank=1; elif ((rank == OMPI_COMM_WORLD_RANK)); then own+=("$word"); fi
        done
        exec "$0" run "${own[@]}" --quiet' "$ricochet" "$@"
}

# expect_end NAME CODE WORDS: expects that the run with `code` and NAME.out ended with this exit code and one line.
expect_end() {
    ((code == $2)) || fail "$1: exit code $code, expected $2: $(cat "$folder/$1.out")"
    (($(grep -c '^ricochet: ' "$folder/$1.out") == 1)) || fail "$1: not one line: $(cat "$folder/$1.out")"
    grep -q "^ricochet: .*$3" "$folder/$1.out" || fail "$1: not '$3': $(cat "$folder/$1.out")"
}

# Prints the summary without values that depend on run time or on the number of processes.
summary_of() {
    grep -vE '"(wall_seconds|output_seconds|processes|busiest_process|particles_moved|common_memory_bytes|threads|peak_memory_bytes)"' "$folder/$1/summary.json" ||
        fail "$1 has no summary"
}

# same_run A B: expects that the summaries and all files are the same, byte by byte.
same_run() {
    local file
    diff <(summary_of "$1") <(summary_of "$2") || fail "$2 has another summary than $1"
    diff <(ls -A "$folder/$1") <(ls -A "$folder/$2") || fail "$2 has other files than $1"
    for file in "$folder/$1"/*; do
        if [[ "$file" == */summary.json ]]; then continue; fi
        if [[ "$file" == */extension.bin ]]; then
            same_checkpoint "$1" "$2" extension.bin
            continue
        fi
        cmp "$file" "$folder/$2/$(basename "$file")" || fail "$2 has another $(basename "$file")"
    done
    cmp "$folder/$1.csv" "$folder/$2.csv" || fail "$2 ends in another state than $1"
}

# same_checkpoint A B [FILE]: compares checkpoints without the run times (16 bytes after the first 16) and the check sum
# (the last 8).
same_checkpoint() {
    local name
    for name in "$1" "$2"; do
        tail -c +33 "$folder/$name/${3:-checkpoint.bin}" | head -c -8 >"$folder/$name.state"
    done
    cmp "$folder/$1.state" "$folder/$2.state" || fail "$2 has another checkpoint than $1"
}

# same_particles A B: expects that the exported frames and all other files are the same, byte by byte. The frames
# themselves are in pieces in B.
same_particles() {
    local file
    diff <(summary_of "$1") <(summary_of "$2") || fail "$2 has another summary than $1"
    cmp "$folder/$1.csv" "$folder/$2.csv" || fail "$2 ends in another state than $1"
    for file in "$1" "$2"; do
        "$ricochet" export "$folder/$file" --format ply --output "$folder/$file.ply" >/dev/null || fail "no export of $file"
    done
    diff -r "$folder/$1.ply" "$folder/$2.ply" >/dev/null || fail "$2 has other particles than $1"
    for file in "$folder/$1"/*; do
        case "$(basename "$file")" in summary.json | extension.bin | particles*) continue ;; esac
        cmp "$file" "$folder/$2/$(basename "$file")" || fail "$2 has another $(basename "$file")"
    done
    [[ -z "$(compgen -G "$folder/$2/*.partial" || true)" ]] || fail "$2 holds unfinished files"
}

# Waits until run `run` has written the given number of frames into the folder, or has ended.
wait_for_frames() {
    until (($(compgen -G "$folder/$1/particles_*[0-9].*vtp" | wc -l) >= $2)) || ! kill -0 "$run" 2>/dev/null; do
        sleep 0.02
    done
}

rm -rf "$folder"
mkdir -p "$folder"

# Tests emitters, children born at impacts and as trails, loads of moving colliders, and springs.
for scene in fountain shattering bouncing_table rope_and_cloth; do
    cut=(--set simulation.duration=0.6 --set output.contacts=true)
    "$ricochet" run "$scenes/$scene.json" --output "$folder/$scene" --output-state "$folder/$scene.csv" "${cut[@]}" --quiet
    for count in "${rank_counts[@]}"; do
        ranks "$count" "$scenes/$scene.json" --output "$folder/$scene-$count" \
            --output-state "$folder/$scene-$count.csv" "${cut[@]}"
        same_run "$scene" "$scene-$count"
    done
done

# Ranks on one machine share one copy of a mesh, if the system lets a process open the memory of another one.
awk 'BEGIN {
    n = 150
    for (j = 0; j <= n; ++j) for (i = 0; i <= n; ++i) print "v", i / n, j / n, 0.02 * sin(40 * i / n) * cos(31 * j / n)
    for (j = 0; j < n; ++j) for (i = 0; i < n; ++i) {
        a = j * (n + 1) + i + 1
        print "f", a, a + 1, a + n + 2
        print "f", a, a + n + 2, a + n + 1
    }
}' >"$folder/ground.obj"
cat >"$folder/ground.json" <<'END'
{"ricochet": 1, "simulation": {"time_step": 0.01, "duration": 1, "integrator": "ballistic"},
 "colliders": [{"name": "ground", "type": "mesh", "file": "ground.obj"}],
 "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
 "emitters": [{"name": "above", "type": "box", "center": [0.5, 0.5, 1], "size": [0.8, 0.8, 0.2], "burst": 300}],
 "output": {"every": 20}}
END
"$ricochet" run "$folder/ground.json" --output "$folder/ground" --output-state "$folder/ground.csv" --quiet
ranks 3 "$folder/ground.json" --output "$folder/ground-3" --output-state "$folder/ground-3.csv"
same_run ground ground-3
sleep 10 <"$folder/ground.obj" &
common="$(sed -n 's/.*"common_memory_bytes": \([0-9]*\).*/\1/p' "$folder/ground-3/summary.json")"
if [[ -r /proc/$!/fd/0 ]]; then
    ((common > 2000000)) || fail "ranks have only $common bytes of the mesh in common"
else
    echo "processes may not open each other's files here: $common bytes of the mesh are in common"
fi

# A folder with the name of a frame ends the run at that frame. Other numbers of ranks then continue from its files.
scene="$scenes/shattering.json"
cut=(--set simulation.duration=1.2 --set output.every=10 --set output.checkpoint_every=20 --set output.contacts=true)
"$ricochet" run "$scene" --output "$folder/whole" --output-state "$folder/whole.csv" "${cut[@]}" --quiet
for count in 1 4; do
    "$ricochet" run "$scene" --output "$folder/stopped-$count" --set simulation.duration=0.01 --quiet
    mkdir -p "$folder/stopped-$count/particles_000090.vtp/obstacle"
    code=0
    ranks "$count" "$scene" --output "$folder/stopped-$count" "${cut[@]}" >"$folder/stopped-$count.out" 2>&1 || code=$?
    expect_end "stopped-$count" 2 'particles_000090.vtp: not a regular file'
done
same_checkpoint stopped-1 stopped-4
rm -r "$folder/stopped-4/particles_000090.vtp"
mkdir -p "$folder/stopped-4/particles_000170.vtp/obstacle"
code=0
ranks 2 "$scene" --output "$folder/stopped-4" --resume "${cut[@]}" >"$folder/stopped-4.out" 2>&1 || code=$?
expect_end stopped-4 2 'particles_000170.vtp: not a regular file'
rm -r "$folder/stopped-4/particles_000170.vtp"
ranks 3 "$scene" --output "$folder/stopped-4" --output-state "$folder/stopped-4.csv" --resume "${cut[@]}"
same_run whole stopped-4

# Processes are killed one after the other. Others continue from the checkpoint.
cut=(--set "simulation.duration=$((2 + kills / 4))" --set output.every=5 --set output.checkpoint_every=5)
scene="$scenes/fountain.json"
"$ricochet" run "$scene" --output "$folder/alone" --output-state "$folder/alone.csv" "${cut[@]}" --quiet
resume=()
for ((k = 0; k < kills; ++k)); do
    frames="$(compgen -G "$folder/killed/particles_*.vtp" | wc -l || true)"
    ranks 3 "$scene" --output "$folder/killed" "${resume[@]}" "${cut[@]}" >"$folder/killed.out" 2>&1 &
    run=$!
    wait_for_frames killed "$((frames + 2 + k % 5))"
    kill -0 "$run" 2>/dev/null || break # it was too fast
    kill -9 "$(cat "$folder/pid.$((k % 3))")"
    code=0
    wait "$run" || code=$?
    ((code != 0)) || fail "a run that lost a process ended with 0"
    [[ ! -e "$folder/killed/summary.json" ]] || fail "a run that lost a process has a summary"
    if [[ -f "$folder/killed/checkpoint.bin" ]]; then resume=(--resume); fi
done
echo "processes killed: $k"
((k > 0)) || fail "no process was killed"
ranks 2 "$scene" --output "$folder/killed" --output-state "$folder/killed.csv" "${resume[@]}" "${cut[@]}"
same_run alone killed

# Pieces: each process writes its own part of frames and checkpoints.
cut=(--set simulation.duration=0.6 --set output.contacts=true)
for count in "${rank_counts[@]}"; do
    ranks "$count" "$scenes/fountain.json" --output "$folder/pieces-$count" --output-state "$folder/pieces-$count.csv" \
        "${cut[@]}" --set output.pieces=true
    same_particles fountain "pieces-$count"
    if [[ -n "$python" ]]; then
        code=0
        "$python" "$(dirname "$0")/pieces_test.py" "$folder/fountain" "$folder/pieces-$count" || code=$?
        ((code == 0 || code == 77)) || fail "VTK does not read pieces-$count"
    fi
done
for command in "render $folder/pieces-3 --size 64x48 --frame 12 --output $folder/pieces.png" \
    "view $folder/pieces-3 --output $folder/pieces.html"; do
    # shellcheck disable=SC2086  # words
    "$ricochet" $command >"$folder/command.out" 2>&1 || fail "$command: $(cat "$folder/command.out")"
done
rm "$folder/pieces-3/particles_000012_p1.vtp"
code=0
"$ricochet" export "$folder/pieces-3" --format ply --output "$folder/lost.ply" >"$folder/lost.out" 2>&1 || code=$?
expect_end lost 2 'particles_000012_p1.vtp: not a regular file'

# 4, 2 and 3 ranks continue one after the other from checkpoints in parts. In between one process continues alone, with
# gathered files.
cut=(--set simulation.duration=1.2 --set output.every=10 --set output.checkpoint_every=20)
scene="$scenes/shattering.json"
"$ricochet" run "$scene" --output "$folder/parts-whole" --output-state "$folder/parts-whole.csv" "${cut[@]}" --quiet
# stop_at FRAME RANKS ARGUMENTS...: runs until a folder blocks the index of that frame.
stop_at() {
    mkdir -p "$folder/parts/particles_$1.pvtp/obstacle"
    code=0
    ranks "$2" "$scene" --output "$folder/parts" "${cut[@]}" "${@:3}" >"$folder/parts.out" 2>&1 || code=$?
    expect_end parts 2 "particles_$1.pvtp: not a regular file"
    rm -r "$folder/parts/particles_$1.pvtp"
}
"$ricochet" run "$scene" --output "$folder/parts" --set simulation.duration=0.01 --quiet
stop_at 000050 4 --set output.pieces=true
(($(compgen -G "$folder/parts/checkpoint_0_p?.bin" | wc -l) == 4)) || fail "not four parts: $(ls "$folder/parts")"
stop_at 000090 2 --set output.pieces=true --resume
(($(compgen -G "$folder/parts/checkpoint_0_p?.bin" | wc -l) == 2)) || fail "not two parts: $(ls "$folder/parts")"
cp -r "$folder/parts" "$folder/parts-alone"
cp -r "$folder/parts" "$folder/parts-lost"
"$ricochet" run "$scene" --output "$folder/parts-alone" --output-state "$folder/parts-alone.csv" "${cut[@]}" --resume --quiet
same_particles parts-whole parts-alone
[[ -z "$(compgen -G "$folder/parts-alone/checkpoint*" || true)" ]] || fail "a finished run has parts of a checkpoint"
ranks 3 "$scene" --output "$folder/parts" --output-state "$folder/parts.csv" "${cut[@]}" --set output.pieces=true --resume
same_particles parts-whole parts

# A checkpoint with a missing part, or with a part of another time, is refused as a whole.
truncate -s -1 "$folder/parts-lost"/checkpoint_0_p1.bin
code=0
ranks 2 "$scene" --output "$folder/parts-lost" "${cut[@]}" --resume >"$folder/parts-lost.out" 2>&1 || code=$?
expect_end parts-lost 2 'checkpoint.bin: its part checkpoint_0_p1.bin cannot be used: .*is damaged or cut short'
rm "$folder/parts-lost"/checkpoint_0_p1.bin
code=0
ranks 2 "$scene" --output "$folder/parts-lost" "${cut[@]}" --resume >"$folder/parts-lost.out" 2>&1 || code=$?
expect_end parts-lost 2 'checkpoint.bin: its part checkpoint_0_p1.bin is missing'

# A signal to one process ends all of them after the same step, with a checkpoint. Meanwhile no other run gets the
# folder.
ranks 3 "$scene" --output "$folder/signal" --set simulation.duration=1000 >"$folder/signal.out" 2>&1 &
run=$!
wait_for_frames signal 3
pid="$(cat "$folder/pid.1")"
code=0
ranks 2 "$scene" --output "$folder/signal" >"$folder/locked.out" 2>&1 || code=$?
expect_end locked 1 'another run is writing into this folder'
kill -TERM "$pid" || fail "the run ended early: $(cat "$folder/signal.out")"
code=0
wait "$run" || code=$?
((code == 143)) || fail "a signal to one process: exit code $code, expected 143: $(cat "$folder/signal.out")"
grep -q '"interrupted": true' "$folder/signal/summary.json" || fail "the summary does not say that it was interrupted"
[[ -f "$folder/signal/checkpoint.bin" ]] || fail "a run that was ended by a signal has no checkpoint"

# A hang-up ends them too, although libraries of MPI handle SIGHUP.
ranks 3 "$scene" --output "$folder/hang-up" --set simulation.duration=1000 >"$folder/hang-up.out" 2>&1 &
run=$!
wait_for_frames hang-up 3
kill -HUP "$(cat "$folder/pid.1")" || fail "the run ended early: $(cat "$folder/hang-up.out")"
frames="$(compgen -G "$folder/hang-up/particles_*.vtp" | wc -l)"
wait_for_frames hang-up "$((frames + 100))"
kill -KILL "$run" 2>/dev/null && fail "a hang-up does not end the run"
code=0
wait "$run" || code=$?
((code == 129)) || fail "a hang-up of one process: exit code $code, expected 129: $(cat "$folder/hang-up.out")"

# Wrong input is reported once, even if another rank finds it.
refuse() {
    code=0
    ranks 3 "${@:3}" --output "$folder/refused" >"$folder/$1.out" 2>&1 || code=$?
    expect_end "$1" 2 "$2"
}
refuse missing 'there is no file' "$folder/missing.json"
refuse option 'not expected: --bogus' "$scene" --bogus
refuse springs 'output.pieces: found true beside springs' "$scenes/rope_and_cloth.json" --set output.pieces=true

# Ranks with different arguments change no file. The files of an earlier run remain, including its checkpoint.
# unlike NAME ARGUMENTS...: adds a second rank with these arguments.
unlike() {
    local before
    before="$(ls -A "$folder/signal")"
    code=0
    two_ranks "$scene" --output "$folder/signal" and "$scene" "${@:2}" >"$folder/$1.out" 2>&1 || code=$?
    expect_end "$1" 2 'have found different scenes, options or checkpoints'
    [[ "$(ls -A "$folder/signal")" == "$before" ]] || fail "$1: files of an earlier run are gone"
}
unlike other-seed --output "$folder/signal" --set simulation.seed=9
unlike other-resume --output "$folder/signal" --resume
unlike other-folder --output "$folder/other"
unlike other-state --output "$folder/signal" --output-state "$folder/other.csv"

# An error of one rank alone is reported with its number.
code=0
two_ranks "$scene" --output "$folder/alone-wrong" and "$folder/missing.json" --output "$folder/alone-wrong" \
    >"$folder/wrong.out" 2>&1 || code=$?
expect_end wrong 2 'rank 1 on .*: .*there is no file'
refuse spheres 'particle_contacts: ranks: found 3, expected 1' "$scenes/granular_gas.json"
refuse forces 'particle_forces: ranks: found 3, expected 1' "$scenes/galaxy.json"
refuse bodies 'bodies: ranks: found 3, expected 1' "$scenes/turbine.json"
refuse response 'response: ranks: found 3, expected 1' "$scene" --response penalty
refuse verify 'verify: ranks: found 3, expected 1' "$scene" --verify
[[ ! -e "$folder/refused" ]] || fail "what was refused has left a folder"
code=0
two_ranks "$scene" --output "$folder/different" --set simulation.duration=0.1 and \
    "$scene" --output "$folder/different" --set simulation.duration=0.2 >"$folder/different.out" 2>&1 || code=$?
expect_end different 2 'the 2 processes have found different scenes'

# A tool without the library for MPI beside it runs alone, and refuses to share a run.
cp "$ricochet" "$folder/ricochet"
"$folder/ricochet" run "$scene" --output "$folder/without" --set simulation.duration=0.1 --quiet || fail "no run without MPI"
code=0
(cd "$folder" && OMPI_COMM_WORLD_RANK=0 OMPI_COMM_WORLD_SIZE=2 ./ricochet run "$scene" --output without) \
    >"$folder/without.out" 2>&1 || code=$?
expect_end without 1 'ranks: the library for MPI cannot be loaded: ricochet_mpi.so: '
echo "passed"
