# shellcheck shell=bash
# shellcheck disable=SC2034,SC2154  # shared names: set here, used there
# Style checks: clang-format on every file, and clang-tidy on every compiled file on request. Sourced after common.sh.
#
# Releases of these tools format and warn differently, so the release of Debian 12 is the reference. Without it the
# check is skipped with a message.
lint_release=14

# reference_tool NAME: prints the command of the reference release; fails if there is none.
reference_tool() {
    local command
    for command in "$1-$lint_release" "$1"; do
        if "$command" --version 2>/dev/null | grep --quiet "version $lint_release\."; then
            echo "$command"
            return 0
        fi
    done
    return 1
}

# Prints every source file of the project, relative to the root.
source_files() {
    (
        cd "$root" || exit
        local folder
        for folder in src tests meshes bench; do
            if [[ -d "$folder" ]]; then find "$folder" -name '*.cpp' -o -name '*.h'; fi
        done | sort
    )
}

# compiled_files FOLDER: prints the source files that the build in FOLDER compiles.
compiled_files() {
    sed -n "s|^ *\"file\": \"$root/\(.*\)\",\{0,1\}\$|\1|p" "$root/$1/compile_commands.json" |
        grep -E '^(src|tests|meshes|bench)/' | sort -u
}

# tidy_keys TOOL FOLDER: prints for every compiled file its name and a hash of all inputs of the check. These are the
# file, the project's headers that it includes (directly or not), the settings and the tool.
tidy_keys() {
    local tool="$1" folder="$2" settings file material
    settings="$( (cd "$root" && find . -name .clang-tidy -not -path './build*' | sort | xargs cat) | sha256sum)"
    settings+="$("$tool" --version)"
    cd "$root" || return
    {
        source_files | xargs sha256sum
        echo "--"
        source_files | xargs grep --with-filename '^#include "'
        echo "--"
        compiled_files "$folder"
    } | awk -f "$root/scripts/lib/include_closure.awk" | while read -r file material; do
        echo "$file $(printf '%s %s' "$settings" "$material" | sha256sum | cut -d' ' -f1)"
    done
}

# tidy_one TOOL FOLDER FILE KEY: checks one file and stores the key as a stamp if the file is clean.
tidy_one() {
    local stamp="$root/$2/lint/$3.stamp"
    if "$1" -p "$root/$2" --quiet "$root/$3" >"$stamp.log" 2>&1; then
        echo "$4" >"$stamp"
    else
        # Prints the findings without the count of suppressed warnings in system headers.
        grep --invert-match -E '^[0-9]+ warnings? (and [0-9]+ errors? )?generated|^Suppressed |^Use -header-filter' \
            "$stamp.log" >&2
        return 1
    fi
}

lint_format() {
    local tool="$1"
    say "clang-format: $(source_files | wc -l) files"
    (cd "$root" && source_files | xargs "$tool" --dry-run --Werror) ||
        die "clang-format found differences (to fix them: $tool -i FILE)"
}

lint_tidy() {
    local tool="$1" folder="$2" jobs="$3" file key seen=0
    local -a todo=()
    while read -r file key; do
        seen=$((seen + 1))
        mkdir -p "$root/$folder/lint/$(dirname "$file")"
        if [[ "$(cat "$root/$folder/lint/$file.stamp" 2>/dev/null)" != "$key" ]]; then todo+=("$file" "$key"); fi
    done < <(tidy_keys "$tool" "$folder")
    if ((seen == 0)); then die "clang-tidy: no compiled source file found in $folder/compile_commands.json"; fi
    say "clang-tidy: $((${#todo[@]} / 2)) of $seen files are new or changed"
    if ((${#todo[@]} == 0)); then return 0; fi
    export root
    export -f tidy_one
    printf '%s\0' "${todo[@]}" |
        xargs -0 -n 2 -P "$jobs" bash -c 'tidy_one "$@"' tidy_one "$tool" "$folder" ||
        die "clang-tidy found something (above)"
}

# lint format|all FOLDER JOBS: checks the format, or format and style.
lint() {
    local format tidy
    if ! format="$(reference_tool clang-format)"; then
        say "Format is not checked: clang-format $lint_release (Debian 12) is missing"
    else
        lint_format "$format"
    fi
    if [[ "$1" == format ]]; then return 0; fi
    if ! tidy="$(reference_tool clang-tidy)"; then
        say "Style is not checked: clang-tidy $lint_release (Debian 12) is missing"
    else
        lint_tidy "$tidy" "$2" "$3"
    fi
}
