# shellcheck shell=bash
# shellcheck disable=SC2034,SC2154  # shared names: set here, used there
# The one list of packages, and how the missing ones are installed. Sourced after common.sh.

packages_build=(
    g++ cmake ninja-build
    libembree-dev libopenmesh-dev libtbb-dev   # ray queries, half-edge topology, threads
    libfmt-dev libcli11-dev nlohmann-json3-dev # text, command line, scene files
    libstb-dev                                 # PNG
    libboost-dev                               # whole numbers of any length, for the verifier
    zlib1g-dev                                 # pages for browsers
    libeigen3-dev                              # sparse matrices, for the implicit integrator
    pybind11-dev python3-dev python3-numpy     # the Python package
)
packages_test=(libgtest-dev libbenchmark-dev pkgconf)
packages_format=(clang-format)
packages_tidy=(clang-tidy)
packages_clang=(clang)
packages_assimp=(libassimp-dev)           # mesh files in FBX, DAE, 3DS and others
packages_mpi=(libopenmpi-dev openmpi-bin) # runs that several processes share
# Tests that read the output with the programs users have. Without them those tests say that they were skipped.
# Blender, which one of them uses too, is left to who wants it: half a gigabyte.
packages_optional=(ffmpeg gnuplot-nox python3-vtk9 chromium mypy python3-tqdm python3-venv "${packages_assimp[@]}" "${packages_mpi[@]}")

# The names are the same on Debian 12, Debian 13 and Ubuntu 24.04.

package_installed() {
    [[ "$(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null)" == installed ]]
}

# missing_packages NAME...: those of the list that are not installed, one a line.
missing_packages() {
    local name
    for name in "$@"; do
        package_installed "$name" || echo "$name"
    done
}

# packages_installed NAME...: true when all of them are.
packages_installed() {
    [[ -z "$(missing_packages "$@")" ]]
}

# apt COMMAND...: apt-get without questions, as root or through sudo.
apt_run() {
    local -a command=(env DEBIAN_FRONTEND=noninteractive LC_ALL=C apt-get --yes --quiet
        -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=300 "$@")
    if ((EUID != 0)); then command=(sudo "${command[@]}"); fi
    "${command[@]}" </dev/null
}

# True when apt knows a version to install for every name given; false before the first update on a fresh system.
apt_knows() {
    local name
    for name in "$@"; do
        apt-cache policy "$name" 2>/dev/null | awk '/Candidate:/ && $2 != "(none)" {found = 1} END {exit !found}' ||
            return 1
    done
}

apt_install() {
    apt_knows "$@" || apt_run update
    # A list of packages that has gone stale names files that are no longer there: update once and try again.
    apt_run install --no-install-recommends "$@" || { apt_run update && apt_run install --no-install-recommends "$@"; }
}

# ensure_packages INSTALL(yes|no) NAME...: installs what is missing and says so, or refuses and says what is missing.
ensure_packages() {
    local install="$1" list
    local -a missing
    shift
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        say "This is not a Debian or Ubuntu system: nothing is installed here. Needed, by Debian's names: $*"
        return 0
    fi
    mapfile -t missing < <(missing_packages "$@")
    if ((${#missing[@]} == 0)); then return 0; fi
    list="${missing[*]}"
    [[ "$install" == yes ]] || die "--no-install was given and these packages are missing: $list" 2
    if ((EUID != 0)) && ! command -v sudo >/dev/null; then
        die "neither root nor sudo here, so these packages cannot be installed: $list" 2
    fi
    say "Installing with apt: $list"
    apt_install "${missing[@]}" || die "apt could not install: $list"
}

# ensure_optional_packages INSTALL NAME...: as above, but goes on without what cannot be had.
ensure_optional_packages() {
    local install="$1" name
    local -a missing
    shift
    command -v dpkg-query >/dev/null && command -v apt-get >/dev/null || return 0
    mapfile -t missing < <(missing_packages "$@")
    for name in "${missing[@]}"; do
        # The two VTK wrappers for Python exclude each other; either serves.
        if [[ "$name" == python3-vtk9 ]] && package_installed python3-paraview; then continue; fi
        if [[ "$install" == no ]] || { ((EUID != 0)) && ! command -v sudo >/dev/null; }; then
            say "Optional package not installed: $name (the tests that use it will be skipped)"
            continue
        fi
        say "Installing with apt (optional): $name"
        apt_install "$name" || warn "$name could not be installed; the tests that use it will be skipped"
    done
}
