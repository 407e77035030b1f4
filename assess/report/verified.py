"""What a report says of the verification: what was run, what it changed, what is still open."""

from assess.report import words
from assess.results import Assessment
from assess.settings import AUTO


def describe_verification(assessment: Assessment) -> str:
    """Say in one or two sentences how much has been verified, and what that changed."""
    verified = [one for one in assessment if one.is_verified]
    if not verified:
        return "Not verified."
    runs = assessment.settings.runs
    motions = "125 to 5,000 motions" if runs == AUTO else f"{words.plural(int(runs), 'motion')}"
    lowered = sum(one.adopted.lowered_from is not None for one in verified)
    text = (
        f"Verified by direct integration: {len(verified):,} of {words.plural(len(assessment), 'row')}, {motions} each"
    )
    return f"{text}; {words.plural(lowered, 'class', 'classes')} lowered by it." if lowered else f"{text}."
