"""The catalogue of beginners' mistakes: each is named where it is, and none hides another far from it."""

import random
import re
from functools import cache

import pytest

from irlx.language.analysis import analyse
from irlx.language.source import source_text
from long_programs import long_program
from mistakes import MISTAKES

DRAWS = 2
MANY_DRAWS = 150
NEAR = 3
APART = 20
LENGTH = 1000


def found_in(lines):
    source = source_text("t.irl", "\n".join(lines) + "\n")
    analysis = analyse(source)
    for finding in analysis.diagnostics:
        assert 0 <= finding.place.span.start <= finding.place.span.end <= len(source.text)
    return analysis.diagnostics


@cache
def places_in(lines):
    """Where each mistake of the catalogue can be made."""
    return {mistake: mistake.places(lines) for mistake in MISTAKES}


def draw(chance, lines, count):
    """Lines with `count` mistakes at least `APART` lines apart, and the places (line numbers) of them."""
    possible, lines, made = places_in(tuple(lines)), list(lines), {}
    while len(made) < count:
        mistake = chance.choice(MISTAKES)
        if not all(mistake.goes_with(other) for other in made.values()):
            continue
        places = [i for i in possible[mistake] if all(abs(i - other) >= APART for other in made)]
        if places:
            place = chance.choice(places)
            lines[place] = mistake.made_in(lines[place])
            made[place] = mistake
    return lines, {place + 1: made[place].name for place in sorted(made)}


def told(findings):
    return [f"{f.place.line} {f.code} {f.message}" for f in findings]


@pytest.fixture(scope="module")
def programs():
    texts = [long_program(LENGTH, seed) for seed in range(4)]
    return [text.splitlines() for text in texts]


@pytest.fixture(scope="module")
def short_programs():
    return [long_program(210, seed).splitlines() for seed in range(2)]


def test_the_programs_are_sound(programs):
    for lines in programs:
        assert LENGTH <= len(lines) < LENGTH + 20
        assert told(found_in(lines)) == []


@pytest.mark.req("LANG-05")
@pytest.mark.req("LANG-71")
@pytest.mark.parametrize("mistake", MISTAKES, ids=lambda mistake: mistake.name)
@pytest.mark.parametrize("count", [1, pytest.param(4, marks=pytest.mark.slow)])
def test_one_mistake_is_named_where_it_is(short_programs, mistake, count):
    """One report, two at most where one word too few moves what follows; the first one says what to do."""
    for seed, lines in enumerate(short_programs if count > 1 else short_programs[:1]):
        chance = random.Random(seed)
        places = mistake.places(lines)
        assert places, mistake.name
        for place in chance.sample(places, min(count, len(places))):
            wrong = [*lines]
            wrong[place] = mistake.made_in(wrong[place])
            findings = found_in(wrong)
            assert 1 <= len(findings) <= 2, (wrong[place], told(findings))
            first = findings[0]
            assert first.code in mistake.code.split(), (wrong[place], told(findings))
            assert abs(first.place.line - (place + 1)) <= NEAR, (place + 1, told(findings))
            said = f"{first.message}\n{first.help}"
            assert all(word in said for word in mistake.says), said


@pytest.mark.req("LANG-05")
@pytest.mark.parametrize("count", [1, 10, *(pytest.param(count, marks=pytest.mark.slow) for count in (2, 4))])
def test_mistakes_far_apart(programs, count):
    check_draws(programs[:2], count, random.Random(count), DRAWS)


@pytest.mark.slow
@pytest.mark.req("LANG-05")
@pytest.mark.parametrize("count", range(1, 11))
def test_mistakes_far_apart_many_times(programs, count):
    check_draws(programs, count, random.Random(1000 + count), MANY_DRAWS)


def check_draws(programs, count, chance, draws):
    for _ in range(draws):
        wrong, made = draw(chance, chance.choice(programs), count)
        findings = found_in(wrong)
        shown = f"made: {made}\ntold: {told(findings)}"
        assert count <= len(findings) <= count + 2, shown
        for finding in findings:
            assert any(abs(finding.place.line - place) <= NEAR for place in made), shown
        for place in made:
            assert any(abs(finding.place.line - place) <= NEAR for finding in findings), shown


@pytest.mark.req("LANG-05")
def test_no_more_than_twenty_errors(programs):
    chance = random.Random(0)
    for _ in range(3):
        wrong, _ = draw(chance, programs[0], 30)
        assert sum(finding.is_error for finding in found_in(wrong)) <= 20


@pytest.mark.req("LANG-05")
def test_mistakes_in_a_program_without_indentation(programs):
    """Places are known less well then; the number of reports is not."""
    chance = random.Random(1)
    for count in range(1, 11, 3):
        wrong, made = draw(chance, programs[1], count)
        findings = found_in([re.sub("^ +", "", line) for line in wrong])
        assert 1 <= len(findings) <= 3 * count, (made, told(findings))
