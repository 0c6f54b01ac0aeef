"""What stands beside the scene: time, program, joints, curves, obstacles, summary."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

from irlx.diagnostics import Diagnostic
from irlx.diagnostics.text import render_text
from irlx.report.lines import LABEL, Line, Tone
from irlx.viewer.curves import Curves, curves
from irlx.viewer.joint_html import joint_html
from irlx.viewer.program_html import ProgramHtml
from irlx.viewer.shown import Shown
from irlx.viewer.trail import ON_TIME, SLOWED

_SPEEDS = {"1/10": 0.1, "1/4": 0.25, "1/2": 0.5, "1": 1.0, "2": 2.0, "4": 4.0, "10": 10.0}
_NOTHING = "nothing"
_MONO = "font: 11.5px/1.5 ui-monospace, SFMono-Regular, Menlo, Consolas, monospace; white-space: pre-wrap"


@dataclass(frozen=True)
class Actions:
    """What people do with the panel."""

    seek: Callable[[float], None]
    toggle: Callable[[], None]
    step: Callable[[int], None]
    speed: Callable[[float], None]
    loop: Callable[[bool], None]
    hold: Callable[[str], None]
    again: Callable[[], None]
    put_back: Callable[[], None]


class Panel:
    """The controls of a viewer; shows a run, and in it a row."""

    def __init__(self, gui: Any, shown: Shown, actions: Actions, movable: Sequence[str], again: bool):
        self._gui, self._actions = gui, actions
        self._shown, self._program = shown, _program_html(shown)
        self._line: object = None
        self._plots: list[Any] = []
        self._time = gui.add_slider("Time, s", 0.0, _end(shown), _step(shown), 0.0)
        self._time.on_update(self._time_moved)
        self._play = gui.add_button("Play", icon="player-play")
        self._play.on_click(lambda _: actions.toggle())
        steps = gui.add_button_group("Step", ("|<", "<", ">", ">|"))
        steps.on_click(lambda _: actions.step({"|<": -2, "<": -1, ">": 1, ">|": 2}[steps.value]))
        speed = gui.add_dropdown("Speed", tuple(_SPEEDS), initial_value="1")
        speed.on_update(lambda _: actions.speed(_SPEEDS[speed.value]))
        loop = gui.add_checkbox("Loop", False)
        loop.on_update(lambda _: actions.loop(loop.value))
        tabs = gui.add_tab_group()
        with tabs.add_tab("Program"):
            self._place = gui.add_html("")
            self._text = gui.add_html("")
        with tabs.add_tab("Joints"):
            self._joints = gui.add_html("")
        self._curves = tabs.add_tab("Curves")
        with tabs.add_tab("Obstacles"):
            self._obstacles(movable, again)
        with tabs.add_tab("Summary"):
            self._summary = gui.add_html("")
        gui.add_command("Play or pause", hotkey="P").on_trigger(lambda _: actions.toggle())
        self.show(shown)

    def show(self, shown: Shown) -> None:
        """Show another run."""
        self._shown, self._program = shown, _program_html(shown)
        self._line = None
        self._time.max, self._time.step = _end(shown), _step(shown)
        self._summary.content = _summary(shown)
        self._draw_curves()
        self.stand(0)

    def stand(self, row: int) -> None:
        """Show a row of the run."""
        shown, line = self._shown, self._shown.line_at(row)
        self._time.value = round(row * shown.stream.dt, 9)
        if line != self._line:
            self._line = line
            known = shown.text is not None and line.file == shown.title
            self._text.content = self._program.lit(line.number if known else 0) if self._program else ""
        where = "before the first move" if not line.number else f"line {line.number}"
        if line.number and line.file != shown.title:
            where += f" of {escape(line.file)}"
        tick = int(shown.stream.ticks[row])
        self._place.content = _small(f"{where} · tick {tick} · {row * shown.stream.dt:.3f} s")
        self._joints.content = joint_html(shown, row)

    def show_playing(self, plays: bool) -> None:
        """Show whether the run is playing."""
        self._play.label = "Pause" if plays else "Play"
        self._play.icon = "player-pause" if plays else "player-play"

    def show_moved(self, names: Sequence[str], text: str) -> None:
        """Show which obstacles are elsewhere than in the run, and the tables of the cell for them."""
        self._moved.content = _small(f"moved: {escape(', '.join(names))}" if names else "none is moved")
        self._toml.value = text

    def show_running(self, running: bool, words: str) -> None:
        """Show that the program is being run again, or what came of it."""
        self._again.disabled = running
        self._status.content = _small(escape(words))

    def show_failure(self, found: Sequence[Diagnostic]) -> None:
        """Show why a run has ended, or been refused; none where it has not."""
        texts = "\n\n".join(map(render_text, found))
        box = f"{_MONO}; border-left: 3px solid #e03131; padding: 2px 0 2px 8px; margin: 4px 0"
        self._failure.content = f'<div style="{box}">{escape(texts)}</div>' if texts else ""

    def _time_moved(self, event: Any) -> None:
        # The server sets it as well, while it plays; that moves nothing.
        if event.client is not None:
            self._actions.seek(float(self._time.value))

    def _obstacles(self, movable: Sequence[str], again: bool) -> None:
        gui, actions = self._gui, self._actions
        if not self._shown.cell.scene.obstacles:
            gui.add_html(_small("the cell has no obstacles"))
        elif not movable:
            gui.add_html(_small("obstacles that move by themselves, or whose file is gone, are not moved"))
        elif not self._shown.switches_obstacles:
            gui.add_html(_small("the program switches no obstacle on (OBSTACLE): it takes no notice of them"))
        hold = gui.add_dropdown("Move", (_NOTHING, *movable), initial_value=_NOTHING, visible=bool(movable))
        hold.on_update(lambda _: actions.hold("" if hold.value == _NOTHING else hold.value))
        self._again = gui.add_button("Run again", icon="refresh", visible=again)
        self._again.on_click(lambda _: actions.again())
        self._status = gui.add_html("", visible=again)
        self._failure = gui.add_html("")
        self._moved = gui.add_html("", visible=bool(movable))
        back = gui.add_button("Put back", icon="arrow-back-up", visible=bool(movable))
        back.on_click(lambda _: actions.put_back())
        with gui.add_folder("For the cell file", expand_by_default=False, visible=bool(movable)):
            self._toml = gui.add_text("TOML", "", multiline=True)

    def _draw_curves(self) -> None:
        for plot in self._plots:
            plot.remove()
        self._plots.clear()
        with self._curves:
            for found in curves(self._shown):
                self._plots.append(self._gui.add_html(_legend(found)))
                self._plots.append(
                    self._gui.add_uplot(
                        found.data,
                        found.series,
                        scales={"x": {"time": False}, "y": {"auto": True}},
                        legend={"show": False},
                        aspect=1.5,
                    )
                )


def _program_html(shown: Shown) -> ProgramHtml | None:
    return None if shown.text is None else ProgramHtml(shown.text)


def _end(shown: Shown) -> float:
    """End of the slider; it cannot be without any length."""
    return max(round(shown.duration, 9), _step(shown))


def _step(shown: Shown) -> float:
    return shown.stream.dt


def _small(html: str) -> str:
    return f'<div style="font-size: 12px; padding: 2px 10px">{html}</div>'


def _summary(shown: Shown) -> str:
    legend = _small(f"way of the tool: {_square(ON_TIME)} as programmed {_square(SLOWED)} slower")
    parts = ["".join(map(_summary_line, shown.summary)), legend]
    if shown.output:
        parts.append(f'<div style="{_MONO}">{escape(shown.output)}</div>')
    if shown.diagnostics:
        texts = "\n\n".join(map(render_text, shown.diagnostics))
        parts.append(f'<div style="{_MONO}">{escape(texts)}</div>')
    return f'<div style="padding: 0 10px">{_RULE.join(parts)}</div>'


def _summary_line(line: Line) -> str:
    """A line of the summary; what does not fit goes on below its figure, not below its label."""
    style = _MONO if line.label is None else f"{_MONO}; padding-left: {LABEL}ch; text-indent: -{LABEL}ch"
    style += {Tone.BAD: "; color: #e03131", Tone.CARE: f"; color: rgb{SLOWED}"}.get(line.tone, "")
    weight = "; font-weight: 600" if line.label is None else ""
    return f'<div style="{style}{weight}">{escape(line.plain)}</div>'


def _legend(found: Curves) -> str:
    """Title of a plot, and the names of its curves in their colours."""
    pairs = zip(found.names, found.colours, strict=True)
    names = (
        f'<span style="color: {colour}; white-space: nowrap">{escape(name)}</span>' for name, colour in pairs
    )
    return _small(f"<b>{found.title}</b> &nbsp; {' '.join(names)}")


_RULE = '<hr style="opacity: .3">'


def _square(colour: tuple[int, int, int]) -> str:
    style = "display:inline-block; width:10px; height:10px; border-radius:2px; margin: 0 3px 0 8px"
    return f'<span style="{style}; background: rgb{colour}"></span>'
