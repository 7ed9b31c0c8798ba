"""For platformio.ini: PlatformIO hands -ffunction-sections to the compiler alone, but link-time optimisation makes the sections that
hal/avr/uno.ld puts in order."""
Import("env")  # noqa: F821
env.Append(LINKFLAGS=["-ffunction-sections"])  # noqa: F821
