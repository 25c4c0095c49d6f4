# shellcheck shell=bash
# shellcheck disable=SC2034,SC2154  # shared names: set here, used there
# Functions to configure and build. Sourced after common.sh.

cache_value() { sed -n "s/^$2:[A-Z]*=//p" "$1/CMakeCache.txt"; }

# configure PRESET FOLDER [CMAKE-ARGUMENT...]: configures a preset of CMakePresets.json in FOLDER (below the root).
# A folder that was configured for another source folder or generator is configured again from scratch.
configure() {
    local preset="$1" folder="$root/$2"
    local -a fresh=()
    shift 2
    if [[ -f "$folder/CMakeCache.txt" ]]; then
        if [[ "$(cache_value "$folder" CMAKE_HOME_DIRECTORY)" != "$root" ]] ||
            [[ "$(cache_value "$folder" CMAKE_GENERATOR)" != Ninja ]]; then
            say "$folder was configured for another folder or generator: configuring it again"
            fresh=(--fresh)
        fi
    fi
    (cd "$root" && cmake --preset "$preset" -B "$folder" "${fresh[@]}" "$@" </dev/null)
}

# build FOLDER JOBS [CMAKE-BUILD-ARGUMENT...]
build() {
    local folder="$root/$1" jobs="$2"
    shift 2
    cmake --build "$folder" --parallel "$jobs" "$@" </dev/null
}
