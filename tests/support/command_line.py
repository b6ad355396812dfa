"""Commands as a user runs them, in this process."""

from click.testing import CliRunner

from frictionjax.cli import main


def run(*arguments, **settings):
    return CliRunner().invoke(main, list(map(str, arguments)), **settings)


def error_line(result):
    """The one line of a failed command."""
    assert result.exit_code == 2
    assert result.stdout == ""
    assert result.stderr.startswith("Error: ")
    assert result.stderr.count("\n") == 1
    return result.stderr
