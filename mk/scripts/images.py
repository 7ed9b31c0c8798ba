"""The firmware's images by their filters (mk/images.mk), and the choice of an image for a filter."""
import pathlib
import re
import shutil

FW = "build/uno/firmware.elf"
MAKEFILE = pathlib.Path("mk/images.mk").read_text(encoding="utf-8")
SETS = re.search(r"^FILTER_SETS *:= *(.*)$", MAKEFILE, re.M).group(1).split()
HOLDS = {name: held.split() for name, held in re.findall(r"^FILTERS_(\w+) *:= *([a-z0-9_ ]+)$", MAKEFILE, re.M)}
SET_IMAGES = [FW] + [f"build/uno/{name}/firmware.elf" for name in SETS[1:]]


def filters_of(image):
    """Filter names, the first is the one it starts with; none if there is no list beside the image."""
    path = pathlib.Path(image).with_name("filters.txt")
    return path.read_text(encoding="ascii").split() if path.is_file() else []


def image_with(filter_name, images=None):
    """The firmware image that holds a filter: the one that make flash writes, unless another is requested, if it does."""
    for image in SET_IMAGES if images is None else images:
        if filter_name in filters_of(image):
            return image
    raise LookupError(f"no image holds the filter {filter_name}: see the sets in mk/images.mk")


def image_for(image, filter_name):
    """This image, or, if its list lacks the filter, another one that holds it."""
    known = filters_of(image)
    return image if not filter_name or not known or filter_name in known else image_with(filter_name)


def copied(image, folder):
    """Copies an image and the list of its filters."""
    names = pathlib.Path(image).with_name("filters.txt")
    if names.is_file():
        shutil.copy(names, folder)
    return shutil.copy(image, folder)
