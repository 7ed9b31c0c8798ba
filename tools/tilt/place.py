"""Where the firmware's and the libraries' sources are: in this checkout, or packed beside this file in a wheel (mk/scripts/wheel.py)."""
import pathlib
import re
import sys

PACKED = pathlib.Path(__file__).resolve().with_name("source")
IN_WHEEL = PACKED.is_dir()
ROOT = PACKED if IN_WHEEL else pathlib.Path(__file__).resolve().parents[2]
VERSION_FILE = "firmware/console/version.h"  # the only file with the version
if not (ROOT / VERSION_FILE).is_file():  # pip install tools/, which is not editable
    sys.exit("tilt: installed without its sources: install the wheel of a release, or run make tilt in a checkout")
VERSION = re.search(r'FIRMWARE_VERSION "(.*)"', (ROOT / VERSION_FILE).read_text(encoding="ascii"))[1]
