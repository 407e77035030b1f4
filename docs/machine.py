"""Which machine a generated page was made on: last digits, and with them verdicts at a limit, depend on it."""

from assess.version import versions

START = "Made with "


def describe_machine() -> str:
    """Return the last line of a generated page."""
    found = versions(has_rocked=True)
    software = ", ".join(f"{name} {found[name]}" for name in ("numpy", "scipy", "numba"))
    return (
        f"{START}Python {found['python']}, {software} on {found['system']}, {found['machine']} "
        f"(processor {found['processor']}). On another processor a few counts and percentages differ slightly."
    )
