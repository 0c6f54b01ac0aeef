"""`python -m irlx`."""

from irlx.cli.main import entry_point

if __name__ == "__main__":
    entry_point()
