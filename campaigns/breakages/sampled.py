"""Some of many, others for each commit, so that in time all have their turn (make mutants NAMED=yes SAMPLE=6, PLANTED=20, BREAKAGES=6)."""
import random
import subprocess


def by_commit(everything, count, who, what):
    """`count` of a list, which is told; all of it when count is 0 or no fewer."""
    if not count or count >= len(everything):
        return everything
    head = subprocess.run(["git", "rev-parse", "HEAD"], capture_output=True, text=True).stdout.strip()
    print(f"{who}: {count} of {len(everything)} {what}, chosen by commit {head[:8] or 'none'}", flush=True)
    return random.Random(head).sample(everything, count)
