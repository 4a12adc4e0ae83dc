#!/usr/bin/env bash
# Lint, types, colcon build, colcon test and the whole test suite; arguments go to pytest.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/environment.sh"
python3 -c 'import hypothesis, matplotlib, pytest' 2>/dev/null ||
    die "the sourced ROS 2 Jazzy lacks what the tests need:" \
        "apt install python3-hypothesis python3-matplotlib python3-pytest."

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$root"
failed=()

# step COMMAND...: the later steps are taken, too, when one fails.
step() {
    echo "== $*"
    "$@" || failed+=("$*")
}

# lint MODULE ARGUMENT...: .venv has the linters, a sourced Jazzy need not have them.
lint() {
    if python3 -c "import $1" 2>/dev/null; then
        step python3 -m "$@"
    else
        echo "== $*: skipped, as $1 is not installed"
    fi
}

# All tests run under pytest below; here colcon has to find and run those of the built package.
build_and_test_with_colcon() {
    build_package "$scratch" && use_package "$scratch" &&
        colcon --log-base "$scratch/log" test --base-paths "$root" \
            --build-base "$scratch/build" --install-base "$scratch/install" \
            --return-code-on-test-failure --event-handlers console_cohesion+ \
            --pytest-args test/test_package.py
}

lint ruff check
lint ruff format --check
lint mypy
step build_and_test_with_colcon

[ ${#failed[@]} -eq 0 ] || printf 'test.sh: failed: %s\n' "${failed[@]}" >&2
echo "== pytest"
python3 -m pytest "$@" || failed+=(pytest)
[ ${#failed[@]} -eq 0 ]
