"""The command `tilt` as a wheel that needs no compiler to install. What is written in C is inside as source, with the compiler's arguments
(libtilt.args): tools/tilt/native.py compiles it when it is first used. The images that `tilt flash` writes by default are inside too."""
import base64
import hashlib
import pathlib
import subprocess
import tomllib

import packed

PROJECT = pathlib.Path("tools/pyproject.toml")
BESIDE = ("mk/images.mk", "mk/boards.txt", "mk/scripts/boards.py", "firmware/console/version.h")
AVR_LIBC = pathlib.Path("mk/avr-libc.txt")  # what its licence wants beside images
IMAGES = ("everyday", "small", "nav")  # tools/tilt/flashing.py chooses


def project():
    return tomllib.loads(PROJECT.read_text(encoding="utf-8"))


def modules():
    """{name in the wheel: bytes} of the packages and their data, as pyproject.toml lists them."""
    tool, found = project()["tool"]["setuptools"], {}
    for package in tool["packages"]:
        folder = PROJECT.parent / tool["package-dir"].get(package, package.replace(".", "/"))
        patterns = ["*.py"] * (package not in tool["package-dir"]) + tool["package-data"].get(package, [])
        found |= {f"{package.replace('.', '/')}/{name}": data for name, data in packed.files(folder, *patterns).items()}
    return found


def sources(arguments):
    """{path: bytes} of what the compiler reads with these arguments, and of what tools/tilt reads in a checkout."""
    words = [word for word in arguments.split() if word not in ("-shared", "-lm")]
    rules = subprocess.run(["gcc", "-MM", *words], capture_output=True, text=True, check=True).stdout
    paths = {word for word in rules.replace("\\\n", " ").split() if not word.endswith(":")} | set(BESIDE)
    return {path: pathlib.Path(path).read_bytes() for path in paths} | {"libtilt.args": arguments.encode("ascii")}


def metadata(version):
    about = project()["project"]
    lines = ["Metadata-Version: 2.1", f"Name: {about['name']}", f"Version: {version}", f"Summary: {about['description']}", "License: MIT",
             f"Requires-Python: {about['requires-python']}", *(f"Requires-Dist: {each}" for each in about["dependencies"])]
    scripts = "".join(f"{name} = {place}\n" for name, place in about["scripts"].items())
    return {"METADATA": "\n".join(lines) + "\n", "WHEEL": "Wheel-Version: 1.0\nGenerator: tilt-uno\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
            "entry_points.txt": f"[console_scripts]\n{scripts}", "LICENSE": pathlib.Path("LICENSE").read_text(encoding="utf-8"),
            "LICENSE-avr-libc": AVR_LIBC.read_text(encoding="utf-8")}


def recorded(name, data):
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(data)}\n"


def write(folder, version, epoch, arguments, images):
    """images: {name: path of its .hex}. Returns the wheel's path."""
    name = f"{project()['project']['name'].replace('-', '_')}-{version}"
    contents = modules() | {f"tilt/source/{path}": data for path, data in sources(arguments).items()}
    contents |= {f"tilt/images/{image}.hex": pathlib.Path(path).read_bytes() for image, path in images.items() if image.startswith(IMAGES)}
    contents |= {f"{name}.dist-info/{file}": text.encode("utf-8") for file, text in metadata(version).items()}
    record = f"{name}.dist-info/RECORD"
    contents[record] = "".join([*(recorded(path, contents[path]) for path in sorted(contents)), f"{record},,\n"]).encode("ascii")
    packed.zip_to(folder / f"{name}-py3-none-any.whl", contents, epoch)
    return folder / f"{name}-py3-none-any.whl"
