"""Start the simulator."""

import sys

from sfd_hbm_ros.node.simulator.simulator import main

sys.exit(main())
