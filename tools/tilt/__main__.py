import sys

from tilt.cli import main

sys.exit(main())
