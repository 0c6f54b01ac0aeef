"""XML with elements and attributes left out, doubled, moved, exchanged; and with entities that are traps."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable
from copy import deepcopy
from random import Random

from fuzzing.byte_damage import TEXT, damaged

SECRET = "c0ffee-of-another-file"
"""What stands in a file that no reader may look into."""
WORDS = (
    *(
        "",
        "0",
        "-1",
        "1e308",
        "-1e308",
        "1e-320",
        "nan",
        "inf",
        "-inf",
        "1e999",
        "x",
        "0 0 0",
        "1 2",
        "1 2 3 4",
        "0x10",
    ),
    *(
        "1e308 1e308 1e308",
        "nan 0 0",
        "9" * 400,
        "\u0661",
        "base",
        "tool",
        "../secret.stl",
        "/etc/passwd",
        "mesh.stl",
    ),
    *(
        "package://x/../../secret.stl",
        "file:///dev/zero",
        "http://localhost/x.stl",
        "missing.obj",
        "revolute",
        "fixed",
    ),
    *(
        "prismatic",
        "continuous",
        "planar",
        "floating",
        "1_0",
        " 1 ",
        "true",
        "\u00e9",
        "%00",
        "package://",
        "file://[x",
    ),
)
HEADS = (
    '<?xml version="1.0" encoding="utf-16"?>',
    '<?xml version="1.0" encoding="shift_jis"?>',
    '<?xml version="1.0" encoding="nonsense"?>',
    '<?xml version="9.9"?>',
    '<?xml-stylesheet href="secret.txt"?>',
    '<!DOCTYPE robot SYSTEM "secret.txt">',
    '<!DOCTYPE robot [<!ENTITY a "aaaaaaaaaa">'
    + "".join(f'<!ENTITY {new} "{f"&{old};" * 10}">' for old, new in zip("abcdefgh", "bcdefghi", strict=True))
    + "]>",
    '<!DOCTYPE robot [<!ENTITY i SYSTEM "secret.txt">]>',
    '<!DOCTYPE robot [<!ENTITY % p SYSTEM "secret.txt"> %p;]>',
    '<!DOCTYPE robot [<!ENTITY i "' + "x" * 50_000 + '">]>',
)
"""Beginnings of files; entities named i are used behind them."""
Change = Callable[[ET.Element, Random], None]


def _holders(root: ET.Element) -> list[ET.Element]:
    return [element for element in root.iter() if len(element)] or [root]


def remove(root: ET.Element, chance: Random) -> None:
    """An element is left out."""
    holder = chance.choice(_holders(root))
    if len(holder):
        del holder[chance.randrange(len(holder))]


def double(root: ET.Element, chance: Random) -> None:
    """An element comes twice or more often."""
    holder = chance.choice(_holders(root))
    if len(holder):
        one = holder[chance.randrange(len(holder))]
        for _ in range(chance.choice((1, 1, 1, 3, 600))):
            holder.append(deepcopy(one))


def move(root: ET.Element, chance: Random) -> None:
    """A copy of an element stands inside another one."""
    elements = list(root.iter())
    chance.choice(elements).append(deepcopy(chance.choice(elements[1:] or elements)))


def attribute(root: ET.Element, chance: Random) -> None:
    """An attribute is left out, gets another value or that of another element, as names that come twice."""
    elements = [element for element in root.iter() if element.attrib]
    if not elements:
        return
    element = chance.choice(elements)
    key = chance.choice(list(element.attrib))
    change = chance.randrange(4)
    if change == 0:
        del element.attrib[key]
    elif change == 1:
        element.set(key, chance.choice(WORDS))
    elif change == 2:
        alike = [one.attrib[key] for one in elements if key in one.attrib]
        element.set(key, chance.choice(alike))
    else:
        element.set(key, chance.choice(list(chance.choice(elements).attrib.values()) or [""]))


def link_ring(root: ET.Element, chance: Random) -> None:
    """A joint leads back to a link before it."""
    ends = [element for element in root.iter() if element.tag in ("parent", "child")]
    if len(ends) > 1:
        one, other = chance.sample(ends, 2)
        one.set("link", other.get("link", ""))


def tag(root: ET.Element, chance: Random) -> None:
    """An element is called like another one."""
    elements = list(root.iter())
    chance.choice(elements).tag = chance.choice(elements).tag


def number_scale(root: ET.Element, chance: Random) -> None:
    """Numbers of an attribute are larger or smaller by far."""
    elements = [element for element in root.iter() if element.attrib]
    if elements:
        element = chance.choice(elements)
        key = chance.choice(list(element.attrib))
        factor = chance.choice(("e6", "e-9", "e155", "e300", "e-200"))
        element.set(key, " ".join(word + factor for word in element.get(key, "").split()))


CHANGES: tuple[Change, ...] = (
    *(remove, remove, double, move, attribute, attribute, attribute, attribute, link_ring, tag, number_scale),
)


def damaged_xml(content: bytes, chance: Random) -> bytes:
    """An XML file damaged by elements, by its head, or by bytes."""
    choice = chance.random()
    if choice < 0.25:
        return damaged(content, chance, TEXT)
    try:
        root = ET.fromstring(content)
    except (ET.ParseError, ValueError, LookupError):
        return damaged(content, chance, TEXT)
    for _ in range(min(1 + int(chance.expovariate(0.8)), 6)):
        chance.choice(CHANGES)(root, chance)
    try:
        text = ET.tostring(root, encoding="unicode")
    except (TypeError, ValueError):
        return content
    if choice < 0.33:
        text = with_head(text, chance.choice(HEADS), chance)
    return text.encode("utf-8", "replace")


def with_head(text: str, head: str, chance: Random) -> str:
    """A text behind another head, with uses of its entity."""
    if "<!ENTITY i" in head:
        places = [at for at, character in enumerate(text) if character == '"']
        times = 1 if len(head) < 1000 else 2000
        at = chance.choice(places) + 1 if places and chance.random() < 0.7 else text.find(">") + 1
        text = text[:at] + "&i;" * times + text[at:]
    return head + text
