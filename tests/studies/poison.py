"""A task that some variants kill: in a module of its own, which new processes find by its name."""

import os

from mechkin_cli.studies.workers import Task


def poisoned(task: Task, victims: tuple[int, ...]) -> list[int]:
    if any(task.begin <= victim < task.end for victim in victims):
        os._exit(3)
    return list(range(task.begin, task.end))
