"""For platformio.ini: PlatformIO passes -ffunction-sections only to the compiler, but link-time optimisation makes the sections that
hal/avr/uno.ld orders."""
Import("env")  # noqa: F821
env.Append(LINKFLAGS=["-ffunction-sections"])  # noqa: F821
