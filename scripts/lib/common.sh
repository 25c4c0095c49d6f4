# shellcheck shell=bash
# shellcheck disable=SC2034,SC2154  # shared names: set here, used there
# Functions for all scripts: the repository's root, messages, and the number of jobs. Sourced, never run.

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)"
# One locale for every tool, present on every system: messages and sort order are the same everywhere.
export LC_ALL=C
unset CDPATH

say() { printf '==> %s\n' "$*"; }
warn() { printf 'warning: %s\n' "$*" >&2; }
# die MESSAGE [EXIT-CODE]: prints one line on stderr and exits; 1 = failure, 2 = wrong arguments or missing packages.
die() {
    printf 'scripts/%s: %s\n' "$(basename "$0")" "$1" >&2
    exit "${2:-1}"
}

# Prints the number of jobs that fit the processors and the memory. A compiler instance takes up to about 1.5 GB.
default_jobs() {
    local processors memory_kib by_memory
    processors="$(nproc)"
    memory_kib="$(awk '/^MemAvailable:/ {print $2}' /proc/meminfo)"
    by_memory=$((memory_kib / 1572864))
    if ((by_memory < 1)); then by_memory=1; fi
    echo $((processors < by_memory ? processors : by_memory))
}

# need_value OPTION COUNT: refuses an option whose value is missing.
need_value() { (($2 >= 2)) || die "$1 needs a value (see --help)" 2; }

# positive_number OPTION TEXT [DIGITS]: refuses anything except 1, 2, 3, ... with at most DIGITS digits (default 4).
positive_number() {
    if [[ "$2" =~ ^[1-9][0-9]*$ ]] && ((${#2} <= ${3:-4})); then return 0; fi
    die "$1 needs a whole number from 1 on, got '$2'" 2
}
