#!/usr/bin/env python3
"""clang-tidy with the AVR target (int has 16 bits) over libraries, firmware and the chip's side of the HAL.

    check_tidy.py [FILE...]     only these files
"""
from check_support import chosen, main, parallel, report, run
from clang_avr import groups, relative, tool


def tidied(job):
    """What clang-tidy says of a file; a file that it cannot parse is a finding too."""
    path, options = job
    done = run(tool("clang-tidy"), "-quiet", path, "--", *options, expect=None)
    text = "\n".join(line for line in done.stdout.splitlines() if not line.endswith(" generated.") and "warnings generated" not in line)
    return None if done.returncode == 0 else relative(text.strip())


def check():
    jobs = [(path, options) for _, paths, options in groups() for path in paths]
    wanted = set(chosen({path for path, _ in jobs}))
    jobs = [job for job in jobs if job[0] in wanted]
    return report("clang-tidy, AVR target", [f for f in parallel(tidied, jobs) if f], f"{len(jobs)} files clean")


if __name__ == "__main__":
    main(check)
