"""What a signed report rests on: every source can be cited, and what has none is marked assumed beside the value."""

import re

from assess.details import DETAILS
from assess.methods import all_methods
from assess.motion.scenario import PROFILES, UNVERIFIED
from assess.pipeline.anchors import DENSITIES
from assess.routes.widths import RULES

VAGUE = re.compile(
    r"general knowledge|at hand|not to hand|second.hand|safety sites|to be (checked|verified)|\bshop", re.I
)


def test_no_source_is_vague():
    sources = [
        *(str(method.reference) for method in all_methods()),
        *(f"{one.reference} {one.remark}" for one in PROFILES.values()),
        *(str(rule.reference) for rule in RULES),
        *(str(one.source) for one in DENSITIES.values()),
        *(str(text) for one in DETAILS.values() for text in (one.what, one.weakness, one.source, one.fixing)),
    ]
    assert len(sources) > 20
    assert not [one for one in sources if VAGUE.search(one)]
    assert UNVERIFIED.startswith("assumed")
