"""Start the monitor."""

import sys

from sfd_hbm_ros.node.monitor.monitor import main

sys.exit(main())
