"""Commands as a user runs them, in this process."""

from unittest import mock

from click.testing import CliRunner

from frictionjax import _compile
from frictionjax.cli import main


def run(*arguments, **settings):
    """A command; programs stay where the tests keep theirs.

    Kept in the user's folder, those of all later tests would be too, the smallest as well.
    """
    with mock.patch.object(_compile, "keep_compiled", return_value=None):
        return CliRunner().invoke(main, list(map(str, arguments)), **settings)


def error_line(result):
    """The one line of a failed command."""
    assert result.exit_code == 2
    assert result.stdout == ""
    assert result.stderr.startswith("Error: ")
    assert result.stderr.count("\n") == 1
    return result.stderr
