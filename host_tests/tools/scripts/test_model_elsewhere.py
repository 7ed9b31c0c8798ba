"""The sensor model outside of this project: the example of sim/README, and the project for Wokwi that make wokwi writes."""
import json
import pathlib
import re
import sys
import tomllib

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import OUT, run, run_all, test
import wokwi

STRICT = ("gcc", "-std=c11", "-Wall", "-Wextra", "-Werror")
WIRED = {"uno:3.3V", "uno:GND.2", "uno:5V", "uno:A4", "uno:A5", "uno:2", "uno:4"}


@test
def the_example_of_the_readme_reads_the_sensor():
    OUT.mkdir(parents=True, exist_ok=True)
    (example,) = re.findall(r"^```c\n(.*?)^```", pathlib.Path("sim/README.md").read_text(encoding="utf-8"), re.M | re.S)
    assert example.count("\n") <= 20, example
    (OUT / "example.c").write_text(example, encoding="utf-8")
    model = [f"sim/model/{name}.c" for name in ("adxl345_model", "adxl345_variants")]
    run(*STRICT, "-Isim/model", "-Ilib/adxl345/src", OUT / "example.c", *model, "-lm", "-o", OUT / "example")
    said = re.search(r"It prints `(.*?)`", pathlib.Path("sim/README.md").read_text(encoding="utf-8"))[1]
    assert run(OUT / "example").stdout == f"{said}\n"


def project():
    """The Wokwi project, with stand-ins for the firmware."""
    OUT.mkdir(parents=True, exist_ok=True)
    for name in ("firmware.elf", "firmware.hex"):
        (OUT / name).write_text(name, encoding="ascii")
    wokwi.main(OUT / "wokwi", OUT / "firmware.elf", OUT / "firmware.hex")
    return OUT / "wokwi"


@test
def the_chip_for_wokwi_is_one_file_that_compiles():
    chip = project() / "adxl345.chip.c"
    run(*STRICT, "-fsyntax-only", "-Ihost_tests/sim", chip)
    included = set(re.findall(r'^#include "(.*)"', chip.read_text(encoding="utf-8"), re.M))
    assert included == {"wokwi-api.h"}, included


@test
def diagram_and_definition_name_what_is_there():
    folder = project()
    source = (folder / "adxl345.chip.c").read_text(encoding="utf-8")
    chip, diagram = (json.loads((folder / name).read_text(encoding="utf-8")) for name in ("adxl345.chip.json", "diagram.json"))
    attributes = set(re.findall(r'attr_init(?:_float)?\("(\w+)"', source))
    assert {control["id"] for control in chip["controls"]} == attributes - {"altAddress"}, attributes
    assert set(re.findall(r'pin_init\("(\w+)"', source)) == set(chip["pins"]) - {"VCC", "GND"}
    (part,) = (part for part in diagram["parts"] if part["type"] == "chip-adxl345")
    assert set(part["attrs"]) <= attributes
    ends = {end for connection in diagram["connections"] for end in connection[:2]}
    pins = {end.split(":")[1] for end in ends if end.startswith(f"{part['id']}:")}
    assert pins == set(chip["pins"]) - {"INT2"} and {end for end in ends if end.startswith("uno:")} == WIRED
    settings = tomllib.loads((folder / "wokwi.toml").read_text(encoding="utf-8"))
    assert settings["chip"] == [{"name": "adxl345", "binary": "adxl345.chip.wasm"}]
    assert (folder / settings["wokwi"]["firmware"]).exists() and (folder / settings["wokwi"]["elf"]).exists()


if __name__ == "__main__":
    raise SystemExit(run_all())
