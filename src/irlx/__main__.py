"""`python -m irlx`."""

from irlx.cli.entry import entry_point

if __name__ == "__main__":
    entry_point()
