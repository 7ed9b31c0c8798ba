"""The mutants of a file: where, what instead, and a key that names neither line nor quoted source."""
import re
from collections import Counter
from dataclasses import dataclass

from lexer import closes_cast, is_type, lex, matching

RELATIONAL = {"<": ("<=", ">"), "<=": ("<", ">"), ">": (">=", "<"), ">=": (">", "<"), "==": ("!=", ">="), "!=": ("==", ">")}
ARITHMETIC = {"+": "-", "-": "+", "*": "+", "/": "*", "%": "*", "<<": ">>", ">>": "<<",
              "+=": "-=", "-=": "+=", "*=": "+=", "/=": "*=", "%=": "*=", "<<=": ">>=", ">>=": "<<=", "++": "--", "--": "++"}
LOGICAL = {"&&": "||", "||": "&&", "&": "|", "|": "&", "^": "|", "&=": "|=", "|=": "&=", "^=": "|="}
BINARY_OR_UNARY = {"+", "-", "*", "&"}
ASSIGNMENTS = {"=", "+=", "-=", "*=", "/=", "%=", "<<=", ">>=", "&=", "|=", "^=", "++", "--"}
NO_STATEMENT = set("return if for while do switch case default break continue goto else typedef static const volatile enum struct "
                   "union extern".split())
CRITICAL = {"hal_irq_save": "(0)", "hal_irq_restore": "(void)", "cli": "(void)", "sei": "(void)"}
CONSTANT = re.compile(r"(0[xX][0-9a-fA-F]+|\d+)([uUlL]*)")


@dataclass(frozen=True)
class Mutant:
    file: str
    owner: str
    operator: str
    change: str  # the token and what replaces it, as "< -> <="
    number: int  # of the same change in the same function, from 1
    edits: tuple  # (from, to, text), apart and in order

    @property
    def key(self):
        return f"{self.file}:{self.owner} {self.operator} {self.change} #{self.number}"

    def line(self, text):
        return text.count("\n", 0, self.edits[0][0]) + 1

    def apply(self, text):
        for begin, end, instead in reversed(self.edits):
            text = text[:begin] + instead + text[end:]
        return text


def changed_constants(text):
    """What is put in place of a number or character: one more, one less, twice."""
    if text.startswith("'"):
        return [f"({text} + 1)", f"({text} - 1)"]
    match = CONSTANT.fullmatch(text)
    if not match:
        return [f"({text} + 1)", f"({text} - 1)", f"(2 * {text})"]
    digits, suffix = match.groups()
    value = int(digits, 16 if digits[1:2] in ("x", "X") else 8 if digits != "0" and digits.startswith("0") else 10)
    wanted = dict.fromkeys(v for v in (value + 1, value - 1, 2 * value) if v != value)
    if "u" in suffix.lower():
        wanted.pop(-1, None)
    width = len(digits) - 2
    written = {v: f"{v:#0{width + 2}x}" if digits[1:2] in ("x", "X") else f"{v}" for v in wanted}
    return [f"{written[v]}{suffix}" if v >= 0 else f"({v}{suffix})" for v in wanted]


class Finder:
    """Walks the tokens of one piece."""

    def __init__(self, tokens, add):
        self.tokens, self.add = tokens, add

    def run(self):
        for i, token in enumerate(self.tokens):
            if token.opaque or not token.owner:
                continue
            if token.kind in ("number", "char"):
                for instead in changed_constants(token.text):
                    self.replace("constant", token, instead)
            elif token.body:
                self.body(i, token)

    def body(self, i, token):
        text = token.text
        if token.kind == "sign" and not (text in BINARY_OR_UNARY and not self.is_binary(i)):
            for instead in RELATIONAL.get(text, ()):
                self.replace("relational", token, instead)
            if text in ARITHMETIC:
                self.replace("arithmetic", token, ARITHMETIC[text])
            if text in LOGICAL:
                self.replace("logical", token, LOGICAL[text])
        if text in ("if", "while", "for", "?", "!"):
            self.negate(i, text)
        if self.begins_statement(i):
            self.remove(i)

    def replace(self, operator, token, instead):
        self.add(token.owner, operator, f"{token.text} -> {instead}", ((token.at, token.end, instead),))

    def is_binary(self, i):
        before = self.tokens[i - 1] if i else None
        if before is None or is_type(before):
            return False
        if before.text == ")":
            return not closes_cast(self.tokens, i - 1)
        return before.kind in ("word", "number", "char") and before.text != "return" or before.text == "]"

    def negate(self, i, text):
        tokens = self.tokens
        begin, end = i + 2, 0
        if text == "!":
            first_of_condition = i >= 2 and tokens[i - 1].text == "(" and tokens[i - 2].text in ("if", "while")
            if not first_of_condition:
                self.add(tokens[i].owner, "negated", "! -> ", ((tokens[i].at, tokens[i].end, ""),))
            return
        if text == "?":
            begin = end = i
            while begin and not self.ends_condition_backward(begin - 1):
                begin = self.opening(begin - 1) if tokens[begin - 1].text in (")", "]") else begin - 1
        elif i + 1 < len(tokens) and tokens[i + 1].text == "(":
            end = matching(tokens, i + 1)
            if text == "for":
                parts = [j for j in range(i + 2, end) if tokens[j].text == ";"]
                if len(parts) != 2 or parts[1] == parts[0] + 1:
                    return
                begin, end = parts[0] + 1, parts[1]
        if end > begin:
            first, last = tokens[begin].at, tokens[end - 1].end
            self.add(tokens[i].owner, "negated", f"{text} -> !", ((first, first, "!("), (last, last, ")")))

    def ends_condition_backward(self, j):
        return self.tokens[j].text in ("(", "[", "{", "}", ",", ";", ":", "?", "return") or self.tokens[j].text in ASSIGNMENTS - {"++", "--"}

    def opening(self, j):
        depth = 0
        while j >= 0:
            depth += self.tokens[j].text in (")", "]", "}")
            depth -= self.tokens[j].text in ("(", "[", "{")
            if depth == 0:
                return j
            j -= 1
        return 0

    def begins_statement(self, i):
        if i == 0:
            return self.tokens[0].owner.startswith("#")
        before = self.tokens[i - 1].text
        if before == ")":  # if (...) statement; without braces
            start = self.opening(i - 1)
            return start > 0 and self.tokens[start - 1].text in ("if", "while", "for")
        return before in (";", "{", "}", ":", "else", "do") and self.inside_braces(i)

    def inside_braces(self, i):
        """Not in the head of a for, not in an initialiser."""
        depth = 0
        for j in range(i - 1, -1, -1):
            text = self.tokens[j].text
            depth += (text in (")", "]", "}")) - (text in ("(", "[", "{"))
            if depth < 0:
                return text == "{" and (j == 0 or self.tokens[j - 1].text not in ("=", ",", "{", "("))
        return self.tokens[i].owner.startswith("#")

    def remove(self, i):
        tokens = self.tokens
        first = tokens[i]
        if first.text in NO_STATEMENT or first.text in ("{", "}", ";") or first.opaque or tokens[i].text in CRITICAL:
            return
        end = i
        while end < len(tokens) and tokens[end].text not in (";", "}") and tokens[end].text != "{":
            end = matching(tokens, end) + 1 if tokens[end].text in ("(", "[") else end + 1
        if end == i or end >= len(tokens) or tokens[end].text != ";" or self.declares(i, end):
            return
        flat = self.flat(i, end)
        assigned = next((t.text for t in flat if t.text in ASSIGNMENTS), "")
        calls = first.kind == "word" and any(t.text == "(" for t in flat) or first.text == "("
        if assigned or calls:
            name = self.target(i, assigned) if assigned else first.text
            self.add(first.owner, "statement", f"{name} -> ;", ((first.at, tokens[end - 1].end, ""),))

    def target(self, i, assigned):
        words = []
        while self.tokens[i].text != assigned and len(words) < 8:
            words.append(self.tokens[i].text)
            i += 1
        return "".join(words) + assigned

    def flat(self, i, end):
        """The tokens of a statement without what is in its brackets."""
        found = []
        while i < end:
            found.append(self.tokens[i])
            i = matching(self.tokens, i) + 1 if self.tokens[i].text in ("(", "[") else i + 1
        return found

    def declares(self, i, end):
        """`uint8_t a`, `thing a = ...` or `thing *a`: two words in a row."""
        words = self.tokens[i:end]
        if is_type(words[0]):
            return True
        if len(words) > 2 and words[0].kind == "word" and words[1].text == "*" and words[2].kind == "word":
            return True
        return len(words) > 1 and words[0].kind == "word" and words[1].kind == "word"


def critical_sections(tokens):
    """(owner, what, edits) of each function: all its enters and leaves at once, and each cli or sei."""
    found, sections = [], {}
    for i, token in enumerate(tokens[:-1]):
        if token.text not in CRITICAL or not token.body or tokens[i + 1].text != "(":
            continue
        end = matching(tokens, i + 1)
        if token.text == "hal_irq_save":
            edit = (token.at, tokens[end].end, "0")
        elif token.text == "hal_irq_restore":
            edit = (token.at, token.end, "(void)")
        else:
            edit = (token.at, tokens[end].end, "(void)0")
        if token.text in ("cli", "sei"):
            found.append((token.owner, f"{token.text} -> ;", (edit,)))
        else:
            sections.setdefault(token.owner, []).append(edit)
    for owner, edits in sections.items():
        found.append((owner, "section -> ;", tuple(edits)))
    return found


def mutants_of(file, text):
    """All mutants of a source, in its order; what two operators would change alike counts once."""
    counts, seen, found = Counter(), set(), []

    def add(owner, operator, change, edits):
        if edits in seen:
            return
        seen.add(edits)
        change = re.sub(r"\s+", " ", change)
        counts[owner, operator, change] += 1
        found.append(Mutant(file, owner, operator, change, counts[owner, operator, change], edits))

    for piece in lex(text):
        for owner, change, edits in critical_sections(piece):
            add(owner, "critical", change, edits)
        Finder(piece, add).run()
    return sorted(found, key=lambda m: m.edits)
