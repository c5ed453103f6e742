"""`python -m spincyl`: the command line."""

import sys

from spincyl.cli import main

sys.exit(main())
