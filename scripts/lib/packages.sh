# shellcheck shell=bash
# shellcheck disable=SC2034,SC2154  # shared names: set here, used there
# The only list of packages, and the installation of missing ones. Sourced after common.sh.

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
# Programs of users with which tests read the output. Without them these tests are reported as skipped. Blender, which
# one test uses too, is not listed because of its size of half a gigabyte.
packages_optional=(ffmpeg gnuplot-nox python3-vtk9 chromium mypy python3-tqdm python3-venv "${packages_assimp[@]}" "${packages_mpi[@]}")

# The names are the same on Debian 12, Debian 13 and Ubuntu 24.04.

package_installed() {
    [[ "$(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null)" == installed ]]
}

# missing_packages NAME...: prints the names that are not installed, one per line.
missing_packages() {
    local name
    for name in "$@"; do
        package_installed "$name" || echo "$name"
    done
}

# packages_installed NAME...: true if all of them are installed.
packages_installed() {
    [[ -z "$(missing_packages "$@")" ]]
}

# apt_run COMMAND...: runs apt-get without prompts, as root or through sudo.
apt_run() {
    local -a command=(env DEBIAN_FRONTEND=noninteractive LC_ALL=C apt-get --yes --quiet
        -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=300 "$@")
    if ((EUID != 0)); then command=(sudo "${command[@]}"); fi
    "${command[@]}" </dev/null
}

# apt_knows NAME...: true if apt knows a version to install for every name; false before the first update on a fresh
# system.
apt_knows() {
    local name
    for name in "$@"; do
        apt-cache policy "$name" 2>/dev/null | awk '/Candidate:/ && $2 != "(none)" {found = 1} END {exit !found}' ||
            return 1
    done
}

apt_install() {
    apt_knows "$@" || apt_run update
    # An outdated package list names files that no longer exist, so update once and try again.
    apt_run install --no-install-recommends "$@" || { apt_run update && apt_run install --no-install-recommends "$@"; }
}

# ensure_packages INSTALL(yes|no) NAME...: installs missing packages with a message, or lists them and fails.
ensure_packages() {
    local install="$1" list
    local -a missing
    shift
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        say "This is not a Debian or Ubuntu system: nothing is installed. Needed packages, by their Debian names: $*"
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

# ensure_optional_packages INSTALL NAME...: like ensure_packages, but continues without packages that are not available.
ensure_optional_packages() {
    local install="$1" name
    local -a missing
    shift
    command -v dpkg-query >/dev/null && command -v apt-get >/dev/null || return 0
    mapfile -t missing < <(missing_packages "$@")
    for name in "${missing[@]}"; do
        # The two VTK wrappers for Python exclude each other; either is sufficient.
        if [[ "$name" == python3-vtk9 ]] && package_installed python3-paraview; then continue; fi
        if [[ "$install" == no ]] || { ((EUID != 0)) && ! command -v sudo >/dev/null; }; then
            say "Optional package not installed: $name (the tests that use it will be skipped)"
            continue
        fi
        say "Installing with apt (optional): $name"
        apt_install "$name" || warn "$name could not be installed; the tests that use it will be skipped"
    done
}
