"""The filter given by --a and --b, or why there is none."""
import math

from . import nearest
from .response import HORIZON_MAX, pole_radius
from .structure import Filter, as_printed


class Wrong(Exception):
    """One sentence: what in the request is impossible."""


def given_filter(options, request):
    """The filter of --a and --b; Wrong, with the nearest possible one, if it is unstable or its response too long."""
    if len(options.b) != request.l + 1:
        raise Wrong(f"--b has {len(options.b)} numbers, but l = {request.l} needs {request.l + 1}; nearest: -l {len(options.b) - 1}")
    a = options.a if options.a is not None else (0.0,) * request.k
    if len(a) != request.k:
        raise Wrong(f"--a has {len(a)} numbers, but k = {request.k}; nearest: -k {len(a)}")
    if not all(math.isfinite(x) for x in (*a, *options.b)):
        raise Wrong(f"--a and --b must be finite numbers; nearest: {nearest.words((0.0,) * len(a), nearest.raw(request.l))}")
    if sum(options.b) == 0 or (len(options.b) > 1 and options.as_printed and options.b[0] == 1):
        raise Wrong("b0 + ... + bl must not be 0, nor b0 be 1 in the printed form with l > 0; "
                    f"nearest: --b {nearest.numbers(nearest.raw(request.l))}")

    def made(b):
        return as_printed(request.v, a, b) if options.as_printed else Filter(request.v, tuple(a), tuple(b))

    f = made(options.b)
    if not f.exact().stable():
        raise Wrong(f"{parameters(f)} is unstable: {why_unstable(f)}; nearest: {nearest.on_the_way(made, a, options.b)}")
    if not nearest.ends(f):
        raise Wrong(f"the response of {parameters(f)} does not die out within {HORIZON_MAX:,} samples (pole radius {pole_radius(f):.9g}); "
                    f"nearest: {nearest.on_the_way(made, a, options.b)}")
    return f


def parameters(f):
    return ", ".join([f"a{i + 1} = {x:g}" for i, x in enumerate(f.a)] + [f"b{j} = {x:g}" for j, x in enumerate(f.b)])


def why_unstable(f):
    if f.order == (2, 1, 0) and 1 + 2 * f.a[0] * (1 - f.b[0]) <= 0:
        return f"1 + 2 a1 (1 - b0) = {1 + 2 * f.a[0] * (1 - f.b[0]):.4g} is not above 0"
    return f"its slowest pole has radius {pole_radius(f):.6g}"
