"""``assess methods``: what each method predicts, needs and rests on."""

from assess.cli.console import say

ORDER = 8
EXAMPLES = ("assess methods", "assess methods > methods.txt")


def command() -> None:
    """List the methods: their input, checked ranges and sources."""
    from assess.methods import all_methods

    for method in all_methods():
        say(f"{method.key}: {method.title} ({method.kind})")
        say(f"  {method.predicts}")
        say(f"  needs: {', '.join(sorted(method.needs))}")
        for name, limits in method.valid.items():
            say(f"  checked for {name} {limits.low:g} to {limits.high:g} {limits.unit}".rstrip())
        say(f"  {method.reference}\n")
