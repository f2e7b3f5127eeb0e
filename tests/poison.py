"""A model whose runs take a moment, and end the process of a worker where the column is called poison."""

import math
import os
import time
from dataclasses import dataclass

from stylobate.models.base import Model
from stylobate.models.engine import Engine
from stylobate.outcome import Outcome
from stylobate.response import Measures


class Poisoning(Engine):
    """Of :class:`Poisonous`."""

    def run_many(self, cases, options, threads):
        """One after the other."""
        for index, case in enumerate(cases):
            if case.column.name == "poison":
                os._exit(1)
            time.sleep(self.model.pause)
            yield index, Measures(Outcome.ROCKED, True, math.nan, *[case.motion.factor] * 6, 0.0, 1)


@dataclass(frozen=True)
class Poisonous(Model):
    """Its peaks are the factors of the motions."""

    pause: float = 0.0

    name = "poisonous"
    engines = (Poisoning,)
