"""What the methods do not cover."""

from assess.i18n import fill
from assess.report.blocks import Bullets, Section
from assess.report.view import Part, View


def build(view: View) -> Section:
    """Return the limits of the methods."""
    return Section([Bullets(view.content.limits, "")])


PART = Part(key="limits", heading=fill("Limits of the methods"), places={"client": 70, "all": 140}, build=build)
