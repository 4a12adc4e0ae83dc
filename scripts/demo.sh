#!/usr/bin/env bash
# The predictor follows the paper's rotor through a simulated run-up and coast-down, with a jump on
# each, and warns of both: two processes that talk over DDS, and a third that prints what it
# receives. Ends by itself, or with Ctrl-C.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

output=$(build_package "$root" 2>&1) || die "colcon build failed: $output"
use_package "$root"
compile_kernels
executables=$root/install/sfd_hbm_ros/lib/sfd_hbm_ros
config=$root/install/sfd_hbm_ros/share/sfd_hbm_ros/config
# The paper's rotor with the greatest unbalance of the paper. As the machine file has it, with
# 431.9 g mm, its hysteresis is 5 rpm wide, which nobody sees in a run.
machine=(-p machine_file:="$config/jumping_rotor.yaml")
# The curve spans the run, from 1 900 to 6 100 rpm; the alarm is as everywhere.
range=(-p speed.min:=200.0 -p speed.max:=640.0)
# Measured with some tenths of a micrometre of noise.
noise=(-p orbit_noise:=3e-7 -p speed_noise:=0.02)

export PYTHONUNBUFFERED=1
export ROS_DOMAIN_ID=${ROS_DOMAIN_ID:-$((1 + $$ % 100))}
echo "To look on with ros2: export ROS_DOMAIN_ID=$ROS_DOMAIN_ID ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST"

pids=()
stop() {
    trap '' INT TERM HUP
    # SIGTERM, as Python meets SIGINT with a traceback until rclpy is up; and once, as rclpy
    # complains of a second signal while it shuts down.
    kill -TERM "${pids[@]}" 2>/dev/null || return 0
    for _ in {1..100}; do
        kill -0 "${pids[@]}" 2>/dev/null || return 0
        sleep 0.1
    done
    echo "demo.sh: killing what SIGTERM did not end within 10 s." >&2
    kill -KILL "${pids[@]}" 2>/dev/null || true
}
trap stop EXIT
trap 'exit 129' HUP
trap 'exit 130' INT
trap 'exit 143' TERM

# A process group for each, so that Ctrl-C is for this script alone to pass on. All are called
# through python3, as a script's first line cannot hold a path with spaces.
set -m
python3 "$executables/predictor" --ros-args --params-file "$config/predictor.yaml" \
    "${machine[@]}" "${range[@]}" </dev/null &
predictor=$!
pids+=("$predictor")
python3 -P -m sfd_hbm_ros.node.monitor --until-finished </dev/null &
monitor=$!
pids+=("$monitor")
# It waits for both of the above.
python3 "$executables/simulator" --ros-args "${machine[@]}" "${noise[@]}" -p subscribers:=2 \
    </dev/null &
simulator=$!
pids+=("$simulator")
set +m

while true; do
    status=0
    wait -n -p ended "${pids[@]}" || status=$?
    case $ended in
        "$monitor") exit "$status" ;;
        "$predictor") die "the predictor ended before the run was over, with status $status." ;;
        "$simulator")
            [ "$status" -eq 0 ] || die "the simulator failed, with status $status."
            pids=("$predictor" "$monitor")
            ;;
    esac
done
