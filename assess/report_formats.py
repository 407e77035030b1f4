"""The formats of a run's reports, with their files: what the command, the page and `assess.report` write."""

from collections.abc import Mapping

FILES: Mapping[str, str] = {
    "pdf": "report.pdf",
    "annex": "annex.pdf",
    "xlsx": "report.xlsx",
    "html": "report.html",
    "json": "results.json",
    "csv": "items.csv",
    "docx": "report.docx",
    "npz": "outcomes.npz",
    "parquet": "items.parquet",
}
ASKED_FOR = frozenset(("annex", "docx", "npz", "parquet"))
"""Written only where they are named: the annex, which few read and which takes as long as all others; the Word edition
and Parquet, which need more packages; and the outcomes of every motion, which are for other programs."""
DEFAULT = tuple(name for name in FILES if name not in ASKED_FOR)
ALL = "all"
"""In place of formats: every one, of those that need more packages where these are installed."""
