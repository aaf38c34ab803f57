# Sourced by ./demo and ./check. need_packages NAME... installs those of Debian's packages that are missing, and says so.

build_packages=(
    g++ cmake ninja-build ccache pkg-config                                   # tools
    libglm-dev libfmt-dev                                                     # vectors, text
    libhwy-dev                                                                # SIMD
    libgdcm-dev                                                               # DICOM
    libopenvdb-dev libboost-iostreams-dev                                     # voxels, decompression
    libassimp-dev libmeshoptimizer-dev libstb-dev zlib1g-dev                  # surfaces, pictures
    libexpat1-dev libzip-dev libdraco-dev                                     # surfaces in XML, archives, Draco
    libepoxy-dev libegl-dev libegl1 libgl1-mesa-dri                           # drawing, with Mesa's software driver
    libglfw3-dev libimgui-dev fonts-dejavu-core                               # the viewer
    libtomlplusplus-dev libcli11-dev nlohmann-json3-dev                       # scenes, command line, reports
)
data_packages=(mricron-data)  # the brain and the head
film_packages=(ffmpeg)
fuzz_packages=(clang libclang-rt-14-dev)           # scripts/fuzz
check_packages=(  # tests; API pages; test meshes and an independent writer of volumes; comparisons for palpate bench; a virtual display and its input
    libgtest-dev doxygen assimp-testmodels libinsighttoolkit5-dev libbullet-dev calculix-ccx xvfb libxtst-dev
)
fresh_packages=(debootstrap git)                   # scripts/fresh

need_packages() {
    local missing=() name
    for name in "$@"; do
        [ "$(dpkg-query -W -f '${db:Status-Status}' "$name" 2>/dev/null)" = installed ] || missing+=("$name")
    done
    [ ${#missing[@]} -eq 0 ] && return
    echo "Installing with apt-get: ${missing[*]}"
    local as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || { echo "These need root and there is no sudo; install them and run this again." >&2; exit 1; }
        as_root=(sudo)
    fi
    local log
    log=$(mktemp)
    if ! { "${as_root[@]}" apt-get update -q && "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
            apt-get install -y -q --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
        tail -n 20 "$log" >&2
        echo "The installation failed; the lines above say why (all of it: $log)." >&2
        exit 1
    fi
    sed -n 's/^Fetched/  Fetched/p' "$log"
    rm -f "$log"
}
