"""A run in the browser: the page's server, its scene, its panel, its clock."""

from __future__ import annotations

import threading
from contextlib import suppress
from types import TracebackType

from irlx.cell.cell import Cell
from irlx.cell.moved_obstacles import MovableObstacles
from irlx.diagnostics import Diagnostic
from irlx.report.appearance.build import appearance_of
from irlx.solids.placement import Placement
from irlx.viewer.obstacle_nodes import ObstacleNodes
from irlx.viewer.panel import Actions, Panel
from irlx.viewer.player import Player
from irlx.viewer.rerun import Again, Rerun
from irlx.viewer.robot_nodes import RobotNodes
from irlx.viewer.serve import serve
from irlx.viewer.shown import Shown
from irlx.viewer.surroundings import bounds_of, draw_surroundings, handle_size, look_at_it
from irlx.viewer.trail import draw_trail


class Viewer:
    """Serves a page that shows a run, to as many browsers as come; all of them see the same.

    `shown` is the run that is shown; `failure` are the diagnostics of a run again that did not succeed, for
    which the run before stays. May be used in a `with` statement, which stops it at its end.
    """

    def __init__(self, shown: Shown, again: Again | None, host: str, port: int) -> None:
        self.shown = shown
        self.failure: tuple[Diagnostic, ...] = ()
        self._lock = threading.RLock()
        self._row = 0
        self._stopped = threading.Event()
        self._obstacles_of_cell = MovableObstacles(shown.cell)
        self._served = serve(host, port, shown.title)
        self.server = self._served.server
        self.url = f"http://{f'[{host}]' if ':' in host else host}:{port}"
        try:
            self._build(again)
        except BaseException:
            self._served.stop()
            raise

    def _build(self, again: Again | None) -> None:
        """Put the scene and the panel together."""
        shown, scene, looks = self.shown, self.server.scene, appearance_of(self.shown.cell)
        self.diagnostics = looks.diagnostics
        self.robot = RobotNodes(scene, looks.robot)
        bounds = bounds_of(shown, self.robot)
        self.tool = draw_surroundings(scene, shown, bounds)
        look_at_it(self.server, bounds)
        own, groups = self._obstacles_of_cell, shown.cell.scene.groups
        members = {name: [one.name for one in shown.cell.scene.members(name)] for name in groups}
        self.obstacles = ObstacleNodes(scene, looks.obstacles, own.names, members, self._moved)
        self._handle_size = handle_size(bounds)
        draw_trail(scene, shown)
        self._player = Player(shown.duration, self._stand_at, self._played)
        self._rerun = None if again is None else Rerun(again, self._going, self._ran, self._failed)
        self.panel = Panel(
            self.server.gui, shown, self._actions(), self.obstacles.movable, self._rerun is not None
        )
        self._moved()
        self._stand_at(0.0)

    def __enter__(self) -> Viewer:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    @property
    def row(self) -> int:
        """The row of the stream that is shown."""
        return self._row

    @property
    def rows(self) -> int:
        """How many rows the run has that is shown."""
        return len(self.shown.stream.q)

    def seek(self, row: int) -> None:
        """Show a row."""
        self._player.seek(min(max(row, 0), self.rows - 1) * self.shown.stream.dt)

    def play(self) -> None:
        """Play on."""
        self._player.play()

    def pause(self) -> None:
        """Stop playing."""
        self._player.pause()

    def place(self, name: str, pose: Placement) -> None:
        """Put an obstacle of the cell at a pose in the world, as a hand may; KeyError for none that may."""
        self.obstacles.place(name, pose)

    def moved_cell(self) -> Cell:
        """The cell with its obstacles where they are now."""
        return self._obstacles_of_cell.moved(self.obstacles.poses)

    def obstacles_text(self) -> str:
        """All `[[obstacle]]` tables of the cell as TOML, with obstacles where they are now."""
        return self._obstacles_of_cell.text(self.obstacles.poses)

    def run_again(self, timeout: float | None = None) -> None:
        """Run the program with obstacles where they are now and wait for it, at most so long, s."""
        self._again()
        if self._rerun is not None:
            self._rerun.wait(timeout)

    def wait(self) -> None:
        """Wait until `stop` is called, or for Ctrl-C, which it takes for that."""
        with suppress(KeyboardInterrupt):
            # In steps: a wait without end cannot be interrupted everywhere.
            while not self._stopped.wait(0.5):
                pass

    def stop(self) -> None:
        """End the page's server and whatever runs behind it."""
        if self._stopped.is_set():
            return
        self._stopped.set()
        self._player.stop()
        if self._rerun is not None:
            self._rerun.stop()
        self._served.stop()

    def _actions(self) -> Actions:
        player = self._player
        return Actions(
            seek=player.seek,
            toggle=lambda: player.pause() if player.plays else player.play(),
            step=self._step,
            speed=player.set_speed,
            loop=lambda loops: setattr(player, "loops", loops),
            hold=lambda name: self.obstacles.hold(name, self._handle_size),
            again=self._again,
            put_back=self.obstacles.put_back,
        )

    def _step(self, steps: int) -> None:
        """Go one row back or on, or with 2 to the beginning or end, and stand there."""
        self._player.pause()
        self.seek({-2: 0, 2: self.rows}.get(steps, self._row + steps))

    def _stand_at(self, time: float) -> None:
        with self._lock, self.server.atomic():
            row = self.shown.row_at(time)
            self._row = row
            stream = self.shown.stream
            self.robot.stand(stream.q[row])
            self.obstacles.stand(row * stream.dt)
            x, y, z, w = stream.tool[row, 3:].tolist()
            self.tool.position, self.tool.wxyz = stream.tool[row, :3], (w, x, y, z)
            self.panel.stand(row)

    def _played(self) -> None:
        self.panel.show_playing(self._player.plays)

    def _moved(self) -> None:
        self.panel.show_moved(sorted(self.obstacles.poses), self.obstacles_text())

    def _again(self) -> None:
        if self._rerun is not None and self._rerun.start(self.moved_cell):
            self.panel.show_running(True, "running ...")

    def _going(self, line: int, seconds: float) -> None:
        self.panel.show_running(True, f"running: line {line}, {seconds:.2f} s")

    def _ran(self, shown: Shown) -> None:
        with self._lock:
            self.shown, self.failure = shown, ()
            draw_trail(self.server.scene, shown)
            self.panel.show(shown)
            self._player.restart(shown.duration)
        self.panel.show_failure(())
        self.panel.show_running(False, f"ran: {shown.duration:.6g} s")

    def _failed(self, found: tuple[Diagnostic, ...]) -> None:
        self.failure = found
        self.panel.show_failure(found)
        self.panel.show_running(False, "it did not run; the run before is shown")
