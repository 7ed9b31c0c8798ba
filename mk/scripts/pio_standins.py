"""pio_standins.py FOLDER VENV: a PlatformIO core folder whose packages stand in for those of PlatformIO's registry: the platforms
native and atmelavr (bare metal, with the flags that PlatformIO's own atmelavr gives) around the gcc and avr-gcc on PATH, and SCons."""
import json
import pathlib
import shutil
import sys
import textwrap

SCONS_VERSION = "4.41101.0"  # what PlatformIO Core 6.2.0 asks for
TOOLCHAIN_VERSION = "1.70300.0"
TOOLS = ("gcc", "g++", "ar", "gcc-ar", "gcc-ranlib", "as", "ld", "nm", "objcopy", "objdump", "ranlib", "size", "strip")

PLATFORM = "from platformio.platform.base import PlatformBase\n\n\nclass {name}Platform(PlatformBase):\n    pass\n"

NATIVE_BUILDER = """
    from SCons.Script import AlwaysBuild, Default, DefaultEnvironment
    env = DefaultEnvironment()
    program = env.BuildProgram()
    AlwaysBuild(env.Alias("size", program, env.VerboseAction("size $SOURCE", "size")))
    Default(program)
"""

# compiler and linker flags of the real platform without a framework (its frameworks/_bare.py), as documented there
AVR_BUILDER = """
    from SCons.Script import Default, DefaultEnvironment
    env = DefaultEnvironment()
    env.Replace(AR="avr-gcc-ar", AS="avr-as", CC="avr-gcc", CXX="avr-g++", OBJCOPY="avr-objcopy", RANLIB="avr-gcc-ranlib",
                PROGNAME="firmware", PROGSUFFIX=".elf")
    cpu = ["-mmcu=$BOARD_MCU"]
    env.Append(
        CFLAGS=["-std=gnu11"],
        CCFLAGS=["-Os", "-Wall", "-ffunction-sections", "-fdata-sections", "-flto"] + cpu,
        CPPDEFINES=[("F_CPU", "$BOARD_F_CPU")],
        LINKFLAGS=["-Os", "-Wl,--gc-sections", "-flto", "-fuse-linker-plugin"] + cpu,
        LIBS=["m"])
    program = env.BuildProgram()
    Default(program)
"""

UNO = {"build": {"cpu": "", "f_cpu": "16000000L", "mcu": "atmega328p"}, "frameworks": [], "name": "Arduino Uno", "vendor": "Arduino",
       "url": "https://www.arduino.cc", "upload": {"maximum_ram_size": 2048, "maximum_size": 32256, "protocol": "arduino", "speed": 115200}}


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def package(folder, kind, name, version, **more):
    """Writes the two files that make a folder a package; .piopm names its nominal origin."""
    manifest = "platform.json" if kind == "platform" else "package.json"
    write(folder / manifest, json.dumps({"name": name, "version": version, "description": "stand-in", **more}))
    owner = {"owner": "platformio", "id": 1, "name": name, "requirements": None, "uri": None}
    write(folder / ".piopm", json.dumps({"type": kind, "name": name, "version": version, "spec": owner}))


def make_scons(core, venv):
    target = core / "packages" / "tool-scons"
    package(target, "tool", "tool-scons", SCONS_VERSION)
    libraries = [p for p in venv.glob("lib/python*/site-packages/SCons") if p.is_dir()]
    if not libraries:
        sys.exit(f"pio_standins: no SCons in {venv}: install it with pip install scons")
    shutil.copytree(libraries[0], target / "scons-local" / "SCons", dirs_exist_ok=True)
    write(target / "scons.py", "import os, sys\nsys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'scons-local'))\n"
          "import SCons.Script\nSCons.Script.main()\n")


def make_toolchain(core):
    target = core / "packages" / "toolchain-atmelavr"
    package(target, "tool", "toolchain-atmelavr", TOOLCHAIN_VERSION)
    (target / "bin").mkdir(exist_ok=True)
    for tool in TOOLS:
        real, link = shutil.which(f"avr-{tool}"), target / "bin" / f"avr-{tool}"
        if real and not link.exists():
            link.symlink_to(real)


def make_platform(core, name, builder, **more):
    target = core / "platforms" / name
    package(target, "platform", name, "1.0.0", title=name, **more)
    write(target / "platform.py", PLATFORM.format(name=name.capitalize()))
    write(target / "builder" / "main.py", textwrap.dedent(builder))


def main(core, venv):
    make_scons(core, venv)
    make_toolchain(core)
    make_platform(core, "native", NATIVE_BUILDER, packages={})
    make_platform(core, "atmelavr", AVR_BUILDER, packages={"toolchain-atmelavr": {"type": "toolchain", "version": "~1.70300.0"}})
    write(core / "platforms" / "atmelavr" / "boards" / "uno.json", json.dumps(UNO))


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
