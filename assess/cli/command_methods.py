"""``assess methods``: what each method predicts, needs and rests on."""

import typer

ORDER = 8
EXAMPLES = ("assess methods", "assess methods > methods.txt")


def command() -> None:
    """List the methods: their input, checked ranges and sources."""
    from assess.methods import all_methods

    for method in all_methods():
        typer.echo(f"{method.key}: {method.title} ({method.kind})")
        typer.echo(f"  {method.predicts}")
        typer.echo(f"  needs: {', '.join(sorted(method.needs))}")
        for name, limits in method.valid.items():
            typer.echo(f"  checked for {name} {limits.low:g} to {limits.high:g} {limits.unit}".rstrip())
        typer.echo(f"  {method.reference}\n")
