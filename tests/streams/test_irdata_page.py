"""docs/reference/irdata.md, the definition of the format, has every record and part that irlx writes."""

import re
from dataclasses import MISSING, fields
from pathlib import Path

import pytest

import irlx.blocks
from irlx.blocks import Block
from irlx.reproduction import GIVEN
from irlx.streams.irdata.codes import BLOCK_CODES

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "irdata.md"
TEXT = PAGE.read_text(encoding="utf-8")


def cells(line):
    """Cells of a row of a table; a bar inside of code is none of its borders."""
    return [cell.strip() for cell in re.split(r"(?<!\|)\|(?!\|)", line.strip().strip("|"))]


def told_parts():
    """Parts of the blocks of each code, with their defaults as the page has them."""
    _, _, section = TEXT.partition("| code | part | value | default |\n|---|---|---|---|\n")
    found, codes = {}, []
    for line in section.partition("\n\n")[0].splitlines():
        code, part, _, default = cells(line)
        codes = re.findall(r"`(\d+)`", code) or codes
        for number in codes:
            own = found.setdefault(int(number), {})
            own |= dict.fromkeys(re.findall(r"`([\w.]+)`", part), default.strip("`"))
    return found


def test_every_block_has_its_code():
    rows = re.findall(r"^\| `(\d+)` \| [^|]+ \| `(\w+)` \|$", TEXT, re.MULTILINE)
    assert {name: int(code) for code, name in rows} == BLOCK_CODES


@pytest.mark.parametrize("name", BLOCK_CODES)
def test_every_part_of_a_block_is_told(name):
    shared = {field.name for field in fields(Block)}
    own = [field for field in fields(getattr(irlx.blocks, name)) if field.name not in shared]
    told = {part.partition(".")[0] for part in told_parts()[BLOCK_CODES[name]]}
    assert {part for part in told if part} == {field.name for field in own}
    for field in own:
        default = told_parts()[BLOCK_CODES[name]].get(field.name, "-")
        assert (default == "-") is (field.default is MISSING), field.name


def test_what_no_file_can_hold_is_told():
    (row,) = [line for line in TEXT.splitlines() if line.startswith("| `given` |")]
    assert set(re.findall(r'"(\w+)"', row)) == set(GIVEN)
