"""What the tests of tools/design share: the command, brute force, and the compiled library."""
import ctypes
import functools
import importlib
import json
import pathlib
import subprocess
import sys

from tilt_case import printed

OUT = pathlib.Path("build/design_tests") / pathlib.Path(sys.argv[0]).stem  # programs that run at the same time do not write the same files
BASE = ["--rate", "100", "--sigma", "2", "--no-pictures"]


def said(*arguments):
    """(status, standard output, standard error) of the command, in this process."""
    command = importlib.import_module("design.command")  # needs scipy, whose absence the tests tell themselves
    return printed(command.main, arguments)


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
    _fields_ = [("words", ctypes.c_void_p), ("fraction_bits", ctypes.c_uint8), ("zero_means_off", ctypes.c_uint8),
                ("min", ctypes.c_int32), ("max", ctypes.c_int32), ("standard", ctypes.c_int32)]

    @property
    def name(self):
        return ctypes.string_at(self.words)

    @property
    def unit(self):
        return ctypes.string_at(self.words + len(self.name) + 1)


class Config(ctypes.Structure):
    _fields_ = [("rate_dhz", ctypes.c_uint16), ("value", ctypes.c_int32 * 7)]


class Probe(ctypes.Structure):
    _fields_ = [("x_lsb_q16", ctypes.c_int32), ("rate_lsb_q16", ctypes.c_int32), ("innovation_lsb_q16", ctypes.c_int32),
                ("p_lsb2_q8", ctypes.c_uint32),
                ("gate_lsb2_q8", ctypes.c_uint32), ("gain_uq16", ctypes.c_uint16), ("flags", ctypes.c_uint8)]


# what the tool calls the value of each parameter's name as typed
FIELDS = {"a1": "a1_q16", "b0": "b0_uq16", "b1": "b1_q16", "b2": "b2_q16", "r": "r_lsb2_q8", "q": "q_lsb2_s3", "k": "k", "u": "variant_u",
          "p0": "p0_lsb2_q8", "ratemax": "rate_max_lsb_s"}


def field_of(p):
    """The tool's field that a parameter stands for, None when it is none of these."""
    return "q_lsb2_s5" if p.name == b"q" and p.unit == b"LSB2/s5" else FIELDS.get(p.name.decode())


@functools.cache
def compiled_library():
    """lib/filters as a shared library."""
    OUT.mkdir(parents=True, exist_ok=True)
    sources = sorted(str(p) for p in pathlib.Path("lib/filters/src").glob("*.c"))
    built = OUT / "libfilters.so"
    subprocess.run(["gcc", "-std=c11", "-O1", "-shared", "-fPIC", "-Ilib/machine/src", "-Ilib/filters/src", *sources, "-o", str(built)], check=True)
    return built.resolve()


class Library:
    """lib/filters compiled for the PC."""

    def __init__(self):
        self.c = ctypes.CDLL(str(compiled_library()))
        for function, result, arguments in (
                ("filter_find", ctypes.c_int, [ctypes.c_char_p]), ("filter_listed_name", ctypes.c_char_p, [ctypes.c_int]),
                ("filter_listed", ctypes.c_void_p, [ctypes.c_int]), ("filter_name", ctypes.c_char_p, [ctypes.c_void_p]),
                ("filter_parameter_count", ctypes.c_uint8, [ctypes.c_void_p]),
                ("filter_parameter", ctypes.POINTER(Parameter), [ctypes.c_void_p, ctypes.c_uint8]),
                ("filter_defaults", Config, [ctypes.c_void_p, ctypes.c_uint16]),
                ("filter_init", ctypes.c_uint8, [ctypes.c_char_p, ctypes.c_void_p, ctypes.POINTER(Config)]),
                ("filter_update", ctypes.c_int32, [ctypes.c_char_p, ctypes.c_int16]),
                ("filter_probe", None, [ctypes.c_char_p, ctypes.POINTER(Probe)]),
                ("filter_synth_noise_gain_uq16", ctypes.c_uint32, [ctypes.c_uint16, ctypes.c_int32])):
            named = getattr(self.c, function)
            named.restype, named.argtypes = result, arguments
        self.names = {self.c.filter_listed_name(kind).decode() for kind in range(self.c.filter_find(b"none of them"))}

    def law(self, name):
        found = self.c.filter_listed(self.c.filter_find(name.encode()))
        assert self.c.filter_name(found).decode() == name, name
        return found

    def parameters(self, law):
        return [self.c.filter_parameter(law, i).contents for i in range(self.c.filter_parameter_count(law))]

    def ranges(self, name):
        """{field: (min, max)} of the law's parameters."""
        return {field_of(p): (p.min, p.max) for p in self.parameters(self.law(name))}

    def law_with(self, field):
        """Name of the only law that has the field."""
        having = [name for name in self.names if field in self.ranges(name)]
        assert len(having) == 1, (field, having)
        return having[0]

    def make(self, name, fields):
        """(accepted, state) of filter_init with these stored values on top of the defaults."""
        law, state = self.law(name), ctypes.create_string_buffer(1024)
        config = self.c.filter_defaults(law, fields["rate_dhz"])
        told = set(fields) - {"rate_dhz"}
        for i, p in enumerate(self.parameters(law)):
            field = field_of(p)
            if field in fields:
                config.value[i] = fields[field]
                told.discard(field)
        assert not told, f"{name} has no {told}"
        return self.c.filter_init(state, law, ctypes.byref(config)) == 0, state

    def update(self, state, z):
        return self.c.filter_update(state, z)

    def gain(self, state):
        probe = Probe()
        self.c.filter_probe(state, ctypes.byref(probe))
        return probe.gain_uq16 / 65536

    def noise_gain(self, b0_uq16, a1_q16):
        return self.c.filter_synth_noise_gain_uq16(b0_uq16, a1_q16) / 65536


def compiles_and_runs(initialiser, name):
    """True when a program with the emitted line in it compiles without a warning and filter_init accepts it."""
    source, program = OUT / f"emitted_{name}.c", OUT / f"emitted_{name}"
    source.write_text(f'#include "filter.h"\n{initialiser}\n'
                      f'int main(void) {{ filter_t f; return filter_init(&f, &filter_law_{name}, &config); }}\n', encoding="utf-8")
    library = compiled_library()
    command = ["gcc", "-std=c11", "-Wall", "-Wextra", "-Wconversion", "-Werror", "-Ilib/machine/src", "-Ilib/filters/src", str(source), str(library),
               f"-Wl,-rpath,{library.parent}", "-o", str(program)]
    subprocess.run(command, check=True, capture_output=True)
    return subprocess.run([str(program)]).returncode == 0
