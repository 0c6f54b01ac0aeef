"""What a run may read and write, before it begins."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from irlx.interpreter.channels.channels import Channels, Told
from irlx.interpreter.channels.fault import STANDARD_IN
from irlx.interpreter.channels.folder import Folder
from irlx.interpreter.channels.folder_files import FolderFiles
from irlx.interpreter.channels.memory_files import MemoryFiles
from irlx.interpreter.channels.pieces import InputGiven, pieces_of


@dataclass(frozen=True)
class ChannelSetup:
    """The folder of the files, those in it that are not to be written with what they are, what STANDARD_IN
    reads, and what is called with each text for STANDARD_OUT."""

    folder: Path = Path()
    protected: Mapping[Path, str] = field(default_factory=dict)
    input: InputGiven = None
    output: Callable[[str], object] | None = None

    def protecting(self, paths: Sequence[Path], what: str) -> ChannelSetup:
        """The same with more files that are not to be written."""
        return replace(self, protected={**self.protected, **dict.fromkeys(paths, what)})

    def on_disk(self) -> Channels:
        """Channels that read and write files."""
        output = self.output

        def told(name: str | None, text: str) -> None:
            if name is None and output is not None:
                output(text)

        files = FolderFiles(Folder(self.folder, self.protected))
        return Channels(files, pieces_of(self.input, STANDARD_IN), told)

    def in_memory(self, told: Told | None = None) -> Channels:
        """Channels that read files, and keep in memory what is written."""
        files = MemoryFiles(Folder(self.folder, self.protected))
        return Channels(files, pieces_of(self.input, STANDARD_IN), told)
