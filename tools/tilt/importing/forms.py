"""What surrounds the numbers of a line, and their separator. A plan is made from the first lines and then holds for the file."""
import re
from collections import Counter
from dataclasses import dataclass
from typing import Optional

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
IS_NUMBER = re.compile(rf"{NUMBER}|[-+]?nan", re.I)
NUMBERS = re.compile(rf"(?<![\w.]){NUMBER}(?![\w])")
DATE, CLOCK = r"\d{4}-\d{2}-\d{2}[ T]", r"\d{1,2}:\d{2}:\d{2}(?:\.\d+)?"
CLOCKED = re.compile(rf"(?:\[(?P<boxed>(?:{DATE})?{CLOCK})\]\s*(?:->)?|(?P<arrowed>(?:{DATE})?{CLOCK})\s*-?>|(?P<dated>{DATE}{CLOCK})(?=\s))"
                     r"\s?(?P<rest>.*)")
LITERAL = re.compile(r"""b(['"])(.*)\1\s*""")
ESCAPED_ENDS = re.compile(r"(?:\\[rnt])+$")
PAIRS = re.compile(rf"([A-Za-z_][\w-]*)\s*[=:]\s*({NUMBER})")
KEYED = re.compile(r"([A-Za-z][\w ,]*?)\s*:\s*(.*)")
DECIMAL_COMMA = re.compile(r"(?<![\d,.])(-?\d+),(\d+)(?![\d,.])")
RAW_NAME = re.compile(r"raw|lsb|count")
UNIT_WORDS = {"m/s^2": "m/s2", "m/s2": "m/s2", "m/s/s": "m/s2", "m/s²": "m/s2", "ms2": "m/s2", "ms-2": "m/s2", "g": "g", "mg": "mg",
              "mm/s2": "mm/s2", "mm/s^2": "mm/s2", "raw": "raw", "lsb": "raw", "counts": "raw"}
UNIT = re.compile(rf"(?<=[\d.])[\s,;]*({'|'.join(map(re.escape, sorted(UNIT_WORDS, key=len, reverse=True)))})(?!\s*[=:]|[\w/^²-])", re.I)


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
    unit: Optional[str] = None  # as printed in each row
    keywords: tuple = ()

    def plain(self):
        """Whether lines hold only numbers and separators, as the quick reader needs."""
        return not (self.clock or self.literal or self.keyword or self.names or self.decimal_comma or self.lead or self.unit) \
            and self.separator is not None

    def payload(self, line):
        """(time of the serial monitor or None, the rest); None if the line does not match this plan."""
        time = None
        if self.clock:
            time, line = clocked(line)
            if time is None:
                return None
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
        return time, self.tidy(line.strip())

    def tidy(self, text):
        """A payload without units and brackets, with decimal points."""
        text = UNIT.sub("", text) if self.unit else text
        text = DECIMAL_COMMA.sub(r"\1.\2", text) if self.decimal_comma else text
        return text[1:-1].strip() if text[:1] + text[-1:] in ("()", "[]") else text

    def fields(self, text):
        """The fields of a payload; None if it is text."""
        if self.names is not None:
            pairs = {name.lower(): value for name, value in PAIRS.findall(text)}
            return [pairs[name] for name in self.names if name in pairs] or None
        return self.cut(text)

    def cut(self, text):
        """The fields of a payload without what precedes the numbers."""
        text = text.rstrip("; ") if self.separator != ";" else text
        return [part.strip().strip('"') for part in text.split(self.separator)][self.lead:]


def is_number(text):
    return IS_NUMBER.fullmatch(text) is not None


def clocked(line):
    """(time of the serial monitor or None, the rest)"""
    match = CLOCKED.fullmatch(line)
    return (match["boxed"] or match["arrowed"] or match["dated"], match["rest"]) if match else (None, line)


def shape_of(line):
    """((clock, literal, keyword, names), payload) that one line suggests."""
    clock, body = clocked(line)
    literal = LITERAL.fullmatch(body.strip())
    body = ESCAPED_ENDS.sub("", literal.group(2)) if literal else body
    pairs = PAIRS.findall(body)
    names = tuple(name.lower() for name, _ in pairs) if len(pairs) >= 3 else None
    keyword = None
    match = KEYED.fullmatch(body.strip())
    if names is None and match and len(numbers_in(match.group(2))) >= 3:
        keyword, body = match.groups()
    return (clock is not None, literal is not None, keyword, names), body.strip()


def numbers_in(text):
    return NUMBERS.findall(UNIT.sub("", text))


def separator_of(payloads):
    """What splits most payloads into at least three fields; None: white space."""
    for separator in (",", ";", "\t", "|"):
        if sum(text.count(separator) >= 2 for text in payloads) > len(payloads) // 2:
            return separator
    return None


def plan_of(lines, sensor):
    """The plan of a file from its first lines; None if none holds three numbers. sensor: which of several keywords, from 1."""
    found = [shape_of(line.strip()) for line in lines if not line.lstrip().startswith("#")]
    shapes = [(shape, text) for shape, text in found if len(numbers_in(text)) >= 3 and text[0] != "#"]
    if not shapes:
        return None
    keywords = tuple(dict.fromkeys(shape[2] for shape, _ in shapes if shape[2] and re.search(r"\bacc", shape[2], re.I)))
    if keywords:
        wanted = keywords[min(sensor, len(keywords)) - 1]
        chosen = next(shape for shape, _ in shapes if shape[2] == wanted)
    else:
        chosen = usual_shape(Counter(shape for shape, _ in shapes))
    plan = Plan(*chosen, keywords=keywords)
    payloads = [text for shape, text in shapes if shape == chosen]
    plan.decimal_comma = sum(len(DECIMAL_COMMA.findall(text)) >= 3 for text in payloads) > len(payloads) // 2
    units = Counter(word.lower() for text in payloads for word in UNIT.findall(text)[-1:])
    plan.unit = UNIT_WORDS[units.most_common(1)[0][0]] if units.total() > len(payloads) // 2 else None
    payloads = [plan.tidy(text) for text in payloads]
    plan.separator = separator_of(payloads)
    if plan.names is None:
        plan.lead = lead_of(plan, payloads)
    return plan


def usual_shape(counts):
    """The most frequent shape; of lines that alternate, the one of raw counts."""
    most = max(counts.values())
    return max(counts, key=lambda shape: (2 * counts[shape] > most and any(map(RAW_NAME.search, shape[3] or ())), counts[shape]))


def lead_of(plan, payloads):
    """How many empty fields or words precede the numbers of a row."""
    leads = Counter()
    for text in payloads:
        found = plan.cut(text)
        while found and not any(character.isdigit() for character in found[0]):
            found = found[1:]
        leads[len(plan.cut(text)) - len(found)] += 1
    return leads.most_common(1)[0][0]
