"""Short ways to evaluate an expression, to interpret a program, and to catch where it goes wrong."""

import pytest

from irlx.blocks import Question
from irlx.blocks.text import block_text
from irlx.interpreter.context import Context
from irlx.interpreter.errors import InterpreterError
from irlx.interpreter.expressions import Expressions
from irlx.interpreter.interpret import Interpretation, declared_scope, interpret
from irlx.interpreter.machine import Machine
from irlx.interpreter.setting import Setting
from irlx.interpreter.world import World
from irlx.language.analysis import analyse
from irlx.language.source import source_text

DEFAULTS = {
    "R_SPEED": 250.0,
    "R_ACC": 1000.0,
    "R_SPEED_ORI": 90.0,
    "R_ACC_ORI": 180.0,
    "R_SPEED_PTP": 100.0,
    "R_ACC_PTP": 100.0,
}


@pytest.fixture
def setting():
    """A machine of a number of joints; the joints numbered in `slides` are prismatic."""

    def make(joints=7, slides=(), poses=None, obstacles=None):
        names = tuple(f"j{number}" for number in range(1, joints + 1))
        prismatic = tuple(n in slides for n in range(1, joints + 1))
        return Setting(names, prismatic, DEFAULTS, poses or {}, obstacles=obstacles)

    return make


@pytest.fixture
def value(setting):
    """Value of an expression after some declarations; `expected` names the type it stands for."""

    def evaluate(expression, declarations="", expected=None):
        text = f"PROGRAM t; {declarations} VAR REAL: unused; BEGIN unused := {expression}; ENDPROGRAM"
        analysis = analyse(source_text("t.irl", text))
        assert not [d for d in analysis.diagnostics if d.code.startswith("IRL1")], expression
        scope = declared_scope(analysis.tree, analysis.source, setting())
        (statement,) = analysis.tree.body
        wanted = scope.types[expected] if expected else None
        world = World(setting(), Machine())
        context = Context(analysis.source, scope, setting(), world.machine, rest=world.rest)
        return Expressions(context).value(statement.value, wanted).run([])

    return evaluate


@pytest.fixture
def generator(setting):
    """The block generator of a whole program text, to be driven by hand."""

    def start(text, **machine):
        analysis = analyse(source_text("t.irl", text))
        assert not [d for d in analysis.diagnostics if d.code.startswith("IRL1")], analysis.diagnostics
        return interpret(analysis.tree, analysis.source, setting(**machine))

    return start


@pytest.fixture
def blocks(generator):
    """Blocks of a declaration part and a body; a posture that is asked for is `posture`."""

    def run(declarations, body, posture=None, **machine):
        text = f"PROGRAM t;\n{declarations}\nBEGIN\n{body}\nENDPROGRAM"
        return list(_driven(generator(text, **machine), posture or (0.0,) * machine.get("joints", 7)))

    return run


def _driven(source, posture):
    answer = None
    while True:
        try:
            item = source.send(answer)
        except StopIteration:
            return
        answer = posture if isinstance(item, Question) else None
        if answer is None:
            yield item


@pytest.fixture
def final(setting):
    """What a program leaves in its variables: name -> value, structures opened into tuples."""

    def run(declarations, body, posture=None, joints=7, **more):
        text = f"PROGRAM t;\n{declarations}\nBEGIN\n{body}\nENDPROGRAM"
        analysis = analyse(source_text("t.irl", text))
        assert not [d for d in analysis.diagnostics if d.is_error], analysis.diagnostics
        ready = Interpretation(analysis.tree, analysis.source, setting(joints), **more)
        list(_driven(ready.run(), posture or (0.0,) * joints))
        return {name: opened(variable.value) for name, variable in ready.scope.variables.items()}

    return run


def opened(value):
    """A value with records and arrays opened into tuples."""
    return tuple(map(opened, value.values)) if hasattr(value, "values") else value


@pytest.fixture
def lines(blocks):
    """Blocks of a program as text lines."""

    def run(declarations, body, joints=7, slides=(), **more):
        units = ["m" if number in slides else "rad" for number in range(1, joints + 1)]
        found = blocks(declarations, body, joints=joints, slides=slides, **more)
        return [block_text(block, units) for block in found]

    return run


def told(error):
    """Code, message, and the text that the place of an error covers."""
    place = error.reason.place
    return error.reason.code, error.reason.message, place.text.text[place.span.start : place.span.end]


@pytest.fixture
def value_error(value):
    """Code, message and marked text of an expression that has no value."""

    def run(expression, declarations="", expected=None):
        with pytest.raises(InterpreterError) as caught:
            value(expression, declarations, expected)
        return told(caught.value)

    return run


@pytest.fixture
def run_error(blocks):
    """Code, message and marked text of a program that ends in an error."""

    def run(declarations, body, **machine):
        with pytest.raises(InterpreterError) as caught:
            blocks(declarations, body, **machine)
        return told(caught.value)

    return run
