"""What the tests of tools/design share: the command, brute force, and the compiled library."""
import contextlib
import ctypes
import functools
import importlib
import io
import json
import pathlib
import subprocess
import sys

sys.path.insert(0, "tools")
OUT = pathlib.Path("build/design_tests") / pathlib.Path(sys.argv[0]).stem  # programs that run at the same time do not write the same files
BASE = ["--rate", "100", "--sigma", "2", "--no-pictures"]


def said(*arguments):
    """(status, standard output, standard error) of the command, in this process."""
    command = importlib.import_module("design.command")  # needs scipy, whose absence the tests tell themselves
    out, error = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(error):
        try:
            status = command.main([str(a) for a in arguments])
        except SystemExit as stopped:
            status = stopped.code
    return status, out.getvalue(), error.getvalue()


def answer(*arguments):
    """(JSON, text) of a design that the command makes."""
    path = OUT / "design.json"
    status, out, error = said(*arguments, "--json", path)
    assert status == 0, error
    return json.loads(path.read_text(encoding="utf-8")), out


def simulated(f, samples, wanted, v=None):
    """x^ by the difference equation itself, as the papers write it: nothing of the tool's closed loop in it."""
    weights = [-x for x in f.a_polynomial[1:]]
    past_x, past_u, out = [0.0] * len(weights), [0.0] * f.l, []
    for n in range(samples):
        expected = sum(w * x for w, x in zip(weights, past_x)) + sum(b * u for b, u in zip(f.b[1:], past_u))
        innovation = wanted(n) - expected
        estimate = expected + f.b[0] * innovation
        past_x = [estimate, *past_x[:-1]]
        past_u = [innovation, *past_u[:-1]] if f.l else []
        out.append(estimate)
    return out


def impulse_sum(f, samples=200_000):
    """Noise gain by adding up, until what is added is nothing."""
    return sum(x * x for x in simulated(f, samples, lambda n: 1.0 if n == 0 else 0.0))


class Parameter(ctypes.Structure):
    _fields_ = [("name", ctypes.c_char * 10), ("unit", ctypes.c_char * 8), ("offset", ctypes.c_uint8),
                ("size", ctypes.c_uint8), ("fraction_bits", ctypes.c_uint8),
                ("zero_means_off", ctypes.c_uint8), ("is_signed", ctypes.c_uint8), ("min", ctypes.c_int32), ("max", ctypes.c_int32)]


class Descriptor(ctypes.Structure):
    _fields_ = [("name", ctypes.c_char * 12), ("parameter_count", ctypes.c_uint8), ("parameters", ctypes.POINTER(Parameter))]


class Probe(ctypes.Structure):
    _fields_ = [("x_lsb_q16", ctypes.c_int32), ("rate_lsb_q16", ctypes.c_int32), ("innovation_lsb_q16", ctypes.c_int32),
                ("p_lsb2_q8", ctypes.c_uint32),
                ("gate_lsb2_q8", ctypes.c_uint32), ("gain_uq16", ctypes.c_uint16), ("flags", ctypes.c_uint8)]


# field of NAME_config_t for each parameter's name as typed
FIELDS = {"a1": "a1_q16", "b0": "b0_uq16", "b1": "b1_q16", "b2": "b2_q16", "r": "r_lsb2_q8", "q": "q_lsb2_s3", "k": "k", "u": "variant_u",
          "p0": "p0_lsb2_q8"}


def field_of(p):
    """The field of NAME_config_t that a parameter stands for, None when it is none of these."""
    return "q_lsb2_s5" if p.name == b"q" and p.unit == b"LSB2/s5" else FIELDS.get(p.name.decode())


@functools.cache
def compiled_library():
    """lib/filters as a shared library."""
    OUT.mkdir(parents=True, exist_ok=True)
    sources = sorted(str(p) for p in pathlib.Path("lib/filters/src").glob("*.c"))
    built = OUT / "libfilters.so"
    subprocess.run(["gcc", "-std=c11", "-O1", "-shared", "-fPIC", "-Ilib/filters/src", *sources, "-o", str(built)], check=True)
    return built.resolve()


class Library:
    """lib/filters compiled for the PC, through filter_any."""

    def __init__(self):
        self.names = {path.stem for path in pathlib.Path("lib/filters/src").glob("*.c")}
        self.c = ctypes.CDLL(str(compiled_library()))
        self.c.filter_any_descriptor.restype = ctypes.POINTER(Descriptor)
        self.c.filter_any_init.restype = ctypes.c_bool
        self.c.synth_noise_gain_uq16.restype = ctypes.c_uint32
        self.c.synth_noise_gain_uq16.argtypes = [ctypes.c_uint16, ctypes.c_int32]

    def ranges(self, name):
        """{field: (min, max)} of the descriptor."""
        found = self.c.filter_any_descriptor(self.c.filter_any_find(name.encode())).contents
        assert found.name.decode() == name, found.name
        return {field_of(p): (p.min, p.max) for p in found.parameters[:found.parameter_count]}

    def make(self, name, fields):
        """(accepted, state) of NAME_init with these stored values on top of the defaults."""
        kind = self.c.filter_any_find(name.encode())
        config, state = ctypes.create_string_buffer(256), ctypes.create_string_buffer(1024)
        self.c.filter_any_defaults(kind, config, ctypes.c_uint16(fields["rate_dhz"]))
        found = self.c.filter_any_descriptor(kind).contents
        told = set(fields) - {"rate_dhz"}
        for p in found.parameters[:found.parameter_count]:
            field = field_of(p)
            if field in fields:
                config[p.offset:p.offset + p.size] = (fields[field] & (256 ** p.size - 1)).to_bytes(p.size, "little")
                told.discard(field)
        assert not told, f"{name} has no {told}"
        return self.c.filter_any_init(state, kind, config), state

    def update(self, state, z):
        return self.c.filter_any_update(state, ctypes.c_int16(z))

    def gain(self, state):
        probe = Probe()
        self.c.filter_any_probe(state, ctypes.byref(probe))
        return probe.gain_uq16 / 65536


def compiles_and_runs(initialiser, name):
    """True when a program with the emitted line in it compiles without a warning and NAME_init accepts it."""
    source, program = OUT / f"emitted_{name}.c", OUT / f"emitted_{name}"
    source.write_text(f'#include "{name}.h"\n{initialiser}\n'
                      f'int main(void) {{ {name}_t f; return {name}_init(&f, &config) ? 0 : 1; }}\n', encoding="utf-8")
    library = compiled_library()
    command = ["gcc", "-std=c11", "-Wall", "-Wextra", "-Wconversion", "-Werror", "-Ilib/filters/src", str(source), str(library),
               f"-Wl,-rpath,{library.parent}", "-o", str(program)]
    subprocess.run(command, check=True, capture_output=True)
    return subprocess.run([str(program)]).returncode == 0
