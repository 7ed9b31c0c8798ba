"""Colours of the pictures and of the page."""
from tilt import protocol

RAW_COLOUR, GATED_COLOUR, TRUTH_COLOUR, GRID_COLOUR = "#9aa3ad", "#d1495b", "#111111", "#e3e6ea"
FILE_COLOURS = ("#1f5fbf", "#e07b00", "#0f8a5f", "#8b3fc4", "#b8860b", "#008b9e")
AXIS_COLOURS = {"x": "#1f5fbf", "y": "#e07b00", "z": "#0f8a5f"}
MISSING_BAND, WARMING_BAND = ("#cfd8e3", "no sample: predicted"), ("#fde9b8", "warming up")
OTHER_FLAG_COLOUR = "#555555"
FLAG_COLOURS = dict.fromkeys(protocol.FLAG_NAMES, OTHER_FLAG_COLOUR) | {
    protocol.GATED: GATED_COLOUR, protocol.COASTED: "#7a8ea5", protocol.SILENCE: "#3d4f63", protocol.CLIPPED: "#e07b00", protocol.STUCK: "#8b3fc4",
    protocol.WARMING_UP: "#e5b93c", protocol.NOT_GRAVITY: "#0f8a5f"}
