"""`explore --choices LIST`: one run whose every choice is told, as a counterexample of `search`."""

from __future__ import annotations

from dataclasses import replace

from topo_verify.algorithms import Algorithm
from topo_verify.campaign.judge import Report
from topo_verify.campaign.run import Exploration
from topo_verify.errors import InputError
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits
from topo_verify.studies.search.states.every import with_choices
from topo_verify.studies.search.states.script import Listed, choices_of, scripted


def require_no_policies(choices: str, pick: str | None, order: str | None) -> None:
    """Raise an InputError if policies are given beside the choices."""
    if pick is not None or order is not None:
        raise InputError(
            f"--choices {choices}: the choices are the policies; leave out --pick and --order"
        )


class ListedChoices:
    """The choices of one run. Life cycle: run `target`, then `made`, then `named`.

    Args:
        target: an algorithm of the catalogue, or another `Algorithm`.
        text: the choices, as `0,2,1`.
    Raises:
        InputError: the mapper leaves no choices open, or the text is no list.
    """

    def __init__(self, target: Target, text: str) -> None:
        if not isinstance(target.mapper, Algorithm):
            raise InputError(
                f"--choices {text}: {target.text} leaves no choices open; it is for algorithms of"
                " the catalogue"
            )
        self._choices = choices_of(text)
        self._listed = Listed(self._choices)
        self.target = Target(target.text, scripted(target.mapper, self._listed))

    def made(self, run: Exploration) -> Exploration:
        """The run, if it made each of the choices; it cannot be repeated in a witness world.

        Raises:
            InputError: there were fewer ways, or fewer choices to be made.
        """
        self._listed.require_all()
        return replace(run, mapper=None)

    def named(self, report: Report, limits: Limits) -> Report:
        """The report; its findings name the command that makes the same choices."""
        return with_choices(report, self.target.text, self._choices, limits)
