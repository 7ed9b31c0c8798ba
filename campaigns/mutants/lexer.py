"""C as tokens, each with the function, macro or constant that it belongs to.

A lexer, not a compiler's tree: it sees macro bodies and both sides of `#ifdef __AVR__`, which a tree has not; what it takes
wrongly for an operator does not compile and is dropped.
"""
import re
from dataclasses import dataclass

TOKEN = re.compile(
    r"""(?P<space>\s+|\\\n|//[^\n]*|/\*.*?\*/)
    |(?P<string>L?"(?:[^"\\]|\\.)*")
    |(?P<char>'(?:[^'\\]|\\.)+')
    |(?P<number>0[xX][0-9a-fA-F]+[uUlL]*|(?:\d+\.\d*|\.\d+|\d+(?=[eE][-+]?\d))(?:[eE][-+]?\d+)?[fFlL]?|\d+[uUlL]*)
    |(?P<word>[A-Za-z_]\w*)
    |(?P<sign><<=|>>=|\.\.\.|->|\+\+|--|<<|>>|<=|>=|==|!=|&&|\|\||[-+*/%&|^]=|\#\#|.)""",
    re.X | re.S)
DIRECTIVE = re.compile(r"^[ \t]*#[ \t]*(\w*)((?:[^\n\\/]|\\.|\\\n|/(?!\*)|/\*.*?\*/)*)", re.M | re.S)
DEFINE = re.compile(r"[ \t]*(\w+)(\([^)]*\))?")
TYPES = set("char short int long unsigned signed float double void const volatile struct union enum bool static register".split())
# what is in their parentheses is no behaviour
OPAQUE = {"_Static_assert", "static_assert", "__attribute__", "__asm__", "asm", "sizeof", "_Alignof"}


@dataclass
class Token:
    kind: str  # string, char, number, word or sign
    text: str
    at: int
    owner: str = ""  # function, #macro, or what a constant at file level belongs to
    body: bool = False  # of a function or macro, where there are statements
    opaque: bool = False

    @property
    def end(self):
        return self.at + len(self.text)


def tokens_of(text, begin, end):
    found = []
    while begin < end:
        match = TOKEN.match(text, begin, end)
        if match.lastgroup != "space":
            found.append(Token(match.lastgroup, match.group(), begin))
        begin = match.end()
    return found


def matching(tokens, at):
    """The index of the bracket that closes the one at `at` (the last token where none does)."""
    depth = 0
    for i in range(at, len(tokens)):
        if tokens[i].text in ("(", "[", "{"):
            depth += 1
        elif tokens[i].text in (")", "]", "}"):
            depth -= 1
            if depth == 0:
                return i
    return len(tokens) - 1


def is_type(token):
    return token.text in TYPES or (token.kind == "word" and token.text.endswith("_t"))


def closes_cast(tokens, at):
    """Whether the `)` at `at` ends a cast: only words of types and stars stand within."""
    i = at - 1
    while i >= 0 and tokens[i].text != "(":
        if not (is_type(tokens[i]) or tokens[i].text == "*"):
            return False
        i -= 1
    return i >= 0 and at - i > 1 and not (i > 0 and tokens[i - 1].kind == "word" and not is_type(tokens[i - 1]) and tokens[i - 1].text != "return")


def mark_opaque(tokens):
    for i, token in enumerate(tokens[:-1]):
        if token.text in OPAQUE:
            start = i + 1
            while start < len(tokens) - 1 and tokens[start].kind == "word":  # __asm__ volatile (
                start += 1
            if tokens[start].text == "(":
                for inside in tokens[i:matching(tokens, start) + 1]:
                    inside.opaque = True


def function_name(head):
    """The name in a declaration's tokens before its brace: `ISR(TIMER1_COMPA_vect)` or `scale_up`; None if it is no function."""
    head = [t for t in head if not t.opaque]
    for i, token in enumerate(head[:-1]):
        if token.text == "=":
            return None
        if token.kind == "word" and head[i + 1].text == "(":
            return f"{token.text}({head[i + 2].text})" if token.text == "ISR" else token.text
    return None


def name_inside(tokens, whole):
    """Constants at file level belong to the enumerator or the variable before them."""
    owner = next((t.text for i, t in enumerate(whole[:-1]) if t.kind == "word" and whole[i + 1].text in ("[", "=", "{")), "")
    enumerators = any(t.text == "enum" for t in whole[:3])
    for i, token in enumerate(tokens):
        if enumerators and token.kind == "word" and i + 1 < len(tokens) and tokens[i + 1].text in ("=", ",", "}"):
            owner = token.text if tokens[i + 1].text == "=" else owner
        token.owner = owner


def own_declarations(tokens):
    """Names the owner of each token of a file, one declaration at file level after the other."""
    start = at = 0
    while at < len(tokens):
        text = tokens[at].text
        if text == ";":
            name_inside(tokens[start:at], tokens[start:at])
            start = at = at + 1
        elif text in ("(", "["):
            at = matching(tokens, at) + 1
        elif text == "{":
            end = matching(tokens, at)
            name = function_name(tokens[start:at])
            if tokens[start].text == "extern" and tokens[start + 1].kind == "string":  # extern "C" {
                start = at = at + 1
            elif name is None:
                name_inside(tokens[start:end + 1], tokens[start:end + 1])
                at = end + 1
            else:
                for token in tokens[at:end + 1]:
                    token.owner, token.body = name, True
                start = at = end + 1
        elif text == "}":
            start = at = at + 1
        else:
            at += 1


def lex(text):
    """Pieces of a file that stand alone, each a list of tokens: its declarations, then each macro's body."""
    pieces, blank = [], list(text)
    # a comment can hold a line that looks like a directive
    comments = [m.span() for m in re.finditer(r"/\*.*?\*/|\"(?:[^\"\\\n]|\\.)*\"|//[^\n]*", text, re.S)]
    for match in DIRECTIVE.finditer(text):
        if any(begin < match.start() < end for begin, end in comments):
            continue
        for i in range(match.start(), match.end()):
            blank[i] = " "
        head = DEFINE.match(match.group(2)) if match.group(1) == "define" else None
        if head and head.group(1):
            body = tokens_of(text, match.start(2) + head.end(), match.end())
            for token in body:
                token.owner, token.body = f"#{head.group(1)}", True
            pieces.append(body)
    tokens = tokens_of("".join(blank), 0, len(text))
    mark_opaque(tokens)
    own_declarations(tokens)
    for piece in pieces:
        mark_opaque(piece)
    return [tokens, *pieces]
