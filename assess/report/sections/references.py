"""The publications that the report rests on."""

from assess.i18n import fill
from assess.i18n import gettext as _
from assess.report import words
from assess.report.blocks import Bullets, Section
from assess.report.say import ground
from assess.report.view import Part, View


def build(view: View) -> Section:
    """Return the publications of methods and profiles, and the sources of sizes of the types that are used."""
    types = {item.type for item in view.run.item_rows}
    sizes = [
        _("Sizes of {type}: {source}", type=words.clip(one.type, 60), source=words.clip(one.source, 200))
        for one in view.run.catalogue
        if one.source and one.type in types
    ]
    profiles = [one.reference for one in ground.used_profiles(view.run)]
    return Section([Bullets([*view.content.references, *profiles, *sizes], "references")])


PART = Part(key="references", heading=fill("References"), places={"annex": 80, "all": 170}, build=build)
