"""A made-up city as tables: what the outputs are tested on, without assessing hundreds of buildings."""

from typing import Any

import numpy as np
import pandas as pd

from assess.i18n import fill
from assess.portfolio.city import City, RunGround
from assess.portfolio.city_tables import FRAME_TYPES
from assess.portfolio.example_city import list_buildings
from assess.portfolio.table_schemas import TABLES
from assess.risk import classify
from assess.settings import Settings

NASTY = "=cmd|' /C calc'!A0 </script><script>alert(1)</script> \u2028 \u202e"
"""A name that attacks a spreadsheet, a page and whoever reads it."""
BUILDING = {
    "status": "assessed", "inventory": "surveyed", "basis": "simulated", "draws": 20, "pieces": 12, "low": 3,
    "medium": 2, "high": 2, "very_high": 1, "cannot_rock": 1, "unconfirmed": 0, "by_formula": 0, "rolls": 0,
    "anchored": 2, "expected_falls": 1.9, "falls_p05": 0.0, "falls_p95": 5.0, "falls_avoided": 1.4, "works": 4,
    "works_without_cost": 0, "cost": 1250.0, "is_placed": True, "latitude": 37.8, "longitude": -122.3, "use": "Office",
    "storeys": 3, "height_m": 11.4, "floor_area_m2": 900.0, "ground_source": "shakemap", "ground_pga_g": 0.21,
    "ground_pgv_cm_s": 23.4, "own_motions": 0, "largest_pfa_g": 0.345, "motion_uncertainty": 0.62, "routes": 0,
    "routes_open": 0, "routes_doubtful": 0, "routes_blocked": 0, "routes_not_known": 0, "warnings": 0,
}  # fmt: skip
PIECE = {
    "inventory": "surveyed", "basis": "simulated", "floor": "1", "room": "Hall", "type": "Bookcase tall",
    "quantity": 2, "breadth_cm": 38.0, "width_cm": 80.0, "height_cm": 195.5, "axis": "X", "anchored": "no",
    "is_held": False, "importance": "property", "probability": 0.25, "probability_low": 0.18, "probability_high": 0.34,
    "risk_class": "medium", "risk_class_upper": "high",
}  # fmt: skip
TYPES = ("Bookcase tall", "Steel shelving", "Storage cabinet steel", "Wardrobe", "Desk", "Patient wardrobe")


def frame(name, rows):
    """Return rows as a table typed as the schema says."""
    data = pd.DataFrame(rows, columns=[one.key for one in TABLES[name]])
    return data.astype({one.key: FRAME_TYPES[one.kind] for one in TABLES[name]})


def make_view(count=40, *, draws=200):
    """Return a city of `count` buildings: some assumed, skipped, without a place, with a nasty name."""
    random = np.random.default_rng(1)
    tables: dict[str, list[dict[str, Any]]] = {name: [] for name in TABLES}
    for at, one in enumerate(list_buildings(count)):
        path = one.path or one.name
        if at % 11 == 10:
            tables["buildings"].append({"path": path, "status": "skipped", "inventory": None, "warnings": 0})
            tables["problems"].append({"path": path, "severity": "error", "message": "height is 1.8 cm."})
            continue
        pieces = [
            PIECE | {
                "path": path, "item": f"1-{k:02}", "type": TYPES[k % len(TYPES)], "quantity": 1 + k % 3,
                "is_held": k == 5, "probability": chance, "risk_class": classify(chance).word, "row": k + 2,
                "work_place": k + 1 if chance > 0.1 and k != 5 else None,
                "detail": "L-bracket to studs" if chance > 0.1 and k != 5 else None,
            } for k, chance in enumerate(random.beta(0.6, 2.2, 12))
        ]  # fmt: skip
        free = [row for row in pieces if not row["is_held"]]
        expected = sum(row["quantity"] * row["probability"] for row in free)
        falls, has_routes = random.poisson(expected, draws), at % 3 != 0
        people = np.minimum(40, falls * 5) if has_routes else 0 * falls
        classes = {word: sum(row["quantity"] for row in free if row["risk_class"] == word)
                   for word in ("low", "medium", "high", "very high")}  # fmt: skip
        tables["buildings"].append(BUILDING | {
            "path": path, "building": NASTY if at == 3 else one.name, "use": one.use, "storeys": one.storeys,
            "inventory": "surveyed" if one.path else "assumed", "latitude": one.latitude if at != 5 else None,
            "longitude": one.longitude if at != 5 else None, "is_placed": at != 5, "expected_falls": falls.mean(),
            "falls_p05": np.quantile(falls, 0.05), "falls_p95": np.quantile(falls, 0.95), "draws": draws,
            "falls_low_inventory": None if one.path else 0.3 * expected,
            "falls_high_inventory": None if one.path else 1.9 * expected, "routes": int(has_routes),
            "routes_blocked": int(has_routes), "occupants": 40 * has_routes, "people_blocked": people.mean(),
            "people_not_known": 0, "very_high": classes.pop("very high"), **classes,
        })  # fmt: skip
        tables["pieces"] += pieces
        if has_routes:
            tables["routes"].append({"path": path, "route": "Way out", "state": "blocked" if at % 2 else "doubtful",
                                     "probability": 0.3, "occupants": 40})  # fmt: skip
        tables["draws"] += [
            {"path": path, "draw": k, "falls": n, "people_blocked": m, "routes_blocked": int(m > 0)}
            for k, (n, m) in enumerate(zip(falls.tolist(), people.tolist(), strict=True))
        ]
    ground = RunGround(kind="shakemap", file="grid.xml", sha256="0" * 64, facts=((fill("Event"), fill("Loma Prieta")),))
    return City(**{name: frame(name, rows) for name, rows in tables.items()}, settings=Settings(), ground=ground)
