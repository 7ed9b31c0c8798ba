"""The programs that judge the navigation filter: nav/lib in its four variants, each a library of its own, and the image's link."""
import os
import pathlib
import shlex

from host import Host
from shop import plain, run

EXTRA = ["nav/tests/nav_flights.c", "nav/tests/nav_running.c", "nav/tests/nav_histories.c"]


def sources(folder, without=()):
    return sorted(str(p) for p in pathlib.Path(folder).glob("*.c") if str(p) not in without)


class Variants(Host):
    """9 and 12 states, float and double. Their functions have the same names, so each library binds its own (-Bsymbolic)."""

    def __init__(self, settings, tree, tilt):
        super().__init__(settings, "ubsan", tree)
        self.variant, self.folder = "nav", self.folder.with_name("nav")
        self.objects = self.objects.named("nav", self.command)
        self.of = {word: shlex.split(os.environ[f"NAV_OF_{word}"]) for word in os.environ["NAV_VARIANTS"].split()}
        self.inside = [*sources("nav/lib"), "nav/tests/nav_variant.c"]
        self.product = [f"{word}:{source}" for word in self.of for source in self.inside]
        self.supports = [*settings.supports, *EXTRA]
        self.tests = [name for name in sorted(p.stem for p in pathlib.Path("nav/tests").glob("test_nav*.c")) if name != "test_nav_link"]
        self.tilt = tilt

    def command(self, source):
        word = source.split(":")[0] if ":" in source else None
        more = ["-ffp-contract=off", "-Inav/lib", *(self.of[word] if word else [])]
        return [*super().command(plain(source)), *more, *([f"-DNAV_VARIANT={word}"] if word else [])]

    def link_product(self):
        self.tilt.link_product()
        with self.archiving:
            if not self.library:
                self.library = [*self.variant_libraries({}, self.folder), *self.tilt.library]

    def variant_libraries(self, changed, out):
        """The libraries of the variants that hold one of these objects (of all where there are none); None where one does not link."""
        found = []
        for word in self.of:
            objects = {source: self.objects.object(source) for source in self.product if source.startswith(f"{word}:")}
            if changed and not objects.keys() & changed.keys():
                continue
            target = out / f"lib{word}.so"
            objects |= {source: changed[source] for source in objects.keys() & changed.keys()}
            if run(["ld", "-shared", "-Bsymbolic", "-soname", target.name, *objects.values(), "-o", target], self.tree)[0] != 0:
                return None
            found.append(target)
        return found

    def mutant_library(self, changed, out):
        return self.variant_libraries(changed, out)


class Link(Host):
    """The navigation image's link, on a line of the test's own."""

    def __init__(self, settings, tree):
        super().__init__(settings, "ubsan", tree)
        self.variant, self.folder = "navlink", self.folder.with_name("navlink")
        self.objects = self.objects.named("navlink", self.command)
        self.product = [*sources("nav/image", ["nav/image/main.c"]), *sources("nav/lib")]
        self.supports = ["nav/tests/nav_line.c", "host_tests/support/random.c", "host_tests/support/test.c"]
        self.tests = ["test_nav_link"]

    def command(self, source):
        return [*super().command(source), *shlex.split(os.environ["NAV_RINGS"]), "-Inav/image", "-Ilib/machine/src", "-Inav/lib"]
