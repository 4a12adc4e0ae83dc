"""`python3 -m sfd_hbm_ros VERB ...`: the command line."""

import sys

from sfd_hbm_ros.cli import main

sys.exit(main())
