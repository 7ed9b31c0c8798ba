"""What the compared filters cost on the simulated chip: those of campaigns/bench/bench_peers.py and its runs, the peers in float."""
import concurrent.futures
import pathlib

from bench_firmware import image_size
from bench_peers import ADAPTERS, CORES, FOLDER, NOTHING, Subject, build, compiled, simulated, write_stream
from comparison_filters import FUSION, OURS, PEERS, WEIGHED

SUPPORT = pathlib.Path("host_tests/support").resolve()
KINDS = dict(zip(PEERS, ("PEER_EMA_ALONE", "PEER_MEDIAN3_EMA", "PEER_MEDIAN_EMA", "PEER_HAMPEL_EMA", "PEER_EURO")))
ROBUST = dict(zip(WEIGHED, ("ROBUST_HUBER", "ROBUST_STUDENT", "ROBUST_CORRENTROPY", "ROBUST_IMM")))
OTHER = "../tools/comparison/peer_other.c"
OF_FUSION = Subject(FUSION, "", "../tools/comparison/fusion.c", ("Fusion/Fusion",), ("Fusion/Fusion/FusionAhrs.c",))


def subjects(peers):
    """Ours, the peers, and Fusion where it is there."""
    ours = [Subject(name, "", "peer_law.c", options=(f"-DPEER_LAW=filter_law_{name}",)) for name in OURS]
    theirs = [Subject(name, "", OTHER, sources=(SUPPORT / "peers.c",), options=(f"-DPEER_KIND={kind}",)) for name, kind in KINDS.items()]
    theirs += [Subject(name, "", OTHER, sources=(SUPPORT / "robust_peers.c",), options=(f"-DPEER_ROBUST={kind}",)) for name, kind in ROBUST.items()]
    return [*ours, *theirs, *([OF_FUSION] if (peers / OF_FUSION.folders[0]).is_dir() else [])]


def measure(flags, sources, peers):
    """{filter: row of bench_peers, with flash and RAM}"""
    FOLDER.mkdir(parents=True, exist_ok=True)
    truth, _ = write_stream()
    wanted = [NOTHING, *subjects(peers)]
    with concurrent.futures.ThreadPoolExecutor(CORES) as workers:
        own = [ADAPTERS / "peer_run.c", FOLDER / "stream.c", *sources]
        objects = list(workers.map(lambda source: compiled(source, flags, FOLDER / "own"), own))
        harness, library = objects[:2], objects[2:]
        images = list(workers.map(lambda subject: build(subject, flags, harness + ([] if subject.folders else library), peers), wanted))
        rows = list(workers.map(simulated, wanted[1:], images[1:], [truth] * len(images[1:])))
    empty, *sizes = map(image_size, images)
    for row, size in zip(rows, sizes):
        row.update(flash=size[0] - empty[0], ram=size[1] - empty[1])
    return {subject.name: row for subject, row in zip(wanted[1:], rows)}
