"""Pieces rocked one by one, to hold what is found of many against."""

from typing import Any

import numpy as np

from assess.pipeline.adopt import Assessment
from assess.pipeline.verify import choose_motions
from assess.rocking.draws import draw_bodies, name_number
from assess.rocking.ensemble import rock_blocks
from assess.units import GRAVITY


def rocked(assessment: Assessment, pfa_g: float) -> list[np.ndarray[Any, Any]]:
    """Rock every case alone under the motions of its axis scaled to a PFA: in which draws it falls."""
    every = np.ones(len(assessment.case_item), dtype=np.bool_)
    inventory, settings = assessment.inventory, assessment.settings
    cases = choose_motions(
        assessment.cases, every, assessment.case_demand, assessment.demands, inventory, settings, None
    )
    verdicts = []
    for at, demand in enumerate(assessment.case_demand):
        ((motions, step),) = cases.ensembles[cases.ensemble[at]].open(1).realise(0, settings.runs)
        size = cases.breadth[[at]], cases.height[[at]], cases.centre[[at]], cases.restitution[[at]]
        b, h, z, eta = (np.repeat(one, int(settings.runs)) for one in size)
        if cases.uncertainty.piece and not settings.ideal:
            name = [name_number(assessment.inventory.items[assessment.case_item[at]].item)]
            drawn = draw_bodies(*size, name, seed=settings.seed, first=0, count=int(settings.runs))
            b, h, z, eta = (one[0] for one in (drawn.breadth, drawn.height, drawn.centre, drawn.restitution))
        scaled = motions * (pfa_g * GRAVITY / demand.pfa)
        alone = (
            rock_blocks(b[k], h[k], scaled[k : k + 1], step, restitution=eta[k], centre=z[k]).overturned.item()
            for k in range(len(scaled))
        )
        verdicts.append(np.array(list(alone), dtype=np.bool_))
    return verdicts
