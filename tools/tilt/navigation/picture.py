"""Errors of a flight with their sigmas, times without GPS shaded."""
import io

import numpy as np

from tilt.errors import TiltError
from tilt.look import GRID_COLOUR, MISSING_BAND

COLOURS = ("#1f5fbf", "#e07b00", "#0f8a5f")
AXES = ("north", "east", "down")
SIGMA_ALPHA = 0.9
DPI, PNG_COLOURS = 90, 48


def draw(path, title, flight, found, outcome):
    """PNG, SVG or PDF by the suffix: attitude, velocity, position, each axis with +-1 sigma (dashed)."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    t_sigma, sigmas = outcome.sigmas()
    panels = (("attitude error, degree", found.attitude_deg, np.degrees(sigmas[:, 6:9]), "about "),
              ("velocity error, m/s", found.velocity_mps, sigmas[:, 3:6], ""), ("position error, m", found.position_m, sigmas[:, 0:3], ""))
    figure, places = pyplot.subplots(3, 1, figsize=(10, 9), sharex=True, constrained_layout=True)
    for place, (name, error, sigma, word) in zip(places, panels):
        for axis in range(3):
            place.plot(found.t_s, error[:, axis], color=COLOURS[axis], lw=0.9, label=word + AXES[axis])
            for sign in (-1, 1):
                place.plot(t_sigma, sign * sigma[:, axis], color=COLOURS[axis], lw=0.9, ls="--", alpha=SIGMA_ALPHA,
                           label="+-1 sigma" if (axis, sign) == (2, 1) else None)
        settled = found.t_s > 10.0
        largest = max(np.abs(error[settled]).max(initial=1e-3), 1e-3)
        place.set_ylim(-1.15 * largest, 1.15 * largest)
        place.set_ylabel(name)
        place.grid(color=GRID_COLOUR)
        for number, (begin, end) in enumerate(flight.gps_gaps()):
            place.axvspan(begin, end, color=MISSING_BAND[0], alpha=0.6, lw=0, label=None if number else "no GPS")
    places[2].set_yscale("symlog", linthresh=1.0)
    places[0].legend(loc="upper left", ncols=5, fontsize=8)
    places[0].set_title(title)
    places[2].set_xlabel("s")
    try:
        save(figure, path)
    except (OSError, ValueError) as why:
        raise TiltError(f"{path}: {why}") from why
    finally:
        pyplot.close(figure)


def save(figure, path):
    """Saves a PNG in a few colours: a quarter of the bytes."""
    if not str(path).lower().endswith(".png"):
        figure.savefig(path)
        return
    from PIL import Image

    drawn = io.BytesIO()
    figure.savefig(drawn, format="png", dpi=DPI)
    drawn.seek(0)
    Image.open(drawn).convert("RGB").quantize(PNG_COLOURS, dither=Image.Dither.NONE).save(path, optimize=True)
