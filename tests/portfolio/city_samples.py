"""A made-up city as tables: what the outputs are tested on, without assessing hundreds of buildings."""

from typing import Any

import numpy as np
import pandas as pd

from assess.i18n import fill
from assess.portfolio.city import City, RunGround
from assess.portfolio.example_city import list_buildings
from assess.portfolio.table_schemas import TABLES
from assess.risk import classify
from assess.settings import Settings

DTYPES = {"text": "object", "number": "float64", "count": "Int64", "flag": "boolean"}
NASTY = "=cmd|' /C calc'!A0 </script><script>alert(1)</script> \u2028 \u202e"
"""A name that attacks a spreadsheet, a page and whoever reads it."""
DRAWN = ("path", "draw", "falls", "people_blocked", "routes_blocked")
TYPES = ("Bookcase tall", "Steel shelving", "Storage cabinet steel", "Wardrobe", "Desk", "Patient wardrobe")


def frame(name, rows):
    """Return rows as a table typed as the schema says."""
    columns = TABLES[name]
    data = pd.DataFrame(rows, columns=[one.key for one in columns])
    return data.astype({one.key: DTYPES[one.kind] for one in columns})


def make_view(count=40, *, draws=200, pieces=12, verify="all", seed=1):
    """Return a city of `count` buildings: some assumed, skipped, without a place, with a nasty name."""
    random = np.random.default_rng(seed)
    buildings: list[dict[str, Any]] = []
    rows, routes, problems, drawn = [], [], [], []
    shared = random.standard_normal(draws)
    for at, one in enumerate(list_buildings(count)):
        path = one.path or one.name
        name = NASTY if at == 3 else one.name
        if at % 11 == 10:
            buildings.append({"path": path, "status": "skipped", "inventory": None, "warnings": 0})
            problems.append({
                "path": path, "severity": "error", "sheet": "Items", "cell": "H14",
                "message": "height is 1.8 cm, expected 5 to 600.", "fix": "Did you type metres?",
            })  # fmt: skip
            continue
        own = _list_pieces(path, one, pieces, random, simulated=verify == "all")
        rows += own
        falls = np.zeros(draws, dtype=int)
        for row in own:
            if not row["is_held"]:
                limit = np.quantile(shared, 1 - row["probability"]) if row["probability"] < 1 else -9
                falls += row["quantity"] * (shared + 0.5 * random.standard_normal(draws) > 1.1 * limit)
        has_routes = at % 3 != 0
        people = np.minimum(40, falls * 5) if has_routes else np.zeros(draws, dtype=int)
        basis = "simulated" if verify == "all" else "formula"
        buildings.append(_assess(path, name, one, own, falls, basis=basis, is_placed=at != 5))
        if has_routes:
            buildings[-1] |= {"routes": 1, "routes_blocked": 1, "occupants": 40}
            buildings[-1]["people_blocked"] = float(people.mean())
            routes.append({
                "path": path, "route": "Way out", "state": "blocked" if at % 2 else "doubtful",
                "probability": float((people > 0).mean()), "probability_low": 0.1, "probability_high": 0.5,
                "occupants": 40, "blockers": "1-01", "to_fill_in": None,
            })  # fmt: skip
        if verify == "all":
            counts = enumerate(zip(falls.tolist(), people.tolist(), strict=True))
            drawn += [dict(zip(DRAWN, (path, k, n, m, int(m > 0)), strict=True)) for k, (n, m) in counts]
    facts = ((fill("Event"), fill("Loma Prieta, magnitude 6.9")), (fill("Map status"), fill("RELEASED")))
    ground = RunGround(kind="shakemap", file="grid.xml", sha256="0" * 64, facts=facts)
    tables = {"buildings": buildings, "pieces": rows, "routes": routes, "problems": problems, "draws": drawn}
    return City(
        **{name: frame(name, own) for name, own in tables.items()}, settings=Settings(verify=verify), ground=ground
    )


def _list_pieces(path, one, count, random, *, simulated):
    rows = []
    for number in range(count):
        chance = float(round(random.beta(0.6, 2.2), 4))
        word = classify(chance).word
        rows.append({
            "path": path, "item": f"1-{number:02}", "floor": "1", "room": "Office", "description": None,
            "type": TYPES[number % len(TYPES)], "inventory": "surveyed" if one.path else "assumed",
            "quantity": 1 + number % 3, "breadth_cm": 30.0, "width_cm": 80.0, "height_cm": 200.0, "axis": "X",
            "anchored": "yes" if number == 5 else "no", "is_held": number == 5, "importance": "property",
            "pfa_g": 0.21, "pfv_cm_s": 20.0, "pfa_source": "profile", "basis": "simulated" if simulated else "formula",
            "probability": chance, "probability_low": max(0.0, chance - 0.05) if simulated else None,
            "probability_high": min(1.0, chance + 0.05) if simulated else None, "risk_class": word,
            "risk_class_upper": word, "flags": None, "route": "Way out" if number == 1 else None,
            "work_place": number + 1 if chance > 0.1 and number != 5 else None,
            "detail": "L-bracket to studs" if chance > 0.1 and number != 5 else None, "unit_cost": 90.0,
            "row": number + 2,
        })  # fmt: skip
    return rows


def _assess(path, name, one, own, falls, *, basis, is_placed):
    free = [row for row in own if not row["is_held"]]
    by_class = {
        word: sum(row["quantity"] for row in free if row["risk_class"] == word)
        for word in ("low", "medium", "high", "very high")
    }
    works = [row for row in own if row["work_place"] is not None]
    expected = float(falls.mean()) if basis == "simulated" else sum(r["quantity"] * r["probability"] for r in free)
    surveyed = bool(one.path)
    return {
        "path": path, "status": "assessed", "building": name, "inventory": "surveyed" if surveyed else "assumed",
        "latitude": one.latitude if is_placed else None, "longitude": one.longitude if is_placed else None,
        "use": one.use, "storeys": one.storeys, "height_m": one.height, "floor_area_m2": float(one.area),
        "ground_source": "shakemap", "ground_pga_g": 0.18, "ground_pgv_cm_s": 19.0, "own_motions": 0,
        "largest_pfa_g": 0.31, "motion_uncertainty": 0.6, "is_placed": is_placed, "basis": basis,
        "draws": falls.size if basis == "simulated" else 0, "pieces": sum(row["quantity"] for row in own),
        "low": by_class["low"], "medium": by_class["medium"], "high": by_class["high"],
        "very_high": by_class["very high"], "unconfirmed": 0, "by_formula": 0,
        "anchored": sum(row["quantity"] for row in own if row["is_held"]), "expected_falls": expected,
        "falls_p05": float(np.quantile(falls, 0.05)) if basis == "simulated" else None,
        "falls_p95": float(np.quantile(falls, 0.95)) if basis == "simulated" else None,
        "falls_low_inventory": None if surveyed else expected * 0.3,
        "falls_high_inventory": None if surveyed else expected * 1.9, "falls_avoided": expected * 0.6,
        "works": sum(row["quantity"] for row in works), "cost": 90.0 * len(works) if surveyed else None,
        "works_without_cost": 0 if surveyed else len(works), "routes": 0, "routes_open": 0, "routes_doubtful": 0,
        "routes_blocked": 0, "routes_not_known": 0, "occupants": 0, "people_blocked": 0.0, "warnings": 0,
    }  # fmt: skip
