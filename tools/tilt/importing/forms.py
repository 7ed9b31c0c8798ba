"""What surrounds the numbers of a line, and their separator. A plan is made from the first lines and then holds for the file."""
import re
from collections import Counter
from dataclasses import dataclass
from typing import Optional

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
IS_NUMBER = re.compile(rf"{NUMBER}|[-+]?nan", re.I)
NUMBERS = re.compile(rf"(?<![\w.]){NUMBER}(?![\w])")
CLOCKED = re.compile(r"(\d{1,2}:\d{2}:\d{2}(?:\.\d+)?)\s*->\s?(.*)")
LITERAL = re.compile(r"""b(['"])(.*)\1\s*""")
ESCAPED_ENDS = re.compile(r"(?:\\[rnt])+$")
PAIRS = re.compile(rf"([A-Za-z_]\w*)\s*[=:]\s*({NUMBER})")
KEYED = re.compile(r"([A-Za-z][\w ]*?)\s*:\s*(.*)")
UNIT_WORDS = {"m/s^2": "m/s2", "m/s2": "m/s2", "m/s/s": "m/s2", "m/s²": "m/s2", "ms2": "m/s2", "ms-2": "m/s2", "g": "g", "mg": "mg",
              "mm/s2": "mm/s2", "mm/s^2": "mm/s2", "raw": "raw", "lsb": "raw", "counts": "raw"}


@dataclass
class Plan:
    """How a line becomes fields. keyword: only lines with it are rows. names: the keys of NAME = VALUE lines."""
    clock: bool = False
    literal: bool = False
    keyword: Optional[str] = None
    names: Optional[tuple] = None
    separator: Optional[str] = ","  # None: white space
    decimal_comma: bool = False
    lead: int = 0  # fields before the first number, which are dropped
    unit: Optional[str] = None  # as printed at the end of each row
    keywords: tuple = ()

    def plain(self):
        """Whether lines hold only numbers and separators, as the quick reader needs."""
        return not (self.clock or self.literal or self.keyword or self.names or self.decimal_comma or self.lead or self.unit) \
            and self.separator is not None

    def payload(self, line):
        """(time of the serial monitor or None, the rest); None if the line does not match this plan."""
        time = None
        if self.clock:
            match = CLOCKED.fullmatch(line)
            if match is None:
                return None
            time, line = match.groups()
        if self.literal:
            match = LITERAL.fullmatch(line.strip())
            if match is None:
                return None
            line = ESCAPED_ENDS.sub("", match.group(2))
        if self.keyword is not None:
            match = KEYED.fullmatch(line.strip())
            if match is None or match.group(1) != self.keyword:
                return None
            line = match.group(2)
        return time, line.strip()

    def fields(self, text):
        """The fields of a payload; None if it is text."""
        if self.names is not None:
            pairs = {name.lower(): value for name, value in PAIRS.findall(text)}
            return [pairs[name] for name in self.names if name in pairs] or None
        return self.cut(text)

    def cut(self, text):
        """The fields of a payload without the unit at its end and what precedes the numbers."""
        text = text.rstrip("; ") if self.separator != ";" else text
        found = [part.strip().strip('"') for part in text.split(self.separator)]
        if self.unit and found and found[-1].lower() in UNIT_WORDS:
            found.pop()
        if self.decimal_comma:
            found = [part.replace(",", ".") for part in found]
        return found[self.lead:]


def is_number(text):
    return IS_NUMBER.fullmatch(text) is not None


def shape_of(line):
    """((clock, literal, keyword, names), payload) that one line suggests."""
    clock = CLOCKED.fullmatch(line)
    body = clock.group(2) if clock else line
    literal = LITERAL.fullmatch(body.strip())
    body = ESCAPED_ENDS.sub("", literal.group(2)) if literal else body
    pairs = PAIRS.findall(body)
    names = tuple(name.lower() for name, _ in pairs) if len(pairs) >= 3 else None
    keyword = None
    match = KEYED.fullmatch(body.strip())
    if names is None and match and len(NUMBERS.findall(match.group(2))) >= 3:
        keyword, body = match.groups()
    return (clock is not None, literal is not None, keyword, names), body.strip()


def separator_of(payloads):
    """(separator, decimal comma?) that splits the most lines into at least three fields."""
    comma_decimals = sum(";" in text and re.search(r"\d,\d", text) is not None and "." not in text and text.count(";") >= 2 for text in payloads)
    if comma_decimals > len(payloads) // 2:
        return ";", True
    for separator in (",", ";", "\t"):
        if sum(text.count(separator) >= 2 for text in payloads) > len(payloads) // 2:
            return separator, False
    return None, False


def plan_of(lines, sensor):
    """The plan of a file from its first lines; None if none holds three numbers. sensor: which of several keywords, from 1."""
    found = [shape_of(line.strip()) for line in lines if not line.lstrip().startswith("#")]
    shapes = [(shape, text) for shape, text in found if len(NUMBERS.findall(text)) >= 3 and text[0] != "#"]
    if not shapes:
        return None
    counts = Counter(shape for shape, _ in shapes)
    keywords = tuple(dict.fromkeys(shape[2] for shape, _ in shapes if shape[2] and re.search(r"\bacc", shape[2], re.I)))
    chosen = counts.most_common(1)[0][0]
    if keywords:
        wanted = keywords[min(sensor, len(keywords)) - 1]
        chosen = next(shape for shape, _ in shapes if shape[2] == wanted)
    clock, literal, keyword, names = chosen
    plan = Plan(clock, literal, keyword, names, keywords=keywords)
    payloads = [text for shape, text in shapes if shape == chosen]
    plan.separator, plan.decimal_comma = separator_of(payloads)
    if names is None:
        strip_ends(plan, payloads)
    else:
        words = payloads[0].split()
        plan.unit = UNIT_WORDS.get(words[-1].lower())
    return plan


def strip_ends(plan, payloads):
    """Drops empty fields and words before the numbers of every row, and the unit after them."""
    last = Counter(text.rstrip("; ").split(plan.separator)[-1].strip().lower() for text in payloads).most_common(1)[0][0]
    plan.unit = UNIT_WORDS.get(last)
    leads = Counter()
    for text in payloads:
        found = plan.cut(text)
        while found and not any(character.isdigit() for character in found[0]):
            found = found[1:]
        leads[len(plan.cut(text)) - len(found)] += 1
    plan.lead = leads.most_common(1)[0][0]
