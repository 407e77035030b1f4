"""The motion of one floor: where it comes from, its peaks, and how its draws are made."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

from assess.arrays import FloatArray
from assess.i18n import fill, join
from assess.intensity import Shaking
from assess.model import Axis, Floor
from assess.motion.assumed import Building, FloorTarget, Ground
from assess.motion.record import Motion, Record
from assess.motion.scenario import Profile
from assess.motion.site_ground import SiteGround
from assess.rocking.draws import MOTION

Source = Literal["record", "given", "interpolated", "profile", "beam"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Drawn:
    """What the draws of a floor start from, and what they are brought to.

    * `building`: of which each draw has a beam.
    * `ground`: the ground motion in a unit of its own, of which `target.factor` is the multiple.
    * `record`: the record of the ground that takes its place.
    * `at_grade`: the floor at grade whose motion that of the ground is; "" where Building gives it.
    """

    building: Building
    ground: Ground
    record: "Demand | None"
    target: FloorTarget
    at_grade: str = ""

    @property
    def is_unknown(self) -> bool:
        """Whether nothing is known of the building, nor of the floor's height."""
        return self.building.period is None and self.target.place is None

    def scaled(self, factor: float) -> "Drawn":
        """Return it with every motion multiplied by a factor [-]."""
        target = self.target
        anchors = tuple((place, factor * pfa) for place, pfa in target.anchors)
        scaled = replace(
            target, pfa=factor * target.pfa, pfv=factor * target.pfv, factor=factor * target.factor, anchors=anchors
        )
        return replace(self, target=scaled)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Demand:
    """The motion of one floor along one axis from one source.

    * `pfa`, `pfv`: peak floor acceleration [m/s2] and velocity [m/s]: medians, where its draws are not brought to each.
    * `name`: the record as the workbook names it, else "".
    * `record`, `motion`: the recorded motion, as in the file and as treated.
    * `between`: the floors below and above that it is interpolated between.
    * `drawn`: how its draws are made where it has no record.
    * `profile`: the code's profile, with its clause.
    * `height_ratio`, `amplification`: z/h [-], and PFA over the ground's PGA where PFA follows from it [-].
    * `shaking`: the assumed intensity of the ground motion.
    * `site`: the ShakeMap or the scenarios that give it.
    * `own_dispersion`, `dispersion`: standard deviation of ln amplitude from one earthquake to the next [-]: at a known
      ground motion, and with the scatter of what gives the ground motion.
    * `flags`: keys of `assess.results.MOTION_FLAGS`.
    * `scale`: factor by which all of this was multiplied [-].
    """

    floor: Floor
    axis: Axis
    source: Source
    pfa: float
    pfv: float
    name: str = ""
    record: Record | None = None
    motion: Motion | None = None
    between: tuple[str, ...] = ()
    drawn: Drawn | None = None
    profile: Profile | None = None
    clause: str = ""
    height_ratio: float | None = None
    amplification: float | None = None
    shaking: Shaking | None = None
    site: SiteGround | None = None
    own_dispersion: float = MOTION
    dispersion: float = MOTION
    flags: tuple[str, ...] = ()
    scale: float = 1.0

    @property
    def loss(self) -> float:
        """Share of the file's own peak that treatment took away [-]; 0 where no record is."""
        return 1 - self.pfa / (self.scale * self.record.file_pfa) if self.record and self.record.file_pfa else 0.0

    def scaled(self, factor: float) -> "Demand":
        """Return it with its motion multiplied by a factor [-]; the record stays as it is in its file."""
        if factor == 1.0:
            return self
        motion = self.motion and replace(
            self.motion, acceleration=factor * self.motion.acceleration, velocity=factor * self.motion.velocity,
            displacement=factor * self.motion.displacement,
        )  # fmt: skip
        return replace(
            self, pfa=factor * self.pfa, pfv=factor * self.pfv, motion=motion, scale=factor * self.scale,
            drawn=self.drawn and self.drawn.scaled(factor),
        )  # fmt: skip

    @property
    def label(self) -> str:
        """Its source in short: the record's name, "given", the profile's code with its intensity, or two floors."""
        if self.between:
            below, above = self.between
            if below == above:
                return fill("as floor {floor}", floor=below)
            return fill("interpolated between {below} and {above}", below=below, above=above)
        if self.profile:
            is_from = self.shaking or self.site
            return join(", ", [self._ground, self.profile.key]) if is_from else self.profile.key
        if self.source != "beam":
            return self.name or fill("given")
        return fill("{ground}, beam", ground=self._ground)

    @property
    def _ground(self) -> str:
        """The ground motion of its beam in short."""
        if self.drawn and self.drawn.record:
            return self.drawn.record.name
        if self.drawn and self.drawn.at_grade:
            return fill("floor {floor}", floor=self.drawn.at_grade)
        if self.shaking:
            return fill("Shaking {intensity}", intensity=self.shaking.name)
        if self.site:
            return fill("ShakeMap") if self.site.kind == "shakemap" else fill("scenarios")
        return fill("Ground PGA") if self.amplification else fill("known floors")

    @property
    def recorded(self) -> tuple[FloatArray, float] | None:
        """The recorded motion as treated [m/s2], and its time step [s]."""
        return None if self.motion is None else (self.motion.acceleration, self.motion.time_step)

    @property
    def is_borrowed(self) -> bool:
        """Whether it is the motion of the floor's other axis."""
        return "one_axis_only" in self.flags and not self.between


Demands = Mapping[tuple[str, Axis], tuple[Demand, ...]]
"""The demands of every floor (by its name) and axis; parallel records give several."""
