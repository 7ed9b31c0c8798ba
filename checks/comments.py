"""Source text without its comments: of C and its like, and of languages whose comments begin with #."""
import re

QUOTED = r'"(?:\\.|[^"\\\n])*"' + r"|'(?:\\.|[^'\\\n])*'"
# what is no comment stands in the group
C_CODE = re.compile(rf"({QUOTED})|/\*.*?\*/|//[^\n]*", re.S)
OTHER_CODE = re.compile(rf'^[ \t]*""".*?"""|(""".*?"""|{QUOTED})|(?:^|(?<=\s))#[^\n]*', re.S | re.M)
C_LIKE = {".c", ".h", ".cpp", ".hpp", ".ino", ".js", ".mjs", ".html", ".css"}


def without(text, suffix):
    """The text of a file with that suffix; each comment leaves a space and its line ends."""
    pattern = C_CODE if suffix in C_LIKE else OTHER_CODE
    return pattern.sub(lambda found: found[1] or " " + "\n" * found[0].count("\n"), text)
